"use strict";
// A picture of a paper, drawn of what flinch does: lines over time, dots of runs, limits.

const frame = { left: 58, top: 10, width: 420, height: 210, right: 14, bottom: 40 };
const pictureColours = ["--estimate", "--leg-2", "--leg-3", "--leg-4", "--true", "--leg-6"];

/** Round numbers from low to high, four to eight of them. */
function roundTicks(low, high) {
  const rough = (high - low) / 5;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = power * [1, 2, 5, 10].find((each) => each * power >= rough);
  const ticks = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1) ticks.push(k * step);
  return ticks;
}

/** The range of all values, and a little more. */
function rangeOf(values) {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (!(low <= high)) return [0, 1];
  const margin = high > low ? 0.04 * (high - low) : Math.max(1e-9, 0.1 * Math.abs(high));
  return [low - margin, high + margin];
}

function axesOf(picture) {
  const series = [...picture.lines, ...picture.dots];
  const marks = (upright) => picture.marks.filter((mark) => mark.upright === upright).map((mark) => mark.at);
  const [x0, x1] = rangeOf([...series.flatMap((each) => each.x), ...marks(true)]);
  const [y0, y1] = rangeOf([...series.flatMap((each) => each.y), ...marks(false)]);
  return {
    range: [x0, x1, y0, y1],
    x: (value) => frame.left + (frame.width * (value - x0)) / (x1 - x0),
    y: (value) => frame.top + (frame.height * (y1 - value)) / (y1 - y0),
  };
}

function label(svg, x, y, text, attributes) {
  shape(svg, "text", { x, y, ...attributes }).textContent = text;
}

function drawAxes(svg, picture, { range: [x0, x1, y0, y1], x, y }) {
  const [right, bottom] = [frame.left + frame.width, frame.top + frame.height];
  for (const value of roundTicks(y0, y1)) {
    shape(svg, "line", { class: "grid", x1: frame.left, x2: right, y1: y(value), y2: y(value) });
    label(svg, frame.left - 6, y(value) + 4, chosen(value), { class: "end" });
  }
  for (const value of roundTicks(x0, x1)) {
    shape(svg, "line", { class: "grid", x1: x(value), x2: x(value), y1: frame.top, y2: bottom });
    label(svg, x(value), bottom + 16, chosen(value), { class: "middle" });
  }
  label(svg, right, bottom + 34, picture.x_title, { class: "end" });
  for (const mark of picture.marks) {
    const ends = mark.upright ? { x1: x(mark.at), x2: x(mark.at), y1: frame.top, y2: bottom }
      : { x1: frame.left, x2: right, y1: y(mark.at), y2: y(mark.at) };
    shape(svg, "line", { class: "limit", ...ends });
    if (mark.name) label(svg, mark.upright ? x(mark.at) + 4 : right - 4, mark.upright ? frame.top + 12 : y(mark.at) - 4, mark.name,
      { class: mark.upright ? "start" : "end" });
  }
}

function drawLine(svg, line, colour, { x, y }) {
  const path = line.x.map((value, i) => `${i === 0 ? "M" : "L"}${x(value).toFixed(1)} ${y(line.y[i]).toFixed(1)}`).join("");
  if (path) shape(svg, "path", { class: "curve", style: `--colour: ${colour}`, d: path });
}

function drawDots(svg, dots, colour, { range: [x0, x1], x, y }) {
  const style = `--colour: ${colour}`;
  dots.x.forEach((value, i) => shape(svg, "circle", { class: "dot", style, cx: x(value), cy: y(dots.y[i]), r: 3.2 }));
  if (!dots.line) return;
  const at = (value) => y(dots.line.intercept + dots.line.slope * value);
  const [low, high] = [Math.max(x0, Math.min(...dots.x)), Math.min(x1, Math.max(...dots.x))];
  shape(svg, "line", { class: "fitted", style, x1: x(low), x2: x(high), y1: at(low), y2: at(high) });
}

function keyOf(series) {
  const entry = (each, i) => element("span", { title: each.set_up },
    element("span", { class: "key", style: `background: var(${pictureColours[i % pictureColours.length]})` }), each.name);
  return element("p", { class: "keys" }, ...series.map(entry));
}

/** A matrix of shares: rows are what was right, columns what was told. */
function matrixOf({ matrix: { classes, rows, set_up: setUp } }) {
  const short = (name) => name.replaceAll("_", " ");
  const percent = (share) => (share > 0.9995 || share === 0 ? fixed(100 * share, 0) : fixed(100 * share, 1));
  const cell = (share) => element("td", { style: `--share: ${share}` }, percent(share));
  const head = element("tr", {}, element("th", {}, "touched \\ told, %"), ...classes.map((name) => element("th", { scope: "col" }, short(name))));
  return element("div", { class: "scroll" }, element("table", { class: "matrix", title: setUp }, element("thead", {}, head),
    element("tbody", {}, ...rows.map((row, i) => element("tr", {}, element("th", { scope: "row" }, short(classes[i])), ...row.map(cell))))));
}

function pictureOf(picture) {
  if (picture.matrix) {
    return element("figure", { class: "drawn", id: picture.id },
      element("figcaption", {}, element("strong", {}, picture.title)), matrixOf(picture), element("p", { class: "why" }, picture.note));
  }
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  const size = [frame.left + frame.width + frame.right, frame.top + frame.height + frame.bottom];
  set(svg, { viewBox: `0 0 ${size[0]} ${size[1]}`, role: "img", "aria-label": `${picture.title}: ${picture.y_title} over ${picture.x_title}` });
  const series = [...picture.lines, ...picture.dots];
  const axes = axesOf(picture);
  drawAxes(svg, picture, axes);
  series.forEach((each, i) => {
    const colour = `var(${pictureColours[i % pictureColours.length]})`;
    (each.line === undefined ? drawLine : drawDots)(svg, each, colour, axes);
  });
  const caption = element("figcaption", {}, element("strong", {}, picture.title), element("span", { class: "unit" }, picture.y_title));
  const figure = element("figure", { class: "drawn", id: picture.id }, caption, svg);
  if (series.some((each) => each.name)) figure.append(keyOf(series));
  if (picture.note) figure.append(element("p", { class: "why" }, picture.note));
  return figure;
}
