#!/usr/bin/env python3
"""Watches a simulated run in headless Chromium: live_in_browser.py ADDRESS [--pictures FOLDER]. Robot and charts move,
sooner or later; buttons pause it, take one tick, change its speed; in the end the page is the report."""

import argparse
import json
import pathlib
import shutil
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser import Browser, until  # noqa: E402

SEEN = """return {time: report.times.at(-1), samples: report.times.length, state: byId("live-state").textContent,
                  elbow: document.querySelector("#scene .elbow")?.getAttribute("cx"), lag: live.lag,
                  clock: byId("clock").textContent,
                  ends: Object.fromEntries(charts.all.map((chart) => [chart.id, chart.graph.xAxisRange()[1]])),
                  drawn: Object.fromEntries(charts.all.map((chart) => [
                      chart.id, chart.plot.querySelector("canvas").toDataURL().length]))}"""
FRAME = 33  # milliseconds that pass before samples are taken from the loop


def problems_while_running(browser):
    if not until(browser, "return report.times.length > 20 && charts.all.length > 3"):
        yield "no samples came"
        return
    first = browser.run(SEEN)
    if not until(browser, f"return report.times.at(-1) > {first['time']} && byId('clock').textContent !== {first['clock']!r}"):
        yield f"the time stands still at {first['time']} s"
    if not until(browser, f"return document.querySelector('#scene .elbow').getAttribute('cx') != {first['elbow']!r}"):
        yield "the robot stands still"
    # Others may become worth showing meanwhile.
    known = "charts.all.filter((chart) => chart.id in ends)"
    if not until(browser, f"const ends = {json.dumps(first['ends'])}; return {known}.length > 3 && "
                          f"{known}.every((chart) => chart.graph.xAxisRange()[1] > ends[chart.id])"):
        yield "a chart stands still"
    if not until(browser, f"const drawn = {json.dumps(first['drawn'])}; return charts.all.filter((chart) => chart.id in drawn"
                          " && chart.plot.querySelector('canvas').toDataURL().length !== drawn[chart.id]).length > 2"):
        yield "the charts look the same"
    lags = []
    for _ in range(20):
        time.sleep(0.05)
        lags.append(browser.run("return live.lag"))
    median = sorted(lags)[len(lags) // 2] + FRAME
    print(f"from the loop to the screen: median {median} ms, most {max(lags) + FRAME} ms")


def settled(browser, looks=60):
    """What is seen once no more samples come, as is so soon after a pause; None where they go on coming."""
    before = browser.run(SEEN)
    for _ in range(looks):
        time.sleep(0.5)
        now = browser.run(SEEN)
        if now["time"] == before["time"]:
            return now
        before = now
    return None


def set_speed(browser, speed):
    """Where the run has ended meanwhile, it has none."""
    browser.run(f"if (typeof live !== 'undefined') {{ byId('speed').value = '{speed}'; "
                "byId('speed').dispatchEvent(new Event('change')); }")


def problems_of_orders(browser):
    browser.click("#pause")
    if not until(browser, "return byId('live-state').textContent === 'paused'"):
        yield "it does not pause"
    before = settled(browser)
    if before is None:
        yield "it goes on while it is paused"
        return
    browser.click("#tick")
    if not until(browser, f"return report.times.length === {before['samples'] + 1}"):
        yield "one tick is not one sample"
    after = browser.run(SEEN)
    if abs(after["time"] - before["time"] - 1e-3) > 1e-9:
        yield f"one tick took {after['time'] - before['time']} s"
    set_speed(browser, "0.02")
    browser.click("#pause")
    if not until(browser, f"return report.times.at(-1) > {after['time'] + 0.05}"):
        yield "it does not go on"
    if browser.run("return byId('speed').value") != "0.02":
        yield "the speed was not changed"


def problems_of_contact(browser, pictures):
    """The robot runs into the pylon after half a second."""
    if not until(browser, "return report.contacts.length > 0 && report.contacts[0].detected !== null"):
        yield "no contact was seen"
    browser.run("charts.setWindow([0.3, 0.5])")
    if not browser.run("return !live.follows && !byId('follow').hidden"):
        yield "who looks at an earlier time is taken away from there"
    browser.click("#follow")
    if not until(browser, "return live.follows && clock.sample === lastSample"):
        yield "there is no way back"
    set_speed(browser, "10")
    if pictures:
        time.sleep(0.5)
        browser.screenshot(pictures / "live.png")


def problems_of(browser, pictures):
    yield from problems_while_running(browser)
    yield from problems_of_orders(browser)
    yield from problems_of_contact(browser, pictures)
    if not until(browser, "return document.title !== '' && location.pathname.endsWith('/report.html')"):
        yield "the page did not become the report"
    yield from (f"the console says: {message}" for message in browser.console_errors())


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("address")
    parser.add_argument("--pictures", type=pathlib.Path)
    options = parser.parse_args()
    if not shutil.which("chromedriver"):
        print("there is no chromedriver (Debian: chromium-driver)")
        return 77
    with Browser(1400, 1400) as browser:
        browser.open(options.address)
        problems = list(problems_of(browser, options.pictures))
    for problem in problems:
        print(problem)
    return 1 if problems else 0


sys.exit(main())
