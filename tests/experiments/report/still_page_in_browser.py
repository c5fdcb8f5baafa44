#!/usr/bin/env python3
"""Opens a page that is only read at the widths of a desktop, a tablet and a phone, light and dark,
and prints it.

    tests/experiments/report/still_page_in_browser.py PAGE.html [--pictures FOLDER]

Exit status 0: nothing wrong; 1: what is wrong is printed; 77: there is no chromedriver to try it with.
"""

import base64
import pathlib
import re
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
from browser import try_page

LOOKS = [(1400, 900, "light"), (1400, 900, "dark"), (800, 1000, "light"), (390, 800, "light"), (390, 800, "dark")]
MOST_PRINTED = 8

# Texts that end outside of the box that cuts them, or of the picture that they stand in.
CUT = """return [...document.querySelectorAll('td, th, p, li, h1, h2, h3, dd, dt, svg text, code')].filter((e) => {
    const box = e.getBoundingClientRect();
    if (box.width === 0) return false;
    const frame = (e.closest('svg') ?? e.closest('.scroll') ?? document.documentElement).getBoundingClientRect();
    return box.left < frame.left - 1 || box.right > frame.right + 1;
}).map((e) => e.textContent.slice(0, 60))"""

# The contrast of each text with what is behind it, [WCAG 2.1] 1.4.3.
FAINT = """return (() => {
    const numbers = (colour) => colour.match(/[\\d.]+/g).map(Number);
    const light = (colour) => {
        const [r, g, b] = numbers(colour).map((v) => v / 255).map((v) => v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4);
        return 0.2126 * r + 0.7152 * g + 0.0722 * b;
    };
    const behind = (e) => {
        for (let up = e; up; up = up.parentElement) {
            const colour = getComputedStyle(up).backgroundColor;
            if (!/, 0\\)$|transparent/.test(colour)) return colour;
        }
        return 'rgb(255, 255, 255)';
    };
    return [...document.querySelectorAll('td, th, p, li, h1, h2, h3, dd, dt, code, a')].filter((e) => {
        if (!e.textContent.trim()) return false;
        const [a, b] = [light(getComputedStyle(e).color), light(behind(e))].sort((x, y) => y - x);
        return (a + 0.05) / (b + 0.05) < 4.5;
    }).map((e) => `${e.tagName} '${e.textContent.slice(0, 40)}'`);
})()"""


def problems_of(browser, pictures=None):
    if browser.run("return performance.getEntriesByType('resource').length"):
        yield "it loads other files"
    if not browser.run("return document.title.length > 0 && document.documentElement.lang === 'en'"):
        yield "it has no title or language"
    wrong = re.findall(r"\b(?:NaN|nan|undefined|null|Infinity|inf)\b", browser.run("return document.body.innerText"))
    if wrong:
        yield f"its text contains {wrong}"
    nameless = browser.run("return [...document.querySelectorAll('svg')].filter(e => !e.getAttribute('aria-label') "
                           "&& !e.getAttribute('aria-labelledby') && e.getAttribute('aria-hidden') !== 'true').length")
    if nameless:
        yield f"{nameless} drawings have no name for those who cannot see them"
    for width, height, scheme in LOOKS:
        look = f"{width} pixels, {scheme}"
        browser.look(width, height, scheme)
        over = browser.run("return document.documentElement.scrollWidth - innerWidth")
        if over > 0:
            yield f"{look}: the page is {over} pixels too wide"
        for text in browser.run(CUT):
            yield f"{look}: '{text}' is cut off"
        for text in browser.run(FAINT):
            yield f"{look}: {text} can hardly be read"
        if pictures:
            browser.screenshot(pathlib.Path(pictures) / f"{width}_{scheme}.png")
    browser.devtools("Emulation.clearDeviceMetricsOverride")
    printed = base64.b64decode(browser.devtools("Page.printToPDF")["data"])
    sheets = len(re.findall(rb"/Type\s*/Page\b", printed))
    if not 1 <= sheets <= MOST_PRINTED:
        yield f"it prints on {sheets} sheets"
    if pictures:
        (pathlib.Path(pictures) / "printed.pdf").write_bytes(printed)


if __name__ == "__main__":
    folder = sys.argv[3] if sys.argv[2:3] == ["--pictures"] else None
    sys.exit(try_page(sys.argv[1], lambda browser: problems_of(browser, folder)))
