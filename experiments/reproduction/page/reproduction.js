"use strict";
// Figures of papers: a table for each source, with the ratio of ours to theirs drawn beside the numbers.

const reproduction = JSON.parse(byId("data").textContent);
const axis = { width: 240, height: 24, most: Math.log(4) };

function valueText(value) {
  return value === null ? "–" : number(value, 4);
}

/** Where a value stands beside the paper's, 0 to the width; null where there is no ratio. */
function place(value, paper) {
  if (value === null || !(value / paper > 0)) return null;
  const ratio = Math.max(-axis.most, Math.min(axis.most, Math.log(value / paper)));
  return (axis.width * (ratio + axis.most)) / (2 * axis.most);
}

function bar(svg, value, paper, y, name) {
  const end = place(value, paper);
  if (end === null) return;
  const middle = axis.width / 2;
  shape(svg, "rect", { class: name, x: Math.min(middle, end), y, width: Math.max(2, Math.abs(end - middle)), height: 7 });
}

function ratioOf(entry) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const spoken = `as printed ${valueText(entry.as_printed)}, ours ${valueText(entry.ours)}, paper ${valueText(entry.paper)} ${entry.unit}`;
  set(svg, { viewBox: `0 0 ${axis.width} ${axis.height}`, preserveAspectRatio: "none", role: "img", "aria-label": spoken });
  const band = (axis.width * Math.log(entry.within)) / (2 * axis.most);
  const middle = axis.width / 2;
  shape(svg, "rect", { class: "band", x: middle - band, y: 0, width: 2 * band, height: axis.height });
  bar(svg, entry.as_printed, entry.paper, 4, "printed");
  bar(svg, entry.ours, entry.paper, 13, "ours");
  shape(svg, "line", { class: "paper-line", x1: middle, x2: middle, y1: 0, y2: axis.height });
  return svg;
}

function titleOf(entry) {
  const cell = element("td", {}, entry.title);
  if (entry.verdict === "not reached" && entry.reason) cell.append(element("span", { class: "why" }, entry.reason));
  if (entry.set_up) cell.append(element("span", { class: "setup" }, entry.set_up));
  if (entry.set_up_ours) cell.append(element("span", { class: "setup" }, `ours: ${entry.set_up_ours}`));
  return cell;
}

function rowOf(entry) {
  const colour = entry.verdict === "not reached" ? "bad" : "good";
  return element("tr", { id: entry.id }, titleOf(entry),
    element("td", { class: "value", "data-name": "paper" }, chosen(entry.paper)),
    element("td", { class: "value", "data-name": "as printed" }, valueText(entry.as_printed)),
    element("td", { class: "value", "data-name": "ours" }, valueText(entry.ours)),
    element("td", { "data-name": "unit" }, entry.unit),
    element("td", { class: "ratio" }, ratioOf(entry)),
    element("td", { class: `verdict ${colour}` }, entry.verdict));
}

function tableOf(entries) {
  const head = element("tr", {}, ...["figure", "paper", "as printed", "ours", "unit", "ratio to the paper", "verdict"].map(
    (name) => element("th", { scope: "col" }, name)));
  const table = element("table", {}, element("thead", {}, head), element("tbody", {}, ...entries.map(rowOf)));
  return element("div", { class: "scroll" }, table);
}

function sectionOf(source) {
  const pictures = reproduction.pictures.filter((each) => each.source === source);
  const entries = reproduction.entries.filter((each) => each.source === source);
  const section = element("section", { "aria-label": source }, element("h2", {}, source));
  if (pictures.length > 0) section.append(element("div", { class: "pictures" }, ...pictures.map(pictureOf)));
  if (entries.length > 0) section.append(tableOf(entries));
  return section;
}

/** Of "[SafePR] Fig. 9" the paper, and the number by which its figures follow one another. */
function order(source) {
  const [paper] = source.split(" ");
  return [paper, /Fig/.test(source) ? 0 : /Table/.test(source) ? 1 : 2, Number(/\d+/.exec(source.slice(paper.length))?.[0] ?? 0)];
}

function inOrder(one, two) {
  const [a, b] = [order(one), order(two)];
  const which = a.findIndex((each, i) => each !== b[i]);
  if (which < 0) return one.localeCompare(two);
  return which === 0 ? papers.indexOf(a[0]) - papers.indexOf(b[0]) : a[which] - b[which];
}

const all = [...reproduction.entries, ...reproduction.pictures];
const papers = [...new Set(all.map((each) => order(each.source)[0]))];
const sources = [...new Set(all.map((each) => each.source))].sort(inOrder);
byId("summary").textContent = `${reproduction.summary}.`;
byId("sources").replaceChildren(...sources.map(sectionOf));
byId("provenance").replaceChildren(
  element("dt", {}, "command"), element("dd", {}, reproduction.call), element("dt", {}, "version"), element("dd", {}, reproduction.version));
