#!/usr/bin/env python3
"""Opens a map of limit speeds in headless Chromium and compares its sectors with its data.

    tests/experiments/speed_limit/map_in_browser.py PAGE.html

Exit status 0: nothing wrong; 1: what is wrong is printed; 77: there is no chromedriver to try it with.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser import try_page

# Of each body how many sectors are drawn and should be, whether each points where its cell moves, and how many cannot be told
# from an unlimited one.
SECTORS = """return (() => [...byId("bodies").children].map((button) => {
    button.click();
    const cells = study.cells.filter((cell) => cell.body === button.textContent);
    const sectors = [...document.querySelectorAll(".sector")];
    const misplaced = sectors.filter((sector) => {
        const cell = study.cells[Number(sector.dataset.cell)];
        const box = sector.getBBox();
        const [x, y] = [box.x + box.width / 2 - cell.x, -(box.y + box.height / 2) - cell.y];
        const angle = (cell.direction * Math.PI) / 180;
        return x * Math.cos(angle) + y * Math.sin(angle) < 0.3 * Math.hypot(x, y);
    }).length;
    const open = document.querySelectorAll(".sector.open").length;
    const expectedOpen = cells.filter((cell) => cell.speed !== null && cell.bound !== "force").length;
    return { body: button.textContent, drawn: sectors.length, known: cells.length, misplaced, open, expectedOpen };
}))()"""

# The command that is shown after a row of the table was pressed, and that of its cell.
PRESSED = """return (() => {
    byId("cells").querySelectorAll("tbody tr")[1].click();
    return [byId("call").textContent, study.cells[1].call, shownBody, study.cells[1].body];
})()"""


def problems_of(browser):
    for body in browser.run(SECTORS):
        if body["drawn"] != body["known"]:
            yield f"{body['body']}: {body['drawn']} sectors are drawn of {body['known']}"
        if body["misplaced"]:
            yield f"{body['body']}: {body['misplaced']} sectors point another way"
        if body["open"] != body["expectedOpen"]:
            yield f"{body['body']}: {body['open']} sectors are pale instead of {body['expectedOpen']}"
    shown, expected, body, expected_body = browser.run(PRESSED)
    if shown != expected:
        yield f"the command shown is '{shown}' instead of '{expected}'"
    if body != expected_body:
        yield f"the map is of {body} instead of {expected_body}"


if __name__ == "__main__":
    sys.exit(try_page(sys.argv[1], problems_of))
