"use strict";
// All groups with their bounds, and the runs that were slow or missed something.

function head(titles) {
  return element("thead", {}, element("tr", {}, ...titles.map(([title, style]) =>
    element("th", { scope: "col", class: style ?? "" }, title))));
}

function cell(text, style = "n") {
  return element("td", { class: style }, text);
}

function share(value) {
  return value === null ? none : `${number(100 * value, 2)} %`;
}

/** A time with what bounds it with 95 %. */
function timeCell(time, [from, to]) {
  if (time === null) return cell(none);
  const bounds = `${from === null ? "0" : inMs(from)} to ${to === null ? "∞" : inMs(to)}`;
  return element("td", { class: "n" }, inMs(time), " ", element("span", { class: "soft within" }, bounds));
}

/** Hours in the unit that reads best. */
function duration(hours) {
  if (hours >= 1) return `${number(hours, 3)} h`;
  return hours >= 1 / 60 ? `${number(60 * hours, 3)} min` : `${number(3600 * hours, 3)} s`;
}

function showGroups() {
  const hasGrid = campaign.points.length > 1;
  const rows = campaign.groups.map((group) => element("tr", {},
    ...(hasGrid ? [element("th", { scope: "row" }, listOf(campaign.points[group.point]))] : []),
    hasGrid ? cell(estimatorOf(group), "") : element("th", { scope: "row" }, estimatorOf(group)),
    cell(group.body, ""),
    cell(String(group.n)),
    timeCell(group.quantiles[2], group.median_within),
    timeCell(group.quantiles[4], group.p90_within),
    cell(group.contacts > 0 ? String(group.missed) : none, group.missed > 0 ? "n bad" : "n"),
    cell(share(group.missed_at_most), "n soft"),
    cell(String(group.false_alarms), group.false_alarms > 0 ? "n bad" : "n"),
    cell(duration(group.contact_free_h)),
    cell(number(group.rate, 2)),
    cell(number(group.rate_at_most, 2), "n soft"),
    cell(group.contacts > 0 ? inMs(group.over_limit, 0) : none, group.over_limit > 0 ? "n bad" : "n"),
    cell(String(group.faults), group.faults > 0 ? "n bad" : "n")));
  byId("group-table").replaceChildren(
    head([...(hasGrid ? [["Grid point"]] : []), ["Detected by"], ["Touched"], ["Runs", "n"], ["Median, ms", "n"],
      ["Nine tenths, ms", "n"], ["Missed", "n"], ["Missed at most", "n"], ["False alarms", "n"], ["in", "n"],
      ["per hour", "n"], ["False alarms at most, 1/h", "n"], ["Above a force limit at most, ms", "n"], ["Faults", "n"]]),
    element("tbody", {}, ...rows));
}

function showRuns() {
  byId("look").hidden = campaign.look.length === 0;
  byId("call").textContent = campaign.call && `${campaign.call} --run N`;
  const rows = campaign.look.map((run) => element("tr", {},
    element("th", { scope: "row", class: "number" }, `--run ${run.run}`),
    cell(run.why, ""),
    cell(listOf(campaign.points[run.point]), "soft"),
    cell(run.body, ""),
    cell(inMs(run.time)),
    cell(run.speed === null ? none : `${fixed(run.speed, 2)} m/s`),
    cell(listOf(run.drawn), "soft drawn")));
  byId("run-table").replaceChildren(
    head([["Run"], ["Why"], ["Place in the grid"], ["Touched"], ["Detected, ms", "n"], ["Speed", "n"], ["Drawn"]]),
    element("tbody", {}, ...rows));
}
