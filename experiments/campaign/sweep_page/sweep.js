"use strict";
// A sweep: a curve of every figure over the values of the first key, one for each combination of the others.

const sweep = JSON.parse(byId("data").textContent);
const box = { left: 58, top: 8, width: 300, height: 130, right: 12, bottom: 34 };
const colourNames = ["--estimate", "--leg-2", "--leg-3", "--leg-4", "--leg-5", "--leg-1", "--leg-6", "--plain"];

const firstValues = [...new Set(sweep.rows.map((row) => row.values[0]))];
const areNumbers = firstValues.every((value) => typeof value === "number");
const isLogarithmic = areNumbers && firstValues.length > 2 && firstValues.every((value) => value > 0) &&
  Math.max(...firstValues) / Math.min(...firstValues) >= 50;

/** Rows of one curve: those with the same values of all keys but the first. */
const families = sweep.rows.reduce((all, row, i) => {
  const name = row.values.slice(1).map(valueText).join(", ");
  return all.set(name, [...(all.get(name) ?? []), i]);
}, new Map());

function valueText(value) {
  return typeof value === "number" ? chosen(value) : value;
}

function colourOfFamily(index) {
  return `var(${colourNames[index % colourNames.length]})`;
}

function withUnit({ name, unit }) {
  return unit ? `${name} [${unit}]` : name;
}

/** Where a value stands along the axis, 0 to 1: words and lists stand side by side. */
function share(value) {
  if (!areNumbers) return firstValues.length > 1 ? firstValues.indexOf(value) / (firstValues.length - 1) : 0.5;
  const of = isLogarithmic ? Math.log : (x) => x;
  const [low, high] = [of(Math.min(...firstValues)), of(Math.max(...firstValues))];
  return high > low ? (of(value) - low) / (high - low) : 0.5;
}

function ticksAlong() {
  const all = areNumbers ? [...firstValues].sort((a, b) => a - b) : firstValues;
  const stride = Math.ceil(all.length / 5);
  return all.filter((_, i) => i % stride === 0);
}

function panelOf(curve) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const [width, height] = [box.left + box.width + box.right, box.top + box.height + box.bottom];
  set(svg, { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": withUnit(curve) });
  const known = curve.values.filter((value) => value !== null);
  const [low, high] = [Math.min(...known), Math.max(...known)];
  const margin = high > low ? 0.06 * (high - low) : Math.max(1e-9, 0.1 * Math.abs(high));
  const x = (value) => box.left + box.width * share(value);
  const y = (value) => box.top + (box.height * (high + margin - value)) / (high - low + 2 * margin);
  for (const value of [low, (low + high) / 2, high]) {
    shape(svg, "line", { class: "grid", x1: box.left, x2: box.left + box.width, y1: y(value), y2: y(value) });
    shape(svg, "text", { class: "end", x: box.left - 6, y: y(value) + 4 }).textContent = number(value, 4);
  }
  for (const value of ticksAlong()) {
    shape(svg, "text", { class: "middle", x: x(value), y: box.top + box.height + 16 }).textContent = valueText(value);
  }
  shape(svg, "text", { class: "end", x: box.left + box.width, y: box.top + box.height + 31 }).textContent = sweep.keys[0];
  [...families.values()].forEach((rows, family) => drawFamily(svg, curve, rows, family, x, y));
  return element("figure", { class: "panel" }, element("figcaption", {}, withUnit(curve)), svg);
}

function drawFamily(svg, curve, rows, family, x, y) {
  const style = `--colour: ${colourOfFamily(family)}`;
  const inOrder = areNumbers ? [...rows].sort((a, b) => sweep.rows[a].values[0] - sweep.rows[b].values[0]) : rows;
  let path = "";
  let isOpen = false;
  for (const row of inOrder) {
    const value = curve.values[row];
    if (value !== null) path += `${isOpen ? "L" : "M"}${x(sweep.rows[row].values[0]).toFixed(1)} ${y(value).toFixed(1)}`;
    isOpen = value !== null;
  }
  shape(svg, "path", { class: "curve", style, d: path || "M0 0" });
  for (const row of inOrder) {
    if (curve.values[row] === null) continue;
    const point = shape(svg, "circle", { class: `point${sweep.rows[row].good ? "" : " bad"}`, style, "data-row": row,
      cx: x(sweep.rows[row].values[0]), cy: y(curve.values[row]), r: rows.length > 60 ? 1.8 : 3 });
    shape(point, "title").textContent = `${sweep.rows[row].values.map(valueText).join(", ")}: ${number(curve.values[row], 5)}`;
    point.addEventListener("click", () => choose(row));
  }
}

function choose(row) {
  const { values, good, fault, call } = sweep.rows[row];
  byId("call").textContent = call;
  const figures = [...sweep.keys.map((key, i) => [key, valueText(values[i])]), ["verdict", good ? "good" : "bad"],
    ...(fault ? [["fault", fault]] : []), ...sweep.curves.map((curve) => [withUnit(curve), number(curve.values[row], 6)])];
  byId("run-table").replaceChildren(...figures.map(([name, value]) =>
    element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, String(value)))));
  for (const point of document.querySelectorAll(".point")) {
    point.classList.toggle("chosen", Number(point.dataset.row) === row);
  }
}

function showRows() {
  const head = [...sweep.keys, "verdict", ...sweep.curves.map(withUnit)];
  const rows = sweep.rows.map((row, i) => {
    const cells = [...row.values.map(valueText), row.good ? "good" : "bad", ...sweep.curves.map((curve) => number(curve.values[i], 4))];
    const line = element("tr", {}, ...cells.map((cell) => element("td", {}, String(cell))));
    line.addEventListener("click", () => choose(i));
    return line;
  });
  byId("rows").replaceChildren(
    element("thead", {}, element("tr", {}, ...head.map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, ...rows));
}

function showSweep() {
  document.title = `${sweep.title} · flinch`;
  byId("title").textContent = sweep.title;
  byId("description").textContent = sweep.description;
  const bad = sweep.rows.filter((row) => !row.good).length;
  byId("mark").textContent = bad === 0 ? `✓ ${sweep.rows.length} runs, all good` : `✗ ${bad} of ${sweep.rows.length} runs bad`;
  byId("mark").classList.add(bad === 0 ? "good" : "bad");
  byId("summary").textContent = `${sweep.rows.length} runs over ${sweep.keys.join(" and ")}.`;
  byId("legend").hidden = families.size < 2;
  byId("legend").replaceChildren(...[...families.keys()].map((name, i) => element("span", {},
    element("span", { class: "dot", style: `background: ${colourOfFamily(i)}` }), `${sweep.keys.slice(1).join(", ")} ${name}`)));
  byId("curves").replaceChildren(...sweep.curves.map(panelOf));
  byId("same").textContent = sweep.same.length === 0 ? "" : `The same at all values: ${
    sweep.same.map((figure) => `${figure.name} ${number(figure.value, 4)}${figure.unit ? ` ${figure.unit}` : ""}`).join(", ")}.`;
  byId("text").textContent = sweep.text;
  listProvenance(Object.entries(sweep.provenance));
  showRows();
  choose(0);
}

showSweep();
