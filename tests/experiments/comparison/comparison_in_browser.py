#!/usr/bin/env python3
"""Opens the page of a comparison in headless Chromium and uses its charts.

    tests/experiments/comparison/comparison_in_browser.py PAGE.html

Exit status 0: nothing wrong; 1: what is wrong is printed; 77: there is no chromedriver to try it with.
"""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "report"))
from browser import try_page

CHARTS = """return (() => ({
    charts: charts.all.length, asked: chartList().length, series: charts.all.map((chart) => chart.series.length),
    verdicts: byId("verdicts").querySelectorAll("tbody tr").length, settings: byId("settings").querySelectorAll("tbody tr").length,
    expected: report.settings.length,
}))()"""

# All charts read the values at one time, and show one stretch.
MOVED = """return (() => {
    clock.seekTime(wholeRun[0] + 0.4 * (wholeRun[1] - wholeRun[0]));
    charts.setWindow([wholeRun[0] + 1, wholeRun[0] + 2]);
    const sample = clock.sample;
    return charts.all.map((chart) => ({
        read: chart.readings.map((reading) => reading.textContent),
        values: chart.series.map((series) => fixed(series.values[sample], chart.decimals)),
        window: chart.graph.xAxisRange().map((time) => time - wholeRun[0]),
    }));
})()"""


def problems_of(browser):
    seen = browser.run(CHARTS)
    if seen["charts"] == 0 or seen["charts"] != seen["asked"]:
        yield f"{seen['charts']} charts are drawn of {seen['asked']}"
    if min(seen["series"], default=0) < 2:
        yield "a chart has one recording only"
    if seen["verdicts"] == 0 or seen["settings"] != seen["expected"]:
        yield "a table lacks rows"
    for chart in browser.run(MOVED):
        if chart["read"] != chart["values"]:
            yield f"a legend reads {chart['read']} instead of {chart['values']}"
        if abs(chart["window"][0] - 1) > 1e-6 or abs(chart["window"][1] - 2) > 1e-6:
            yield f"a chart shows {chart['window']}"


if __name__ == "__main__":
    sys.exit(try_page(sys.argv[1], problems_of))
