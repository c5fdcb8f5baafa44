"use strict";
// The run told in plain language, event by event.

/** Events as {time, text, kind}, in order of time. */
function storyEvents() {
  const events = report.contacts.flatMap(contactEvents);
  for (const lane of report.lanes.filter((each) => each.name === "mode")) events.push(...laneEvents(lane));
  for (const lane of report.lanes.filter((each) => each.name === "reaction")) events.push(...reactions(lane));
  for (const lane of report.lanes.filter((each) => each.name === "operator")) events.push(...operatorEvents(lane));
  for (const lane of report.lanes.filter((each) => each.name === "limits")) events.push(...limitsBeyondTheDrives(lane));
  for (const lane of report.lanes.filter((each) => each.name === "torque gate")) events.push(...closings(lane));
  events.sort((a, b) => a.time - b.time);
  return events;
}

function contactEvents(contact) {
  const events = [{ time: contact.start, kind: "contact", text: touched(contact) }];
  if (contact.detected !== null) events.push({ time: contact.detected, kind: "detected", text: detection(contact) });
  if (contact.peak_time !== null) {
    events.push({ time: contact.peak_time, kind: "peak", text: pressed(contact) });
  }
  if (contact.removed !== null) events.push({ time: contact.removed, kind: "removed", text: removal(contact) });
  return events;
}

function detection(contact) {
  const taken = contact.isolated_body ? ` and takes it for a contact of ${withArticle(contact.isolated_body)}` : "";
  const late = contact.could_stop === false ? " It could not stop within its limits any more." : "";
  const several = contact.several_contacts ? " No single contact explains the wrench." : "";
  return `The robot detects it${taken}.${several}${late}`;
}

function removal(contact) {
  const reaction = contact.detected === null ? "" : `, ${milliseconds(contact.removed - contact.detected)} after it was detected`;
  return `The contact is removed${reaction}.`;
}

function laneEvents(lane) {
  return laneSpans(lane).slice(1).filter((span) => span.state >= 0).map((span) =>
    ({ time: span.from, kind: "state", text: `${capitalised(lane.name)}: ${lane.states[span.state]}.` }));
}

/** What the robot does about a contact, as the states of the lane say it. */
function reactions(lane) {
  return laneSpans(lane).filter((span) => span.state > 0).map((span) =>
    ({ time: span.from, kind: "state", text: `The robot ${lane.states[span.state]}.` }));
}

/** What the operator does: a button, or a target. */
function operatorEvents(lane) {
  return laneSpans(lane).filter((span) => span.state > 0).map((span) => {
    const done = lane.states[span.state];
    return { time: span.from, kind: "state", text: done === "target" ? "The operator gives a target." : `The operator presses ${done}.` };
  });
}

/** Limits ask for more than the drives have, or nobody knew how to keep them. */
function limitsBeyondTheDrives(lane) {
  return laneSpans(lane).filter((span) => /more than the drives have|could not be kept/.test(lane.states[span.state])).map((span) =>
    ({ time: span.from, kind: "state", text: `Limits: ${lane.states[span.state]}.` }));
}

/** The torque gate closes: why is known of the first time. */
function closings(lane) {
  const closed = lane.states.indexOf("closed");
  return laneSpans(lane).filter((span) => span.state === closed).map((span, i) =>
    ({ time: span.from, kind: "state", text: i === 0 && report.fault ? `The torque gate closes: ${report.fault}.` : "The torque gate closes." }));
}

/** Time since the contact that the event belongs to, as a reader says it. */
function sinceContact(time) {
  const contact = contactAt(time);
  if (!contact) return "";
  const gap = Math.round(1000 * (time - contact.start));
  if (gap === 0) return "contact";
  return gap > 0 ? `contact + ${gap} ms` : `contact − ${-gap} ms`;
}

function showStory() {
  const events = storyEvents();
  byId("story").hidden = events.length === 0;
  const buttons = events.map((event) => {
    const button = element("button", { type: "button", class: event.kind },
      element("span", { class: "when" }, `${fixed(event.time, 3)} s`),
      element("span", { class: "since" }, sinceContact(event.time)),
      element("span", { class: "what" }, event.text));
    button.addEventListener("click", () => clock.seekTime(event.time));
    return button;
  });
  byId("events").replaceChildren(...buttons.map((button) => element("li", {}, button)));
  clock.follow((sample) => markCurrent(events, buttons, sample));
}

/** Marks the event that the clock stands at or has passed last. */
function markCurrent(events, buttons, sample) {
  const passed = events.filter((event) => sampleAt(event.time) <= sample).length;
  buttons.forEach((button, i) => {
    button.classList.toggle("passed", i < passed);
    if (i === passed - 1) button.setAttribute("aria-current", "step");
    else button.removeAttribute("aria-current");
  });
}
