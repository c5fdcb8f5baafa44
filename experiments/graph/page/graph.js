"use strict";
// The diagram as a tree, as pictures of its levels, and block by block.

const data = JSON.parse(byId("data").textContent);
const blocks = new Map();  // by path
const entries = new Map();  // of the tree, by path
let level = null;
let selected = null;

function register(block, parent) {
  block.parent = parent;
  blocks.set(block.path, block);
  for (const child of block.children ?? []) register(child, block);
}

/** The block that a port belongs to. */
function ownerOf(port) {
  return blocks.get(port.includes("/") ? port.slice(0, port.lastIndexOf("/")) : "");
}

function button(text, act) {
  const made = element("button", { type: "button" }, text);
  made.addEventListener("click", act);
  return made;
}

function treeEntry(block) {
  const name = button(block.name, (event) => { event.preventDefault(); show(block); });
  const type = element("span", { class: "type" }, block.children ? `${block.children.length} inside` : block.type);
  const entry = block.children
    ? element("details", {}, element("summary", {}, name, type), ...block.children.map(treeEntry))
    : element("div", { class: "block" }, name, type);
  entries.set(block.path, { entry, name, words: wordsOf(block) });
  return entry;
}

function wordsOf(block) {
  const ports = [...block.inputs, ...block.outputs].flatMap((port) => [port.name, port.type]);
  return [block.name, block.type, ...ports].join("\n").toLowerCase();
}

/** Shows what has `text` in its name, type or ports, and what that lies in. */
function search(text) {
  const wanted = text.trim().toLowerCase();
  const found = new Set();
  for (const [path, { words }] of entries) {
    if (wanted && !words.includes(wanted)) continue;
    found.add(path);
  }
  const shown = new Set();
  for (const path of found) for (let block = blocks.get(path); block; block = block.parent) shown.add(block.path);
  for (const [path, { entry }] of entries) {
    entry.hidden = !shown.has(path);
    if (wanted && entry.tagName === "DETAILS") entry.open = shown.has(path);
  }
  byId("found").textContent = wanted ? `${found.size} of ${entries.size} have “${text.trim()}”` : "";
  for (const node of byId("picture").querySelectorAll(".node")) {
    node.classList.toggle("found", Boolean(wanted) && found.has(pathOf(node)));
  }
}

function foldAll(open) {
  for (const [path, { entry }] of entries) if (path && entry.tagName === "DETAILS") entry.open = open;
}

/** Goes to a block: its level in the picture, itself in the tree and in the table. */
function show(block) {
  selected = block;
  openLevel(block.children ? block : block.parent);
  for (let above = block.parent; above; above = above.parent) entries.get(above.path).entry.open = true;
  for (const [path, { name }] of entries) name.setAttribute("aria-current", String(path === block.path));
  mark();
  zoom(Boolean(block.children));
  showPorts();
  history.replaceState(null, "", `#${block.path}`);
}

function openLevel(diagram) {
  if (level !== diagram) {
    level = diagram;
    byId("picture").innerHTML = data.pictures[diagram.path];
    const svg = byId("picture").querySelector("svg");
    svg.setAttribute("role", "img");
    svg.setAttribute("aria-label", `What is inside of ${diagram.name}`);
    for (const title of svg.querySelectorAll("title")) title.remove();
    for (const node of svg.querySelectorAll(".node")) node.addEventListener("click", (event) => clicked(event, node));
    search(byId("search").value);
  }
  const crumbs = [];
  for (let above = diagram; above; above = above.parent) crumbs.unshift(above);
  byId("crumbs").replaceChildren(...crumbs.flatMap((above, i) => {
    const crumb = button(above.name, () => show(above));
    crumb.setAttribute("aria-current", String(above === diagram));
    return i === 0 ? [crumb] : [" / ", crumb];
  }));
}

/** The path of the block that a box of the picture stands for. */
function pathOf(node) {
  return node.id.startsWith("block:") ? node.id.slice("block:".length) : null;
}

/** The whole level at once, or in full size around the selected block. */
function zoom(isWhole) {
  byId("picture").classList.toggle("whole", isWhole);
  byId("zoom").textContent = isWhole ? "Full size" : "Whole picture";
  const frame = byId("picture").getBoundingClientRect();
  const node = byId("picture").querySelector(".node.chosen")?.getBoundingClientRect();
  if (isWhole || !node) return;
  byId("picture").scrollBy(node.x + (node.width - frame.width) / 2 - frame.x, node.y + (node.height - frame.height) / 2 - frame.y);
}

function clicked(event, node) {
  const block = blocks.get(pathOf(node));
  if (!block) return;  // a port of the level itself
  if (block.children && selected !== block && event.target.closest("text")?.getAttribute("font-weight") === "bold") show(block);
  else select(block);
}

/** Chooses a block of the level that is shown, without going inside. */
function select(block) {
  selected = block;
  mark();
  showPorts();
}

function mark() {
  const ports = new Set([...selected.inputs, ...selected.outputs].map((port) => port.path));
  for (const node of byId("picture").querySelectorAll(".node")) node.classList.toggle("chosen", pathOf(node) === selected.path);
  for (const wire of byId("picture").querySelectorAll(".edge")) {
    wire.classList.toggle("near", selected !== level && wire.id.split(">").some((port) => ports.has(port)));
  }
}

function portLinks(ports) {
  if (!ports || ports.length === 0) return none;
  return element("ul", {}, ...ports.map((port) => element("li", {}, button(port, () => show(ownerOf(port))))));
}

function fieldText({ name, unit, frame }) {
  const notes = [unit && unit !== "1" ? unit.replace(/[<>]/g, "") : "", frame].filter(Boolean).join(", ");
  return notes ? `${name || "value"} [${notes}]` : name || "value";
}

function portRow(port, links) {
  const fields = data.fields[port.type];
  return element("tr", {}, element("th", { scope: "row" }, port.name),
    element("td", {}, port.type), element("td", {}, fields.length ? fields.map(fieldText).join(", ") : none),
    element("td", {}, portLinks(links)));
}

function portTable(title, ports, last, links) {
  if (ports.length === 0) return [];
  const head = element("tr", {}, ...[title, "signal", "fields", last].map((name) => element("th", { scope: "col" }, name)));
  return [element("table", {}, element("thead", {}, head), element("tbody", {}, ...ports.map((port) => portRow(port, links(port)))))];
}

function showPorts() {
  const heading = element("h2", {}, selected.name, element("span", { class: "type" }, selected.type));
  byId("ports").replaceChildren(heading,
    ...portTable("input", selected.inputs, "from", (port) => (port.from ? [port.from] : [])),
    ...portTable("output", selected.outputs, "to", (port) => port.to));
}

function start() {
  document.title = `${data.name} · flinch`;
  byId("title").textContent = data.name;
  register(data.root, null);
  byId("tree").append(treeEntry(data.root));
  const count = [...blocks.values()].filter((block) => !block.children).length;
  byId("told").textContent = `${count} blocks in ${blocks.size - count} diagrams, a tick every ${chosen(data.tick_us / 1000)} ms`;
  byId("search").addEventListener("input", () => search(byId("search").value));
  byId("zoom").addEventListener("click", () => zoom(!byId("picture").classList.contains("whole")));
  byId("unfold").addEventListener("click", () => foldAll(true));
  byId("fold").addEventListener("click", () => foldAll(false));
  listProvenance([["Version", data.version], ["Call", data.call]]);
  show(blocks.get(decodeURIComponent(location.hash.slice(1))) ?? data.root);
  entries.get("").entry.open = true;
}

start();
