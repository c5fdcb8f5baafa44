"use strict";
// Limit speeds: for each body a map with a sector for each place and direction.

const study = JSON.parse(byId("data").textContent);
const bodies = [...new Set(study.cells.map((cell) => cell.body))];
const directions = [...new Set(study.cells.map((cell) => cell.direction))];
const speeds = study.cells.map((cell) => cell.speed).filter((speed) => speed !== null);
const [slowest, fastest] = speeds.length > 0 ? [Math.min(...speeds), Math.max(...speeds)] : [0, 0];
const radius = 0.47 * spacing();
let shownBody = bodies[0];

/** Distance of neighbouring places [m]; of a single one a fraction of the robot's size. */
function spacing() {
  const places = [...new Map(study.cells.map(({ x, y }) => [`${x} ${y}`, [x, y]])).values()];
  const distances = places.flatMap(([x, y], i) => places.slice(0, i).map(([u, v]) => Math.hypot(x - u, y - v)));
  return distances.length > 0 ? Math.min(...distances) : 0.1 * sizeOf(boxOf());
}

function boxOf() {
  const points = [...study.robot.legs.flat(), ...study.robot.platform, ...study.cells.map(({ x, y }) => [x, y])];
  const [xs, ys] = [0, 1].map((axis) => points.map((point) => point[axis]));
  return { left: Math.min(...xs), right: Math.max(...xs), low: Math.min(...ys), high: Math.max(...ys) };
}

function sizeOf({ left, right, low, high }) {
  return Math.max(right - left, high - low, 0.1);
}

function fractionOf(speed) {
  return fastest > slowest ? (speed - slowest) / (fastest - slowest) : 0.5;
}

function colourAt(fraction) {
  return `color-mix(in oklab, var(--estimate) ${(100 * fraction).toFixed(0)}%, var(--true))`;
}

function speedText({ speed, bound, reason }) {
  if (bound === null) return reason ? none : "not tested";
  if (speed === null) return bound === "force" ? `below ${number(study.slowest)} m/s` : none;
  return `${bound === "force" ? "" : "≥ "}${number(speed)} m/s`;
}

function boundText({ bound, speed, reason }) {
  if (bound === null) return reason;
  if (bound === "force") return "a force exceeds its limit above";
  if (bound === "motion") return speed === null ? "too few contacts come about at the slowest speed" : "too few contacts come about faster";
  return "nothing faster was tried";
}

/** A sector of a circle about (x, y) that points towards `degrees`; y points down in a picture. */
function sectorPath(x, y, degrees) {
  const half = Math.min(180 / directions.length, 45) * 0.92;
  const at = (angle) => [x + radius * Math.cos((angle * Math.PI) / 180), -(y + radius * Math.sin((angle * Math.PI) / 180))];
  const [from, to] = [at(degrees - half), at(degrees + half)];
  return `M${x} ${-y}L${from[0]} ${from[1]}A${radius} ${radius} 0 0 0 ${to[0]} ${to[1]}Z`;
}

function drawRobot(svg, size) {
  const { legs, link_radius: linkRadius, platform, platform_radius: platformRadius } = study.robot;
  for (const leg of legs) {
    shape(svg, "polyline", { class: "link", points: leg.map(([x, y]) => `${x},${-y}`).join(" "), "stroke-width": Math.max(2 * linkRadius, 0.01 * size) });
  }
  shape(svg, "polygon", { class: "platform", points: platform.map(([x, y]) => `${x},${-y}`).join(" "), "stroke-width": 2 * platformRadius });
  for (const [[x, y]] of legs) shape(svg, "circle", { class: "foot", cx: x, cy: -y, r: 0.012 * size, "stroke-width": 0.004 * size });
}

function drawMap() {
  const box = boxOf();
  const size = sizeOf(box);
  const margin = Math.max(0.06 * size, radius);
  const svg = byId("map");
  svg.replaceChildren();
  set(svg, { viewBox: `${box.left - margin} ${-box.high - margin} ${box.right - box.left + 2 * margin} ${box.high - box.low + 2 * margin}`,
    "aria-label": `Limit speeds of contacts with ${shownBody}` });
  drawRobot(svg, size);
  study.cells.forEach((cell, i) => {
    if (cell.body !== shownBody) return;
    const kind = cell.speed === null ? (cell.bound === "force" ? "" : " empty") : cell.bound === "force" ? "" : " open";
    const sector = shape(svg, "path", { class: `sector${kind}`, d: sectorPath(cell.x, cell.y, cell.direction), "data-cell": i,
      "stroke-width": 0.003 * size, style: `--colour: ${cell.speed === null ? "var(--bad)" : colourAt(fractionOf(cell.speed))}` });
    shape(sector, "title").textContent = `${chosen(cell.x)}, ${chosen(cell.y)} m towards ${chosen(cell.direction)}°: ${speedText(cell)}`;
    sector.addEventListener("click", () => choose(i));
  });
}

function showBody(body) {
  shownBody = body;
  for (const button of byId("bodies").children) button.setAttribute("aria-pressed", String(button.textContent === body));
  drawMap();
}

function choose(i) {
  const cell = study.cells[i];
  if (cell.body !== shownBody) showBody(cell.body);
  const figures = [["body", cell.body], ["place of the platform", `${chosen(cell.x)}, ${chosen(cell.y)} m`], ["moves towards", `${chosen(cell.direction)}°`],
    ["limit speed", speedText(cell)], ["because", boundText(cell)]];
  if (cell.speed !== null) {
    figures.push(["of its runs beyond a limit, without the contact", `${cell.exceeded}, ${cell.untested} of ${study.trials}`],
      [`confidence in fewer than ${number(100 * study.share)} %`, `${number(100 * cell.confidence, 4)} %`],
      ["nearest run: largest force, largest that lasts", `${quantity(cell.peak, "N")}, ${quantity(cell.lasting, "N")}`],
      ["nearest run: contact over after", milliseconds(cell.removed)]);
  }
  byId("cell-table").replaceChildren(...figures.map(([name, value]) =>
    element("tr", {}, element("th", { scope: "row" }, name), element("td", {}, value))));
  byId("call").textContent = cell.call || none;
  for (const sector of document.querySelectorAll(".sector")) sector.classList.toggle("chosen", Number(sector.dataset.cell) === i);
}

function showCells() {
  const head = ["body", "x [m]", "y [m]", "towards", "limit speed", "because", "confidence"];
  const rows = study.cells.map((cell, i) => {
    const cells = [cell.body, chosen(cell.x), chosen(cell.y), `${chosen(cell.direction)}°`, speedText(cell), boundText(cell),
      cell.confidence === null ? none : `${number(100 * cell.confidence, 4)} %`];
    const line = element("tr", {}, ...cells.map((text) => element("td", {}, text)));
    line.addEventListener("click", () => choose(i));
    return line;
  });
  byId("cells").replaceChildren(
    element("thead", {}, element("tr", {}, ...head.map((name) => element("th", { scope: "col" }, name)))),
    element("tbody", {}, ...rows));
}

function showLimits() {
  const { region, transient, transient_source: source, transient_duration: duration, quasi_static: lasting, quasi_static_source: lastingSource } = study.limits;
  byId("limits").textContent = `Limits of the ${region}: ${chosen(transient)} N (${source}), and ${chosen(lasting)} N after ${chosen(1000 * duration)} ms (${lastingSource}); ` +
    `of clampings ${chosen(lasting)} N at once. ${study.trials} contacts of each cell, of which at most ${study.tolerated} may exceed a limit and at most ${study.spares} may not come about.`;
}

function showScale() {
  byId("scale").hidden = speeds.length === 0;
  byId("scale").replaceChildren(`${number(slowest)} m/s`,
    element("span", { class: "ramp", style: `background: linear-gradient(to right in oklab, var(--true), var(--estimate))` }), `${number(fastest)} m/s`);
}

function showStudy() {
  document.title = `${study.title} · flinch`;
  byId("title").textContent = study.title;
  byId("description").textContent = study.description;
  byId("summary").textContent = study.sentence;
  showLimits();
  byId("bodies").replaceChildren(...bodies.map((body) => {
    const button = element("button", { type: "button" }, body);
    button.addEventListener("click", () => showBody(body));
    return button;
  }));
  showScale();
  showBody(bodies[0]);
  showCells();
  byId("text").textContent = study.text;
  listProvenance(Object.entries(study.provenance));
  choose(0);
}

showStudy();
