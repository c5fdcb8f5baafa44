"use strict";
// What recordings side by side have in common, and what not.

function nameOfRun({ name, good, verdict }) {
  return element("th", { scope: "col" }, verdict.length === 0 ? name : `${name} ${good ? "✓" : "✗"}`);
}

/** Rows of one name and a value of each recording; what is not the same in all is set in bold. */
function sideBySide(rows) {
  const head = element("thead", {}, element("tr", {}, element("th", { scope: "col" }), ...report.runs.map(nameOfRun)));
  return [head, element("tbody", {}, ...rows.map(([name, values]) => {
    const isSame = values.every((value) => value === values[0]);
    const cell = (value) => (isSame ? value ?? none : element("b", {}, value ?? none));
    return element("tr", {}, element("th", { scope: "row" }, name), ...values.map((value) => element("td", {}, cell(value))));
  }))];
}

function verdictRows() {
  const names = [...new Set(report.runs.flatMap(({ verdict }) => verdict.map(([name]) => name)))];
  return names.map((name) => [name, report.runs.map(({ verdict }) => verdict.find(([each]) => each === name)?.[1] ?? null)]);
}

function alignment() {
  const moved = report.runs.filter(({ delay }) => delay !== 0).map(({ name, delay }) => `${name} ${fixed(delay, 4)} s later`);
  const by = { time: "time", contact: "the first contact", correlation: "the motion of the drives" }[report.aligned_by];
  return moved.length === 0 ? `Aligned by ${by}.` : `Aligned by ${by}: ${moved.join(", ")} than drawn.`;
}

function showComparison() {
  const names = report.runs.map(({ name }) => name).join(", ");
  document.title = `${names} · flinch`;
  byId("title").textContent = names;
  byId("difference").textContent = report.first_difference;
  byId("noted").hidden = report.notes.length === 0;
  byId("notes").replaceChildren(...report.notes.map((note) => element("li", {}, note)));
  if (report.runs.length === 1) {
    byId("overline").textContent = "flinch · a log";
    byId("judged").hidden = byId("set").hidden = true;
  }
  byId("verdicts").replaceChildren(...sideBySide(verdictRows()));
  byId("no-settings").hidden = report.settings.length > 0;
  if (report.settings.length > 0) {
    byId("settings").replaceChildren(...sideBySide(report.settings.map(({ key, unit, values }) => [unit ? `${key} [${unit}]` : key, values])));
  }
  byId("alignment").textContent = report.runs.length === 1 ? "" : alignment();
  listProvenance([["Version", report.version], ["Call", report.call]]);
}
