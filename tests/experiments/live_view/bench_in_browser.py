#!/usr/bin/env python3
"""Watches a served bench in headless Chromium: bench_in_browser.py ADDRESS READY [--pictures FOLDER]. Makes the file READY
once the page is open. The robot and its charts move while a controller runs it, nothing of a controller is shown, and a run
that begins anew begins an empty page."""

import argparse
import pathlib
import shutil
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser import Browser, until  # noqa: E402


def problems_of(browser, ready, pictures):
    if not until(browser, "return document.title !== ''"):
        yield "the page did not open"
    ready.write_text("")
    if not until(browser, "return report.times.length > 20 && report.times.at(-1) > 0.4"):
        yield "no samples came"
        return
    elbow = until(browser, "return document.querySelector('#scene .elbow')?.getAttribute('cx')")
    if not until(browser, f"return document.querySelector('#scene .elbow').getAttribute('cx') != {elbow!r}"):
        yield "the robot stands still"
    if not until(browser, "return report.lanes.some((lane) => lane.name === 'contact' && lane.changes.length > 1)"):
        yield "the contact is not seen"
    lanes = browser.run("return report.lanes.map((lane) => lane.name)")
    if not {"contact", "drives", "brakes"} <= set(lanes) or {"detector", "mode", "torque gate"} & set(lanes):
        yield f"it shows the lanes {lanes}"
    if pictures:
        browser.screenshot(pictures / "bench.png")
    if not until(browser, "return report.times.length > 0 && report.times[0] < 0.2 && report.times.at(-1) < 0.5"):
        yield "the next run did not begin an empty page"
    yield from (f"the console says: {message}" for message in browser.console_errors())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("address")
    parser.add_argument("ready", type=pathlib.Path)
    parser.add_argument("--pictures", type=pathlib.Path)
    options = parser.parse_args()
    if not shutil.which("chromedriver"):
        options.ready.write_text("")
        print("there is no chromedriver (Debian: chromium-driver)")
        return 77
    with Browser(1400, 1400) as browser:
        browser.open(options.address)
        problems = list(problems_of(browser, options.ready, options.pictures))
    for problem in problems:
        print(problem)
    return 1 if problems else 0


sys.exit(main())
