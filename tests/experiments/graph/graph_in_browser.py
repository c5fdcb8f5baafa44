#!/usr/bin/env python3
"""Opens the page of a diagram in headless Chromium, searches it, folds it and goes inside.

    tests/experiments/graph/graph_in_browser.py PAGE.html

Exit status 0: nothing wrong; 1: what is wrong is printed; 77: there is no chromedriver to try it with.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser import try_page

SEEN = """return (() => ({
    blocks: [...blocks.values()].map((block) => block.path), pictures: Object.keys(data.pictures),
    drawn: [...byId("picture").querySelectorAll(".node")].map(pathOf).filter(Boolean),
    wires: [...byId("picture").querySelectorAll(".edge")].map((wire) => wire.id),
    text: document.body.innerText,
}))()"""

SEARCHED = """return (() => {
    byId("search").value = arguments[0];
    byId("search").dispatchEvent(new Event("input"));
    return [...entries].filter(([path, { entry }]) => !entry.hidden).map(([path]) => path);
})()"""

SHOWN = """return (() => {
    show(blocks.get(arguments[0]));
    return {level: level.path, near: byId("picture").querySelectorAll(".near").length,
            chosen: [...byId("picture").querySelectorAll(".chosen")].map(pathOf),
            rows: byId("ports").querySelectorAll("tbody tr").length,
            wanted: selected.inputs.length + selected.outputs.length};
})()"""

FOLDED = """return (() => {
    byId("fold").click();
    const closed = [...document.querySelectorAll("#tree details details")].every((entry) => !entry.open);
    byId("unfold").click();
    return closed && [...document.querySelectorAll("#tree details")].every((entry) => entry.open);
})()"""


def problems_of(browser):
    seen = browser.run(SEEN)
    children = [path for path in seen["blocks"] if path and "/" not in path]
    if sorted(seen["drawn"]) != sorted(children):
        yield f"the outermost picture shows {seen['drawn']}, not {children}"
    if not seen["wires"] or not all(">" in wire for wire in seen["wires"]):
        yield f"wires without their ports: {seen['wires']}"
    if "undefined" in seen["text"] or "NaN" in seen["text"]:
        yield "the page shows 'undefined' or 'NaN'"
    inner = next(path for path in seen["blocks"] if "/" in path and path not in seen["pictures"])
    found = browser.run(SEARCHED, inner.rsplit("/", 1)[1])
    if inner not in found or len(found) >= len(seen["blocks"]):
        yield f"a search for {inner} shows {len(found)} of {len(seen['blocks'])}"
    if len(browser.run(SEARCHED, "")) != len(seen["blocks"]):
        yield "an empty search does not show all"
    shown = browser.run(SHOWN, inner)
    if shown["level"] != inner.rsplit("/", 1)[0] or shown["chosen"] != [inner] or shown["near"] == 0:
        yield f"{inner} is shown as {shown}"
    if shown["rows"] != shown["wanted"]:
        yield f"{shown['rows']} rows tell of {shown['wanted']} ports"
    if not browser.run(FOLDED):
        yield "the tree does not fold"


if __name__ == "__main__":
    sys.exit(try_page(sys.argv[1], problems_of))
