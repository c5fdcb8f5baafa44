#!/usr/bin/env python3
"""Opens the page of a sweep in headless Chromium and compares its curves with its data.

    tests/experiments/campaign/sweep_in_browser.py PAGE.html

Exit status 0: nothing wrong; 1: what is wrong is printed; 77: there is no chromedriver to try it with.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser import try_page

# Of each curve how many points are drawn and should be, and whether a higher value stands higher.
POINTS = """return (() => [...byId("curves").children].map((panel, i) => {
    const curve = sweep.curves[i];
    const points = [...panel.querySelectorAll("circle")].map((point) =>
        [curve.values[Number(point.dataset.row)], -Number(point.getAttribute("cy"))]);
    const inOrder = points.every(([a, x]) => points.every(([b, y]) => (a - b) * (x - y) >= -1e-6));
    return { name: curve.name, drawn: points.length, known: curve.values.filter((value) => value !== null).length, inOrder };
}))()"""

# The command that is shown after the last point of the first curve was pressed.
PRESSED = """return (() => {
    const last = [...byId("curves").firstChild.querySelectorAll("circle")].at(-1);
    last.dispatchEvent(new MouseEvent("click"));
    return [byId("call").textContent, sweep.rows[Number(last.dataset.row)].call];
})()"""


def problems_of(browser):
    curves = browser.run(POINTS)
    if not curves:
        yield "there is no curve"
    for curve in curves:
        if curve["drawn"] != curve["known"]:
            yield f"{curve['name']}: {curve['drawn']} points are drawn of {curve['known']}"
        if not curve["inOrder"]:
            yield f"{curve['name']}: a lower value stands higher"
    shown, expected = browser.run(PRESSED)
    if shown != expected:
        yield f"the command shown is '{shown}' instead of '{expected}'"


if __name__ == "__main__":
    sys.exit(try_page(sys.argv[1], problems_of))
