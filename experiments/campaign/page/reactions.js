"use strict";
// What became of force, time and the robot's limits in reactions: a dot for each run. [SafePR] Figures 22 to 24

const dotBox = { left: 56, top: 10, width: 480, height: 250, right: 26, bottom: 42 };

function showReactions() {
  const reactions = campaign.reactions;
  byId("reactions").hidden = !reactions;
  if (!reactions) return;
  const { runs, fits, limits } = reactions;
  const levels = [...new Set(runs.map((run) => run.level))];
  const bodies = [...new Set(runs.map((run) => run.body))];
  const byLevel = (run) => colourAmong(levels, run.level);
  const byBody = (run) => colourAmong(bodies, run.body);
  const fastest = Math.max(...runs.map((run) => run.speed ?? 0));
  const strongest = Math.max(1.05 * limits.transient, ...runs.map((run) => run.peak ?? 0));
  byId("force-limits").textContent = toldLimits(limits);

  const speed = { of: (run) => run.speed, last: fastest, name: "m/s at the onset" };
  const force = { of: (run) => run.peak, last: strongest, name: "N at most" };
  byId("force-panels").replaceChildren(...bodies.map((body) =>
    dotPanel(forceTitle(body, fits), runs.filter((run) => run.body === body), speed, force, byLevel,
      { across: limits.transient, line: fits.find((fit) => fit.body === body) })));
  showLegend("force-legend", levels);
  showFits(reactions);

  const transient = 1000 * limits.transient_duration;
  const removed = { of: (run) => 1000 * (run.duration ?? Infinity), name: "ms until removed",
    last: Math.max(1.3 * transient, longestOf(runs, (run) => run.duration)) };
  byId("contact-panels").replaceChildren(...bodies.map((body) =>
    dotPanel(capitalised(body), runs.filter((run) => run.body === body), removed, { ...force, name: "N" }, byLevel,
      { across: limits.transient, lasting: { from: transient, limit: limits.quasi_static } })));
  showLegend("contact-legend", levels);

  const duration = (name, of) => ({ of: (run) => milliseconds(of(run)), last: longestOf(runs, of), name });
  const detected = duration("ms until detected", (run) => run.detection);
  const given = duration("ms from there until removed", (run) => run.reaction);
  const most = { along: limits.transient };
  byId("duration-panels").replaceChildren(
    dotPanel("Detection", runs, force, detected, byBody, most), dotPanel("Reaction", runs, force, given, byBody, most));
  showLegend("duration-legend", bodies);

  const condition = (of) => ({ of, first: 0.4 * limits.sigma_kappa, last: 1.4 * limits.sigma_kappa, name: "condition number" });
  const distance = (of) => ({ of, first: 0.7 * limits.sigma_sc, last: 1.2 * limits.sigma_sc, name: "m between links of different legs" });
  const kept = { along: limits.sigma_kappa, across: limits.sigma_sc };
  byId("limit-panels").replaceChildren(
    dotPanel("Worst of each run", runs, condition((run) => run.kappa), distance((run) => run.sc), byLevel, kept),
    dotPanel("At the end", runs, condition((run) => run.kappa_end), distance((run) => run.sc_end), byLevel, kept),
    dotPanel("Best of each run", runs, condition((run) => run.kappa_best), distance((run) => run.sc_best), byLevel, kept));
  showLegend("limit-legend", levels);
}

/** Which forces are permitted, as the verdict judges them, and where the numbers are from. */
function toldLimits(limits) {
  return `Limits of ${limits.region}: ${chosenForce(limits.transient)} for the peak (${limits.transient_source}); ` +
    `${chosenForce(limits.quasi_static)} for what lasts longer than ${inMs(limits.transient_duration, 0)} ms (${limits.quasi_static_source}).`;
}

function chosenForce(force) {
  return `${chosen(force)} N`;
}

/** The fitted lines, and the speeds at which they reach the limits. [SafePR] Table V */
function showFits({ fits, fit_of_all: all, limits }) {
  const speed = (value) => cell(value === null ? none : fixed(value, 2));
  const rows = [...fits, ...(all ? [all] : [])].map((fit) => element("tr", {},
    element("th", { scope: "row" }, fit.body), cell(String(fit.n)), cell(fixed(fit.pearson, 3)), cell(fixed(fit.slope, 0)),
    cell(fixed(fit.intercept, 0)), speed(fit.speed_at_transient), speed(fit.speed_at_quasi_static)));
  byId("fit-table").replaceChildren(
    head([["Body"], ["Runs", "n"], ["r", "n"], ["Slope, N/(m/s)", "n"], ["At rest, N", "n"],
      [`m/s at ${chosenForce(limits.transient)}`, "n"], [`m/s at ${chosenForce(limits.quasi_static)}`, "n"]]),
    element("tbody", {}, ...rows));
}

function colourAmong(names, name) {
  return `var(${colourNames[names.indexOf(name) % colourNames.length]})`;
}

function milliseconds(seconds) {
  return seconds === null ? null : 1000 * seconds;
}

/** Nine tenths and half as much again: few that are very late would hide all others. */
function longestOf(runs, of) {
  const times = runs.map(of).filter((time) => time !== null).sort((a, b) => a - b);
  return times.length === 0 ? 1 : Math.min(1000 * times.at(-1), 1500 * times[Math.floor(0.95 * (times.length - 1))]);
}

function forceTitle(body, fits) {
  const fit = fits.find((each) => each.body === body);
  return fit ? `${capitalised(body)}: ${fixed(fit.slope, 0)} N/(m/s), r = ${fixed(fit.pearson, 3)}` : capitalised(body);
}

/** The share of an axis at which a value stands; what lies beyond its ends stands there. */
function shareOf({ first = 0, last }, value) {
  return Math.max(0, Math.min(1, (value - first) / (last - first)));
}

/** Dots of runs over two axes. `marks`: limits, a fitted line, and from when on what lasts has a limit of its own. */
function dotPanel(title, runs, across, up, colour, marks = {}) {
  const { left, top, width, height, right, bottom } = dotBox;
  const svg = picture(left + width + right, top + height + bottom, `${title}: ${up.name} over ${across.name}`);
  const x = (value) => left + width * shareOf(across, value);
  const y = (value) => top + height * (1 - shareOf(up, value));
  for (const tick of roundNumbers(across.last).filter((each) => each >= (across.first ?? 0))) {
    shape(svg, "line", { class: "grid", x1: x(tick), x2: x(tick), y1: top, y2: top + height });
    write(svg, x(tick), top + height + 16, chosen(tick), { class: "tick" });
  }
  for (const tick of roundNumbers(up.last).filter((each) => each >= (up.first ?? 0))) {
    shape(svg, "line", { class: "grid", x1: left, x2: left + width, y1: y(tick), y2: y(tick) });
    write(svg, left - 6, y(tick) + 4, chosen(tick), { class: "tick end" });
  }
  write(svg, left + width, top + height + 34, across.name, { class: "tick end" });
  write(svg, left, top + height + 34, `${up.name}, upwards`, { class: "tick start" });
  for (const run of runs) {
    if (across.of(run) === null || up.of(run) === null) continue;
    const place = { cx: x(across.of(run)), cy: y(up.of(run)) };
    const dot = shape(svg, "circle", { class: "run-dot", style: `--colour: ${colour(run)}`, ...place, r: 3 });
    shape(dot, "title").textContent = `--run ${run.run}: ${run.level}, ${run.body}`;
  }
  if (marks.across) shape(svg, "line", { class: "limit", x1: left, x2: left + width, y1: y(marks.across), y2: y(marks.across) });
  if (marks.along) shape(svg, "line", { class: "limit", x1: x(marks.along), x2: x(marks.along), y1: top, y2: top + height });
  if (marks.lasting) lastingForces(svg, marks.lasting, runs, across, colour, x, y);
  if (marks.line) fittedLine(svg, marks.line, across.last, up.last, x, y);
  return panel(title, svg);
}

/** Rings for what lasted, and its limit from then on. */
function lastingForces(svg, { from, limit }, runs, across, colour, x, y) {
  for (const run of runs.filter((each) => each.lasting !== null)) {
    const place = { cx: x(across.of(run)), cy: y(run.lasting) };
    const ring = shape(svg, "circle", { class: "none-seen", style: `--colour: ${colour(run)}`, ...place, r: 3 });
    shape(ring, "title").textContent = `--run ${run.run}: ${run.level}, ${run.body}, what lasted`;
  }
  shape(svg, "line", { class: "limit", x1: x(from), x2: x(across.last), y1: y(limit), y2: y(limit) });
}

/** As far as it stays within the panel. */
function fittedLine(svg, { slope, intercept }, last, most, x, y) {
  const at = (value) => intercept + slope * value;
  const reaching = (force) => (force - intercept) / slope;
  const [enters, leaves] = slope < 0 ? [reaching(most), reaching(0)] : [reaching(0), reaching(most)];
  const [begin, end] = [Math.max(0, enters), Math.min(last, leaves)];
  if (begin < end) shape(svg, "line", { class: "fit", x1: x(begin), x2: x(end), y1: y(at(begin)), y2: y(at(end)) });
}

function showLegend(id, names) {
  byId(id).replaceChildren(...names.map((name) => {
    const swatch = element("span", { class: "dot" });
    swatch.style.background = colourAmong(names, name);
    return element("span", {}, swatch, name);
  }));
}
