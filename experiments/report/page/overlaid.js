"use strict";
// Charts of several sources at once: a series for each of report.runs, its colour the same in all of them.

const runColours = ["--leg-1", "--true", "--leg-4", "--leg-2", "--leg-3", "--leg-6", "--leg-5", "--plain"];

function colourOfRun(run) {
  return runColours[run % runColours.length];
}

/** Decimals that show four significant digits of the largest value, but at least one. */
function decimalsOf(series) {
  const sizes = series.flatMap(({ values }) => values.map((value) => Math.abs(value ?? 0)));
  const largest = sizes.reduce((size, value) => Math.max(size, value), 0);
  return largest > 0 ? Math.min(7, Math.max(1, 3 - Math.floor(Math.log10(largest)))) : 1;
}

/** Smallest span that an axis shows: a ten-thousandth of what is there, so that rounding is not blown up. */
function leastOf(series) {
  const sizes = series.flatMap(({ values }) => values.map((value) => Math.abs(value ?? 0)));
  return 1e-4 * sizes.reduce((size, value) => Math.max(size, value), 1e-9);
}

function chartList() {
  return report.charts.filter((chart) => chart.series.some(({ values }) => values.some((value) => value !== null)))
    .map((chart) => ({
      ...chart,
      scale: 1,
      bounds: [],
      least: leastOf(chart.series),
      decimals: decimalsOf(chart.series),
      series: chart.series.map(({ run, values }) =>
        ({ label: report.runs[run].name, values, colour: colourOfRun(run), wide: false })),
    }));
}
