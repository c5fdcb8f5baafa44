"use strict";
// What the pictures share: the data, colours of estimators, axes.

const campaign = JSON.parse(byId("data").textContent);

const colourNames = ["--estimate", "--leg-2", "--leg-3", "--leg-4", "--leg-5", "--leg-1", "--leg-6", "--true"];

function colourOf(estimator) {
  return `var(${colourNames[campaign.estimators.indexOf(estimator) % colourNames.length]})`;
}

/** "control.contact_detector.reaction_force_N" without the sections it is in. */
function shortKey(key) {
  return key.split(".").at(-1);
}

/** A value as people say it: a number with four digits, no underscores. */
function shortValue(value) {
  const number = Number(value);
  return value === "" || Number.isNaN(number) ? value.replaceAll(/[[\]]/g, "").replaceAll("_", " ") : String(Number(number.toPrecision(4))).replace("-", "−");
}

/** A name says itself of what it is one. */
function listOf(pairs) {
  const isName = (value) => value.startsWith("[") && /[a-z]/.test(value);
  return pairs.map(([key, value]) => (isName(value) ? shortValue(value) : `${shortKey(key)} ${shortValue(value)}`)).join(", ");
}

function estimatorOf(group) {
  return group.estimator.replaceAll("_", " ");
}

/** Estimator and place in the grid, as far as they differ within this campaign. */
function nameOf(group) {
  const parts = [];
  if (campaign.estimators.length > 1 || campaign.points.length === 1) parts.push(estimatorOf(group));
  if (campaign.points.length > 1) parts.push(listOf(campaign.points[group.point]));
  return parts.join(" · ");
}

/** A picture whose lengths are pixels of a wide window. */
function picture(width, height, label) {
  const svg = document.createElementNS("http://www.w3.org/2000/svg", "svg");
  set(svg, { viewBox: `0 0 ${width} ${height}`, role: "img", "aria-label": label });
  return svg;
}

function panel(title, svg) {
  return element("figure", { class: "panel" }, element("figcaption", {}, title), svg);
}

function write(svg, x, y, text, attributes = {}) {
  shape(svg, "text", { x, y, ...attributes }).textContent = text;
}

/** Round numbers from 0 to `highest`, at most seven. */
function roundNumbers(highest) {
  const rough = highest / 6;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((factor) => factor * power).find((each) => each >= rough);
  return Array.from({ length: Math.floor(highest / step + 1e-9) + 1 }, (_, i) => i * step);
}

/** Powers of ten from `lowest` to `highest`. */
function powers(lowest, highest) {
  const first = Math.floor(Math.log10(lowest));
  const last = Math.ceil(Math.log10(highest));
  return Array.from({ length: last - first + 1 }, (_, i) => 10 ** (first + i));
}

function inMs(seconds, decimals = 1) {
  return seconds === null ? none : fixed(1000 * seconds, decimals);
}
