"use strict";
// The samples that have come, in the report's data: the latest are kept, and what follows from them is kept up to date.

const mostSamples = 8000; // older ones are forgotten, a quarter at a time

report.times = [];

const samples = {
  /** Appends what a message brings. */
  append({ times, columns, lanes: fresh }) {
    const before = report.times.length;
    report.times.push(...times);
    for (const name of new Set([...Object.keys(report.columns), ...Object.keys(columns)])) {
      report.columns[name] ??= Array.from({ length: before }, () => null);
      report.columns[name].push(...(columns[name] ?? times.map(() => null)));
    }
    for (const lane of fresh) this.appendLane(lane, before);
    this.forget();
    lastSample = Math.max(0, report.times.length - 1);
    wholeRun = [report.times[0], report.times[lastSample]];
    if (lastSample > 0) report.period = Math.max(1e-6, (wholeRun[1] - wholeRun[0]) / lastSample);
    report.contacts = contactsSeen();
  },

  /** The run begins anew: nothing of the last one stays. */
  clear() {
    report.times = [];
    for (const name of Object.keys(report.columns)) report.columns[name] = [];
    report.lanes = [];
    report.contacts = [];
    lastSample = 0;
    clock.sample = -1;
  },

  /** States are matched by name: a message numbers them for itself. */
  appendLane(fresh, before) {
    let lane = report.lanes.find((each) => each.name === fresh.name);
    if (!lane) {
      lane = { name: fresh.name, states: [...fresh.states], changes: before ? [[0, -1]] : [] };
      report.lanes.push(lane);
    }
    for (const [sample, number] of fresh.changes) {
      const state = number < 0 ? -1 : this.stateIn(lane, fresh.states[number]);
      if (lane.changes.at(-1)?.[1] !== state) lane.changes.push([before + sample, state]);
    }
  },

  stateIn(lane, name) {
    if (!lane.states.includes(name)) lane.states.push(name);
    return lane.states.indexOf(name);
  },

  forget() {
    if (report.times.length <= mostSamples) return;
    const gone = report.times.length - (3 * mostSamples) / 4;
    for (const values of [report.times, ...Object.values(report.columns)]) values.splice(0, gone);
    for (const lane of report.lanes) {
      const now = stateOf(lane, gone);
      const later = lane.changes.filter(([sample]) => sample > gone).map(([sample, state]) => [sample - gone, state]);
      lane.changes = [[0, now], ...later];
    }
    if (clock.sample >= 0) clock.sample = Math.max(0, clock.sample - gone);
  },
};

/** Stretches of a lane that are not quiet. */
function busySpans(name) {
  const lane = report.lanes.find((each) => each.name === name);
  return lane ? laneSpans(lane).filter((span) => span.state > 0) : [];
}

/** Contacts as far as lanes tell of them: those that truly were, or else those that were detected. */
function contactsSeen() {
  const detections = busySpans("detector").map((span) => span.from);
  const truth = report.lanes.some((lane) => lane.name === "contact");
  const spans = truth ? busySpans("contact") : busySpans("detector");
  return spans.map(({ from, to }) => ({
    start: from,
    detected: detections.find((time) => time >= from && time <= to) ?? null,
    removed: to < wholeRun[1] ? to : null,
    peak_force: 0, peak_time: null, lasting_force: null, force_limit: null,
  }));
}
