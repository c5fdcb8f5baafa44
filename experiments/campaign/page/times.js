"use strict";
// How soon contacts are detected: a box for each estimator and place in the grid, a panel for each body.

const boxRow = { height: 28, least: 232, letter: 7.5, gap: 10, width: 246, right: 166 };

function showTimes() {
  const touched = campaign.groups.filter((group) => group.contacts > 0);
  byId("times").hidden = touched.length === 0;
  const bodies = [...new Set(touched.map((group) => group.body))];
  const label = Math.max(boxRow.least, ...touched.map((group) => boxRow.letter * nameOf(group).length));
  byId("time-panels").replaceChildren(...bodies.map((body) =>
    timePanel(body, touched.filter((group) => group.body === body), longestTime(touched), label)));
}

/** The end of all axes: the longest of all lines, and no more than after which a contact is missed. */
function longestTime(groups) {
  const ends = groups.map(({ quantiles }) => quantiles.findLast((time) => time !== null) ?? 0);
  const isOpen = groups.some(({ quantiles }) => quantiles.includes(null));
  return isOpen ? campaign.missed_after : Math.min(campaign.missed_after, 1.1 * Math.max(...ends));
}

/** `label`: how wide the names before the boxes are. */
function timePanel(body, groups, longest, label) {
  const { height, gap, width, right } = boxRow;
  const left = label + gap;
  const svg = picture(left + width + right, groups.length * height + 34, `Detection times, ${body}`);
  const x = (time) => left + (width * time) / longest;
  for (const tick of roundNumbers(1000 * longest)) {
    shape(svg, "line", { class: "grid", x1: x(tick / 1000), x2: x(tick / 1000), y1: 0, y2: groups.length * height });
    write(svg, x(tick / 1000), groups.length * height + 15, chosen(tick), { class: "tick" });
  }
  write(svg, left + width, groups.length * height + 30, "ms after the onset", { class: "tick end" });
  groups.forEach((group, i) => timeBox(svg, group, x, left, i * height + height / 2));
  return panel(capitalised(body), svg);
}

function timeBox(svg, group, x, left, y) {
  const { gap, width } = boxRow;
  write(svg, left - gap, y + 4, nameOf(group), { class: "row-name" });
  const [tenth, quarter, half, threeQuarters, nineTenths] = group.quantiles;
  const end = left + width;
  const place = (time) => (time === null ? end : Math.min(x(time), end));
  const style = `--colour: ${colourOf(group.estimator)}`;
  if (tenth !== null) {
    shape(svg, "line", { class: "whisker", style, x1: place(tenth), x2: place(nineTenths), y1: y, y2: y });
  }
  if (quarter !== null) {
    const [from, to] = [place(quarter), place(threeQuarters)];
    const open = threeQuarters === null ? " open" : "";
    shape(svg, "rect", { class: `box${open}`, style, x: from, y: y - 8, width: Math.max(1, to - from), height: 16 });
  }
  if (half !== null) shape(svg, "line", { class: "median", style, x1: place(half), x2: place(half), y1: y - 8, y2: y + 8 });
  const missed = group.missed === 0 ? `of ${group.contacts}` : `${group.missed} of ${group.contacts} missed`;
  write(svg, end + 10, y + 4, `${inMs(half)} ms, ${missed}`, { class: group.missed === 0 ? "row-note" : "row-note bad" });
}
