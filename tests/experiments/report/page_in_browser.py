#!/usr/bin/env python3
"""Opens a report page in headless Chromium, uses it as a reader would, and finds nothing wrong.

    tests/experiments/report/page_in_browser.py PAGE.html [--pictures FOLDER]

Exit status 0: nothing wrong; 1: what is wrong is printed; 77: there is no chromedriver to try it with.
"""

import argparse
import base64
import os
import pathlib
import re
import shutil
import sys
import tempfile

from browser import Browser

LOOKS = [(1400, 900, "light"), (1400, 900, "dark"), (1240, 768, "light"), (1100, 800, "light"), (800, 1000, "light"), (800, 1000, "dark"), (390, 800, "light")]


class Page:
    """The page under test and what was found wrong with it."""

    def __init__(self, browser, path):
        self.browser = browser
        self.path = path
        self.problems = []

    def open(self):
        self.browser.open(self.path.resolve().as_uri())

    def value(self, expression):
        return self.browser.run(f"return {expression}")

    def expect(self, condition, problem):
        if not condition:
            self.problems.append(problem)

    def expect_silence(self, doing):
        for message in self.browser.console_errors():
            self.problems.append(f"{doing}: the console says: {message}")

    def has(self, selector):
        return self.value(f"(e => e !== null && e.checkVisibility())(document.querySelector({selector!r}))")


def stands_alone(page):
    """It loads nothing, and no link or source in it points anywhere else."""
    page.expect(page.value("performance.getEntriesByType('resource').length") == 0, "it loads other files")
    outside = page.value("[...document.querySelectorAll('[src], link[href], img, iframe, object')]"
                         ".map(e => e.src || e.href).filter(url => !url.startsWith('data:'))")
    page.expect(outside == [], f"it refers to {outside}")


def tells_the_verdict(page):
    page.expect(page.value("document.title.length > 0 && document.documentElement.lang === 'en'"), "no title or language")
    page.expect(page.value("byId('verdict-mark').textContent") in ("✓ Passed", "✓ Passed, with remarks", "✗ Not passed"), "no verdict")
    page.expect(page.value("byId('verdict-mark').classList.contains('good') === report.good"), "the verdict is not the report's")
    plain = page.value("byId('verdict-mark').textContent === '✓ Passed'")
    page.expect(not plain or page.value("report.remarks.length === 0"), "remarks, but a plain 'passed'")
    stopped = page.value("report.fault !== ''")
    page.expect(not stopped or page.value("byId('summary').textContent.includes(report.fault)"), "the fault is not told")
    page.expect(page.value("byId('reasons').hidden === (report.reasons.length === 0)"), "reasons are hidden, or none shown")
    for table, entries in (("#reasons li", "reasons"), ("#remarks li", "remarks"), ("#checks-off li", "checks_off"), ("#contacts tbody tr", "contacts"), ("#measure-table tbody tr", "measures"),
                           ("#parameters tbody tr", "parameters"), ("#provenance div", "provenance")):
        rows = page.value(f"document.querySelectorAll({table!r}).length")
        page.expect(rows == page.value(f"report.{entries}.length"), f"{rows} rows for the {entries} of the report")
    several = page.value("report.contacts.filter(c => c.several_contacts).length")
    page.expect(several == page.value("[...document.querySelectorAll('#contacts tbody tr')]"
                                      ".filter(row => row.textContent.includes('no single contact explains the wrench')).length"),
                "the contacts that no single one explains are not told")
    text = page.value("document.body.innerText")
    clamped = page.value("report.contacts.map(c => c.clamping_leg && `${capitalised(c.clamping_leg)} clamped the ${c.object}`)"
                         ".filter(sentence => !byId('events').textContent.includes(sentence))")
    page.expect(clamped == [], f"what happened lacks {clamped}")
    closes = page.value("report.lanes.some(lane => lane.name === 'torque gate' && laneSpans(lane).some(span => lane.states[span.state] === 'closed'))")
    page.expect(not closes or page.value("byId('events').textContent.includes(`The torque gate closes: ${report.fault}`)"),
                "what happened does not tell that the gate closed")
    untold = page.value("report.lanes.filter(lane => lane.name === 'reaction').flatMap(lane => lane.changes)"
                        ".map(([, state]) => report.lanes.find(lane => lane.name === 'reaction').states[state])"
                        ".filter(told => told !== 'none' && !byId('events').textContent.includes(`The robot ${told}.`))")
    page.expect(untold == [], f"what happened does not tell that the robot {untold}")
    above = page.value("report.contacts.filter(c => c.force_limit !== null && c.over_limit > 0).length")
    page.expect(text.count("above it for") == above, f"the table does not tell how long {above} contacts were above their limit")
    wrong = re.findall(r"\b(?:the both|NaN|undefined|null|Infinity|\[object \w+\])", text)
    page.expect(not wrong, f"the text of the page contains {wrong}")


def has_names_for_everything(page):
    nameless = page.value("[...document.querySelectorAll('button, input, select, svg[role]')]"
                          ".filter(e => e.checkVisibility() && !(e.innerText || e.getAttribute('aria-label') || e.labels?.length)).map(e => e.outerHTML)")
    page.expect(nameless == [], f"without a name: {nameless}")


def picture(page):
    """Everything that the reader sees of one time."""
    return page.value("[byId('clock').innerText, byId('scene').innerHTML, byId('overview').innerHTML,"
                      " [...document.querySelectorAll('.reading, .cursor')].map(e => e.innerText + e.style.cssText).join()].join()")


def slider_moves_everything(page):
    last = page.value("lastSample")
    seen = set()
    for share in (0.0, 0.25, 0.5, 0.75, 1.0):
        sample = round(share * last)
        page.browser.run("const s = byId('time'); s.value = String(arguments[0]);"
                         "s.dispatchEvent(new Event('input', {bubbles: true}))", sample)
        page.expect(page.value("clock.sample") == sample, f"the slider at {sample} shows sample {page.value('clock.sample')}")
        page.expect(f"{page.value(f'timeOf({sample})'):.3f} s" in page.value("byId('clock').innerText"), "the clock is wrong")
        page.expect(page.value("""charts.all.every(({graph, cursor}) => Math.abs(
            graph.toDomXCoord(timeOf(clock.sample)) - new DOMMatrix(cursor.style.transform).e) < 0.6)"""), "a cursor is off")
        seen.add(picture(page))
    page.expect(len(seen) == 5, "the picture does not follow the slider")
    page.expect_silence("moving the slider")


def obstacles_are_where_they_are(page):
    """An obstacle with columns is drawn as far from its place as they say, in pixels of the view that is shown."""
    wrong = page.value("""[0, 0.5, 1].flatMap((share) => {
        clock.seek(Math.round(share * lastSample));
        const view = scene.isTurned ? scene.turned : scene.views[0];
        return view.obstacleGroups.filter((drawn, i) => {
            const found = new DOMMatrix(getComputedStyle(drawn).transform);
            const moved = has(`obstacle_${i + 1}_x`) ? vectorAt(`obstacle_${i + 1}_`, clock.sample) : [0, 0, 0];
            const [x, y] = view.flat(moved);
            return Math.abs(found.e - x * view.scale) > 0.1 || Math.abs(found.f + y * view.scale) > 0.1;
        }).map((drawn) => drawn.textContent);
    })""")
    page.expect(wrong == [], f"obstacles are drawn at the wrong place: {wrong}")


def labels_are_inside(page):
    """What stands in the robot's views is not cut by their frames."""
    cut = page.value("""[...document.querySelectorAll('#scene .view')].filter((view) => view.getBoundingClientRect().width > 0).flatMap((view) => {
        const frame = view.getBoundingClientRect();
        return [...view.querySelectorAll('.layer-marks text')].filter((text) => {
          const box = text.getBoundingClientRect();
          return box.left < frame.left - 1 || box.right > frame.right + 1;
        }).map((text) => text.textContent); })""")
    page.expect(cut == [], f"these labels are cut: {cut}")


def robots_in_space_turn(page):
    """By mouse and keys, which leave the clock alone; the three sides stand beside."""
    if not page.value("isSpatial && scene.available()"):
        page.expect(not page.value("byId('view-turned').checkVisibility()"), "a planar robot can be turned")
        return
    page.browser.run("byId('scene').scrollIntoView({block: 'center'}); clock.seek(20)")
    x, y, width, height = page.value("(({x, y, width, height}) => [x, y, width, height])(byId('scene').getBoundingClientRect())")
    place = lambda across, down: (x + across * width, y + down * height)
    seen = lambda: page.value("[scene.turned.azimuth, scene.turned.elevation, scene.turned.scale]")
    before = seen()
    page.browser.drag(place(0.4, 0.5), place(0.6, 0.6))
    turned = seen()
    page.expect(turned[0] < before[0] and turned[1] > before[1], f"dragging turns from {before} to {turned}")
    page.browser.press("left")
    page.expect(seen()[0] < turned[0] and page.value("clock.sample") == 20, "an arrow key does not turn the robot alone")
    page.browser.run("scene.turned.svg.dispatchEvent(new WheelEvent('wheel', {deltaY: -200, bubbles: true, cancelable: true}))")
    page.expect(seen()[2] > before[2], "the wheel does not zoom")
    page.expect(page.value("Math.abs(dot(scene.turned.right, scene.turned.up)) < 1e-9"), "the view is skewed")
    page.browser.click("#view-whole")
    page.expect(abs(seen()[2] - before[2]) < 1e-9 * before[2], "'Whole robot' does not show the whole robot")
    page.browser.click("#view-sides")
    page.expect(page.value("document.querySelectorAll('#scene .sides .view').length") == 3, "there are no three sides")
    shown = page.value("['sides', 'turned'].map((name) => document.querySelector(`#scene .${name}`).getBoundingClientRect().width > 0)")
    page.expect(shown == [True, False], f"'Three sides' shows {shown} of the sides and the turned robot")
    obstacles_are_where_they_are(page)
    labels_are_inside(page)
    page.browser.click("#view-turned")
    page.browser.run("document.activeElement.blur()")
    page.expect_silence("turning the robot")


def keys_step(page):
    page.browser.run("document.activeElement.blur(); clock.seek(20)")
    for keys, sample in ((["right"], 21), (["right", "right"], 23), (["left"], 22), (["shift+right"], 32), (["shift+left"], 22)):
        page.browser.press(*keys)
        found = page.value("clock.sample")
        page.expect(found == sample, f"{keys} lead to sample {found}, not {sample}")
    page.browser.press("space")
    page.browser.run("return new Promise(done => setTimeout(done, 400))")
    page.browser.press("space")
    stopped = page.value("clock.sample")
    page.expect(stopped > 22, "space does not play")
    page.expect(page.value("!clock.playing"), "space does not pause")
    page.browser.run("clock.seek(lastSample - 2); clock.play(); return new Promise(done => setTimeout(done, 400))")
    page.expect(page.value("!clock.playing && clock.sample === lastSample"), "it does not stop at the end")
    page.expect_silence("stepping and playing")


def first_plot(page):
    """A function that gives the window's coordinates of a place in the first chart, 0 ... 1 from its left."""
    page.browser.run("document.querySelector('.plot').scrollIntoView({block: 'center'})")
    x, y, width, height = page.value("(({x, y, width, height}) => [x, y, width, height])"
                                     "(document.querySelector('.plot').getBoundingClientRect())")
    return lambda share: (x + share * width, y + 0.5 * height)


def charts_read_under_the_mouse(page):
    page.browser.click("#window-whole")
    place = first_plot(page)
    page.browser.run("clock.seek(0); window.readAt = []; const read = charts.read;"
                     "charts.read = function (sample) { window.readAt.push(sample); read.call(charts, sample); }")
    page.browser.hover(place(0.75))
    page.expect(page.value("window.readAt.at(-1) > 0.5 * lastSample"), "the readings do not follow the mouse")
    page.expect(page.value("clock.sample") == 0, "the mouse moves the time")
    page.browser.hover((2, 2))
    page.expect(page.value("window.readAt.at(-1)") == 0, "the readings do not return to the time shown")
    page.expect_silence("hovering over a chart")


def charts_zoom_together(page):
    page.browser.click("#window-whole")
    place = first_plot(page)
    page.browser.drag(place(0.4), place(0.6))
    windows = page.value("charts.all.map(({graph}) => graph.xAxisRange())")
    page.expect(all(window == windows[0] for window in windows), f"the charts show different windows: {windows}")
    share = page.value("(charts.window[1] - charts.window[0]) / (wholeRun[1] - wholeRun[0])")
    page.expect(0.1 < share < 0.35, f"dragging over a fifth of the chart shows {share:.2f} of the run")
    page.browser.click("#window-whole")
    page.expect(page.value("charts.window.join() === wholeRun.join()"), "'Whole run' does not show the whole run")
    if page.value("report.contacts.length") > 0:
        for name in ("contact", "detection"):
            page.browser.click(f"#window-{name}")
            page.expect(page.value("charts.window[1] - charts.window[0] < wholeRun[1] - wholeRun[0]"), f"'{name}' does not zoom")
    page.expect_silence("zooming the charts")


def charts_keep_peaks(page):
    lost = page.value("""charts.all.filter(chart => chart.series.some(({values}, i) => {
        const drawn = rowsOf(chart, wholeRun).map(row => row[i + 1]);
        const [a, b] = [lowestAndHighest(drawn, 0, drawn.length), lowestAndHighest(values, 0, values.length)];
        return a[0] !== b[0] || a[1] !== b[1]; })).map(chart => chart.id)""")
    page.expect(lost == [], f"peaks are lost in the charts {lost}")


def buttons_do_what_they_say(page):
    if page.has("#view-close"):
        page.browser.click("#view-close")
        page.expect(page.value("byId('view-close').getAttribute('aria-pressed')") == "true", "the close-up does not open")
        page.browser.click("#view-whole")
    if page.has(".legend button"):
        page.browser.run("document.querySelector('.legend button').click()")
        page.expect(page.value("charts.all.some(({graph}) => graph.visibility().includes(false))"), "a series cannot be hidden")
        page.browser.run("document.querySelector('.legend button').click()")
    if page.has("#events button"):
        page.browser.run("[...document.querySelectorAll('#events button')].at(-1).click()")
    if page.has("#watch"):
        page.browser.run("byId('watch').click(); return new Promise(done => setTimeout(done, 300))")
        page.expect(page.value("clock.playing"), "the contact is not played")
        page.browser.run("clock.pause()")
    page.expect_silence("pressing buttons")


def parameters_can_be_searched(page):
    count = page.value("report.parameters.length")
    if count == 0:
        return
    page.browser.run("byId('parameters-box').open = true; const s = byId('search'); s.value = report.parameters[0].name;"
                     "s.dispatchEvent(new Event('input'))")
    shown = page.value("[...document.querySelectorAll('#parameters tbody tr')].filter(row => !row.hidden).length")
    page.expect(1 <= shown <= count, f"searching for a parameter shows {shown}")
    page.browser.run("const s = byId('search'); s.value = 'no such thing'; s.dispatchEvent(new Event('input'))")
    shown = page.value("[...document.querySelectorAll('#parameters tbody tr')].filter(row => !row.hidden).length")
    page.expect(shown == 0, f"searching for nonsense shows {shown} parameters")
    page.expect_silence("searching")


def fits_on_paper(page):
    """A run with one contact takes four sheets of A4 at most, without parameters and files that nobody unfolded."""
    page.open()
    sheets = len(re.findall(rb"/Type\s*/Page\b", base64.b64decode(page.browser.devtools(
        "Page.printToPDF", preferCSSPageSize=True, paperWidth=8.27, paperHeight=11.69)["data"])))
    allowed = 4 if page.value("report.contacts.length") <= 1 else 8
    page.expect(1 <= sheets <= allowed, f"the page prints on {sheets} sheets")


def fits_every_window(page, pictures):
    for width, height, scheme in LOOKS:
        page.browser.look(width, height, scheme)
        page.open()
        over = page.value("document.documentElement.scrollWidth - innerWidth")
        page.expect(over <= 0, f"at a width of {width} the page is {over} pixels too wide")
        hidden = page.value("[...document.querySelectorAll('.stage button')].filter(e => e.getBoundingClientRect().width > 0 &&"
                            " e.getBoundingClientRect().right > e.closest('.stage').getBoundingClientRect().right + 1).map(e => e.innerText)")
        page.expect(hidden == [], f"at a width of {width} these buttons are cut off: {hidden}")
        if width >= 800:
            cut = page.value("[...document.querySelectorAll('.scroll')].filter(e => e.scrollWidth > e.clientWidth).length")
            page.expect(cut == 0, f"at a width of {width}, {cut} tables are cut off")
        page.expect_silence(f"{width} pixels, {scheme}")
        if pictures:
            page.browser.screenshot(pictures / f"{width}_{scheme}.png")
    page.browser.devtools("Emulation.clearDeviceMetricsOverride")


def broken_page_is_noticed(page):
    """The test itself can fail: a copy of the page with an error in its script is found out."""
    text = page.path.read_text(encoding="utf-8")
    with tempfile.TemporaryDirectory() as folder:
        broken = pathlib.Path(folder) / "broken.html"
        broken.write_text(text.replace("showVerdict();", "showVerdikt();", 1), encoding="utf-8")
        page.browser.open(broken.as_uri())
        page.expect(any("showVerdikt" in message for message in page.browser.console_errors()),
                    "an error in the script of the page went unnoticed")


def use(page, pictures):
    page.open()
    page.expect_silence("opening the page")
    if page.problems:
        return
    stands_alone(page)
    tells_the_verdict(page)
    has_names_for_everything(page)
    if page.value("lastSample") > 100:
        slider_moves_everything(page)
        obstacles_are_where_they_are(page)
        labels_are_inside(page)
        robots_in_space_turn(page)
        keys_step(page)
        charts_read_under_the_mouse(page)
        charts_zoom_together(page)
        charts_keep_peaks(page)
        buttons_do_what_they_say(page)
    parameters_can_be_searched(page)
    fits_on_paper(page)
    fits_every_window(page, pictures)
    broken_page_is_noticed(page)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("page", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path, help="folder for a screenshot of every size and colour scheme")
    arguments = parser.parse_args()
    if not shutil.which("chromedriver"):
        print("there is no chromedriver (Debian: chromium-driver)")
        return 77
    if arguments.pictures:
        os.makedirs(arguments.pictures, exist_ok=True)
    with Browser() as browser:
        page = Page(browser, arguments.page)
        use(page, arguments.pictures)
    for problem in page.problems:
        print(f"{arguments.page}: {problem}")
    return 1 if page.problems else 0


if __name__ == "__main__":
    sys.exit(main())
