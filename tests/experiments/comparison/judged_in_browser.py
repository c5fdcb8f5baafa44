#!/usr/bin/env python3
"""Opens the page of a judged log in headless Chromium and uses its charts.

    tests/experiments/comparison/judged_in_browser.py PAGE.html

Exit status 0: nothing wrong; 1: what is wrong is printed; 77: there is no chromedriver to try it with.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser import try_page

SEEN = """return (() => ({
    charts: charts.all.length, asked: chartList().length,
    detectors: byId("detectors").querySelectorAll("tbody tr").length, lanes: byId("lanes").querySelectorAll(".lane").length,
    text: document.body.innerText,
}))()"""

MOVED = """return (() => {
    charts.zoomTo("detection");
    const contact = report.contacts[0];
    const [from, to] = charts.all[0].graph.xAxisRange();
    return from < contact.detected && contact.detected < to && to - from < wholeRun[1] - wholeRun[0];
})()"""


def problems_of(browser):
    seen = browser.run(SEEN)
    if seen["charts"] == 0 or seen["charts"] != seen["asked"]:
        yield f"{seen['charts']} charts are drawn of {seen['asked']}"
    if seen["detectors"] == 0 or seen["lanes"] != seen["detectors"] + 1:
        yield f"{seen['detectors']} detectors, {seen['lanes']} lanes"
    if "undefined" in seen["text"] or "NaN" in seen["text"]:
        yield "the page shows 'undefined' or 'NaN'"
    if not browser.run(MOVED):
        yield "the charts do not show the detection"


if __name__ == "__main__":
    sys.exit(try_page(sys.argv[1], problems_of))
