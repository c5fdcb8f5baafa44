"use strict";
// Parameters, texts and how the run was made.

function showParameters() {
  const parameters = report.parameters;
  byId("parameters-box").hidden = parameters.length === 0;
  byId("parameter-count").textContent = `(${parameters.length})`;
  const rows = parameters.map((each) => element("tr", {},
    element("td", { class: "soft" }, each.group),
    element("th", { scope: "row" }, each.name),
    element("td", { class: "n" }, each.value),
    element("td", {}, each.unit),
    element("td", { class: "soft" }, each.note)));
  byId("parameters").replaceChildren(
    tableHead([["Group"], ["Parameter"], ["Value", "n"], ["Unit"], ["Note"]]), element("tbody", {}, ...rows));
  byId("search").addEventListener("input", (event) => {
    const words = event.target.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of rows) row.hidden = !words.every((word) => row.textContent.toLowerCase().includes(word));
    const shown = rows.filter((row) => !row.hidden).length;
    byId("parameter-count").textContent = words.length ? `(${shown} of ${parameters.length})` : `(${parameters.length})`;
  });
}

function showTexts() {
  byId("texts").replaceChildren(...report.texts.map(({ title, text }) =>
    element("details", {}, element("summary", {}, title), element("pre", {}, text))));
}

function showProvenance() {
  byId("provenance").replaceChildren(...report.provenance.map(({ name, value, unit, note }) =>
    element("div", {}, element("dt", {}, capitalised(name)),
      element("dd", {}, unit ? `${value} ${unit}` : value, note ? element("span", { class: "soft" }, ` ${note}`) : ""))));
}

function showAppendix() {
  showParameters();
  showTexts();
  showProvenance();
}
