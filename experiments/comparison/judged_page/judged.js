"use strict";
// What estimators and detectors made of a log.

function delayCell(delay) {
  return element("span", delay === null ? { class: "bad" } : {}, delay === null ? "missed" : `${fixed(1e3 * delay, 1)} ms`);
}

function detectorRow({ by, detections, false_alarms: alarms, at_most: atMost, delays }) {
  const isJudged = report.free_seconds > 0;
  const separated = delays.flatMap((delay, i) => (i === 0 ? [delayCell(delay)] : [", ", delayCell(delay)]));
  return element("tr", {}, element("th", { scope: "row" }, by),
    element("td", {}, `${detections}`),
    element("td", {}, isJudged ? `${alarms}` : none),
    element("td", {}, isJudged ? `${fixed(atMost, 0)}` : none),
    element("td", {}, ...(separated.length > 0 ? separated : [none])));
}

function showDetectors() {
  const head = ["by", "detections", "false alarms", "at most per hour (95 %)", "contacts detected after"];
  byId("detectors").replaceChildren(
    element("thead", {}, element("tr", {}, ...head.map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, ...report.detectors.map(detectorRow)));
}

function truthSentence() {
  const free = report.free_seconds > 0 ? `Free of contact, ${report.truth}: ${fixed(report.free_seconds, 2)} s.`
    : "No stretch is known to be free (--free A..B), so no false alarms are counted.";
  const contacts = report.contacts.length > 0 ? `Contacts, ${report.truth}: ${report.contacts.length}.`
    : "No contact is known (--contact T, --truth force), so none can be missed.";
  return `${free} ${contacts}`;
}

function showJudgement() {
  document.title = `${report.name} · flinch`;
  byId("title").textContent = report.name;
  byId("told").textContent = report.told;
  showDetectors();
  byId("truth").textContent = truthSentence();
  const events = report.events.length > 0 ? report.events : ["Nothing: no fault would have closed the torque gate."];
  byId("events").replaceChildren(...events.map((event) => element("li", {}, event)));
  listProvenance([["Version", report.version], ["Call", report.call]]);
}
