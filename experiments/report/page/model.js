"use strict";
// The report's data and what follows from it.

const report = JSON.parse(byId("data").textContent);
// A page that shows a run while it goes on moves these on, and has `times`, one a sample.
let lastSample = Math.max(0, report.count - 1);
let wholeRun = [report.start, report.start + lastSample * report.period];

function timeOf(sample) {
  return report.times ? report.times[Math.min(lastSample, Math.round(sample))] : report.start + sample * report.period;
}

/** Sample nearest to a time, within the run. */
function sampleAt(time) {
  if (report.times) return nearestSample(time);
  return Math.min(lastSample, Math.max(0, Math.round((time - report.start) / report.period)));
}

function nearestSample(time) {
  let [low, high] = [0, lastSample];
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (report.times[middle] <= time) low = middle;
    else high = middle;
  }
  return time - report.times[low] <= report.times[high] - time ? low : high;
}

function has(...names) {
  return names.every((name) => name in report.columns);
}

/** Value of a column at a sample; null where there is none. */
function valueOf(name, sample) {
  return report.columns[name]?.[sample] ?? null;
}

/** Length of the vector whose components are the columns `name`_x, _y and, where there is one, _z; null without them. */
function magnitudeOf(name) {
  const parts = ["x", "y", "z"].map((axis) => `${name}_${axis}`).filter((column) => has(column));
  if (parts.length < 2) return null;
  return report.columns[parts[0]].map((_, sample) => {
    const vector = parts.map((column) => valueOf(column, sample));
    return vector.includes(null) ? null : Math.hypot(...vector);
  });
}

/** Number of columns that are called `prefix` 1 `suffix`, 2, ... */
function columnCount(prefix, suffix = "") {
  let count = 0;
  while (has(`${prefix}${count + 1}${suffix}`)) count += 1;
  return count;
}

/** State of a lane at a sample. */
function stateOf(lane, sample) {
  let state = -1;
  for (const [from, value] of lane.changes) {
    if (from > sample) break;
    state = value;
  }
  return state;
}

/** A lane as [{from, to, state}], times in seconds. */
function laneSpans(lane) {
  return lane.changes.map(([sample, state], i) => ({
    state,
    from: timeOf(sample),
    to: i + 1 < lane.changes.length ? timeOf(lane.changes[i + 1][0]) : wholeRun[1],
  }));
}

/** The contact that a time belongs to: the last that has begun, else the first; null without contacts. */
function contactAt(time) {
  const begun = report.contacts.filter((contact) => contact.start <= time + 1e-9);
  return begun.at(-1) ?? report.contacts[0] ?? null;
}

/** When a contact is over for the reader: removed, or the end of the run. */
function contactEnd(contact) {
  return contact.removed ?? wholeRun[1];
}

/** The peak, or what lasted where only that is above its limit. */
function judgedForce(contact) {
  return contact.lasting_force ?? contact.peak_force;
}

/** The contact that is closest to, or furthest above, its limit. */
function worstContact() {
  const severity = (contact) => judgedForce(contact) / (contact.force_limit ?? Infinity);
  return report.contacts.reduce((worst, next) => (!worst || severity(next) > severity(worst) ? next : worst), null);
}
