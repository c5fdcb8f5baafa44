#!/usr/bin/env python3
"""Opens the page of a campaign of reactions in headless Chromium and compares its pictures with its data.

    tests/experiments/campaign/campaign_in_browser.py PAGE.html

Exit status 0: nothing wrong; 1: what is wrong is printed; 77: there is no chromedriver to try it with.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser import try_page

# Of each panel of forces over speeds: its fit, the ends of its line in speed and force, and those of the axes.
LINES = """return (() => {
    const { runs, fits, limits } = campaign.reactions;
    const fastest = Math.max(...runs.map((run) => run.speed ?? 0));
    const strongest = Math.max(1.05 * limits.transient, ...runs.map((run) => run.peak ?? 0));
    const bodies = [...new Set(runs.map((run) => run.body))];
    return [...byId("force-panels").children].map((panel, i) => {
        const { left, top, width, height } = dotBox;
        const line = panel.querySelector("line.fit");
        const number = (name) => Number(line.getAttribute(name));
        const end = (k) => [fastest * (number(`x${k}`) - left) / width, strongest * (1 - (number(`y${k}`) - top) / height)];
        return { fit: fits.find((fit) => fit.body === bodies[i]), ends: [end(1), end(2)], fastest, strongest };
    });
})()"""


def problems_of(browser):
    for line in browser.run(LINES):
        slope, intercept = line["fit"]["slope"], line["fit"]["intercept"]
        fastest, strongest = line["fastest"], line["strongest"]
        for speed, force in line["ends"]:
            if abs(force - intercept - slope * speed) > 1e-6 * strongest:
                yield f"a line of {slope} N/(m/s) from {intercept} N is drawn through {force} N at {speed} m/s"
            on_edge = min(abs(speed), abs(speed - fastest), abs(force), abs(force - strongest))
            if on_edge > 1e-6 * (fastest + strongest):
                yield f"a line ends within its panel, at {speed} m/s"
    names = browser.run("return [...document.querySelectorAll('text.row-name')].map((name) => [name.textContent, name.getBBox().x])")
    if not names:
        yield "no box has a name"
    for name, begin in names:
        if begin < 0:
            yield f"the name '{name}' is cut off"


if __name__ == "__main__":
    sys.exit(try_page(sys.argv[1], problems_of))
