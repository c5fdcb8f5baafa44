"use strict";
// The verdict: headline, figures, contacts, measures.

function showHeadline() {
  document.title = `${report.title} · flinch`;
  byId("title").textContent = report.title;
  byId("kind").textContent = report.kind && ` · ${report.kind}`;
  byId("subtitle").textContent = report.subtitle;
  byId("note").textContent = report.note;
  byId("note").hidden = !report.note;
  byId("summary").textContent = summary();
  const mark = byId("verdict-mark");
  const passed = report.remarks.length === 0 ? "✓ Passed" : "✓ Passed, with remarks";
  mark.textContent = report.good ? passed : "✗ Not passed";
  mark.classList.add(report.good ? "good" : "bad");
  for (const list of ["reasons", "remarks"]) {
    byId(list).hidden = report[list].length === 0;
    byId(list).replaceChildren(...report[list].map((text) => element("li", {}, `${capitalised(text)}.`)));
  }
}

/** What of sensors and drives could not be checked. */
function showChecksOff() {
  const off = report.checks_off;
  const place = byId("checks-off");
  place.hidden = off.length === 0;
  place.querySelector("summary").textContent = off.length === 1 ? "One check was off" : `${off.length} checks were off`;
  place.querySelector("ul").replaceChildren(...off.map((text) => element("li", {}, `${capitalised(text)}.`)));
}

/** The run in plain sentences. */
function summary() {
  const stop = report.fault ? ` The robot was stopped: ${report.fault}.` : "";
  const contact = worstContact();
  if (!contact) return (withoutContact() + stop).trim();
  const others = report.contacts.length - 1;
  const more = others === 0 ? "" : ` The table tells of ${others} more contact${others > 1 ? "s" : ""}.`;
  return [touched(contact), detected(contact), pressed(contact)].join(" ") + more + stop;
}

function withoutContact() {
  if (!report.contacts_known) return "No instrument saw what touched the robot.";
  return report.fault ? "" : "Nothing was touched.";
}

function touched(contact) {
  if (contact.object === "push") return `The ${contact.body} was pushed.`;
  const how = contact.body === "platform" ? " at" : ", the platform moving at";
  const speed = contact.speed === null ? "" : `${how} ${fixed(contact.speed, 2)} m/s`;
  const object = contact.object || "obstacle";
  if (contact.clamping_leg) return `${capitalised(contact.clamping_leg)} clamped the ${object} between its links${speed}.`;
  return `The ${contact.body} ran into the ${object}${speed}.`;
}

/** A body within a sentence. */
function withArticle(body) {
  return body.startsWith("both ") ? body : `the ${body}`;
}

function detected(contact) {
  if (contact.detected === null) return "The robot did not detect it.";
  const after = milliseconds(contact.detected - contact.start);
  if (contact.removed === null) return `The robot detected it ${after} later, but was still in contact at the end.`;
  return `The robot detected it ${after} later and was clear of it after ${milliseconds(contact.removed - contact.start)}.`;
}

function pressed(contact) {
  const peak = `The force peaked at ${fixed(contact.peak_force, 0)} N`;
  if (contact.force_limit === null) return `${peak}.`;
  const limit = `${fixed(contact.force_limit, 0)} N`;
  if (contact.within_limit) return `${peak}, within the limit of ${limit}.`;
  const stayed = contact.lasting_force === null ? "" : ` and stayed at ${fixed(contact.lasting_force, 0)} N`;
  return `${peak}${stayed}: more than the limit of ${limit}.`;
}

/** Four large numbers of the worst contact. */
function showFigures() {
  const contact = worstContact();
  byId("figures").hidden = !contact;
  if (!contact) return;
  const since = (time) => (time === null ? none : fixed(1000 * (time - contact.start), 0));
  const figures = [
    [contact.speed === null ? none : fixed(contact.speed, 2), "m/s", "platform, at contact"],
    [since(contact.detected), "ms", contact.detected === null ? "never detected" : "until detected"],
    [since(contact.removed), "ms", contact.removed === null ? "never removed" : "until removed"],
    [fixed(judgedForce(contact), 0), "N", contact.force_limit === null ? "at most" : `of ${fixed(contact.force_limit, 0)} N allowed`],
  ];
  byId("figures").replaceChildren(...figures.map(([value, unit, caption]) =>
    element("p", { class: "figure" },
      element("span", { class: "figure-value" }, value, element("span", { class: "figure-unit" }, value === none ? "" : ` ${unit}`)),
      element("span", { class: "figure-caption" }, caption))));
}

function judgement(good) {
  if (good === null) return element("td", {}, "");
  return element("td", { class: good ? "good" : "bad" }, good ? "✓ yes" : "✗ no");
}

function tableHead(titles) {
  return element("thead", {}, element("tr", {}, ...titles.map(([title, style]) =>
    element("th", { scope: "col", class: style ?? "" }, title))));
}

function showContacts() {
  byId("contacts").hidden = report.contacts.length === 0;
  byId("contacts").replaceChildren(element("table", { "aria-label": "Contacts" },
    tableHead([["Body"], ["At", "n"], ["Speed", "n"], ["Detected after", "n"], ["Removed after", "n"],
      ["Force and limit"], ["Within limit"]]),
    element("tbody", {}, ...report.contacts.map(contactRow))));
}

function contactRow(contact) {
  const since = (time) => milliseconds(time === null ? null : time - contact.start);
  const go = element("button", { type: "button", class: "link", title: "Go to this contact" }, fixed(contact.start, 3) + " s");
  go.addEventListener("click", () => clock.seekTime(contact.start));
  return element("tr", {},
    element("th", { scope: "row" }, capitalised(contact.body), touchedBy(contact), isolation(contact), several(contact)),
    element("td", { class: "n" }, go),
    element("td", { class: "n" }, contact.speed === null ? none : `${fixed(contact.speed, 2)} m/s`),
    element("td", { class: contact.detected === null ? "n bad" : "n" },
      contact.detected === null ? "not detected" : since(contact.detected), ...timesByEstimator(contact), braking(contact)),
    element("td", { class: contact.removed === null ? "n bad" : "n" },
      contact.removed === null ? "not removed" : since(contact.removed)),
    element("td", {}, forceBar(contact)),
    judgement(contact.force_limit === null ? null : contact.within_limit));
}

/** By which obstacle, where several touched the robot. */
function touchedBy(contact) {
  const objects = new Set(report.contacts.map((each) => each.object));
  return objects.size < 2 || !contact.object ? "" : element("small", {}, `by ${contact.object}`);
}

/** When each estimator's detector detected the contact, where several ran. */
function timesByEstimator(contact) {
  return contact.detected_by.map(([name, time]) => element("small", { class: time === null ? "by bad" : "by" },
    `${name.replaceAll("_", " ")} ${time === null ? "never" : `${fixed(1000 * (time - contact.start), 1)} ms`}`));
}

/** Whether the limits that the robot keeps could still be kept when it detected the contact. */
function braking(contact) {
  if (contact.could_stop === null) return "";
  return element("small", { class: contact.could_stop ? "by" : "by bad" },
    contact.could_stop ? "could stop within its limits" : "could not stop within its limits");
}

/** How long the force was above the limit of its time. */
function aboveLimit(contact) {
  return contact.over_limit > 0 ? element("small", { class: "bad" }, `above it for ${milliseconds(contact.over_limit)}`) : "";
}

/** What the robot took the body for, where it said so. */
function isolation(contact) {
  if (!contact.isolated_body) return "";
  const right = contact.isolated_body === contact.body;
  return element("small", { class: right ? "" : "bad" }, right ? "isolated correctly" : `taken for ${withArticle(contact.isolated_body)}`);
}

/** Whether the robot said that more than one thing touched it. */
function several(contact) {
  return contact.several_contacts ? element("small", { class: "bad" }, "no single contact explains the wrench") : "";
}

/** The force that decides as a bar against the limit, which is a tick at a fixed place. */
function forceBar(contact) {
  if (contact.force_limit === null) return `${fixed(contact.peak_force, 0)} N`;
  const share = Math.min(1, judgedForce(contact) / contact.force_limit / 1.25);
  const bar = element("span", { class: contact.within_limit ? "bar" : "bar over", "aria-hidden": "true" });
  bar.style.setProperty("--share", `${100 * share}%`);
  const text = `${fixed(judgedForce(contact), 0)} N of ${fixed(contact.force_limit, 0)} N`;
  return element("span", { class: "force" }, text, bar, element("small", {}, contact.limit_name), aboveLimit(contact));
}

function showMeasures() {
  byId("measures").hidden = report.measures.length === 0;
  const rows = report.measures.map((measure) => element("tr", {},
    element("th", { scope: "row" }, measure.name),
    element("td", { class: "n" }, quantity(measure.value, measure.unit)),
    element("td", { class: "n soft" }, measure.bound === null ? "" : quantity(measure.bound, measure.unit, chosen)),
    judgement(measure.good),
    element("td", { class: "soft" }, measure.note)));
  byId("measure-table").replaceChildren(
    tableHead([["Measure"], ["Value", "n"], ["At most", "n"], ["Good"], ["Note"]]), element("tbody", {}, ...rows));
}

function showVerdict() {
  showHeadline();
  showChecksOff();
  showFigures();
  showContacts();
  showMeasures();
}
