"use strict";
// Numbers as text, and elements as objects.

const none = "–";

/** A number with so many significant digits, a true minus sign and no exponent where it can be helped. */
function number(value, digits = 3) {
  if (value === null || value === undefined) return none;
  const size = Math.abs(value);
  if (size !== 0 && (size < 1e-4 || size >= 1e6)) {
    const [mantissa, exponent] = value.toExponential(digits - 2).split("e");
    return `${mantissa} × 10${superscript(Number(exponent))}`.replace("-", "−");
  }
  const decimals = size === 0 ? 0 : Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
  return fixed(value, Math.min(decimals, 6));
}

/** A number with so many decimals and a true minus sign; never minus zero. */
function fixed(value, decimals) {
  if (value === null || value === undefined) return none;
  const text = value.toFixed(decimals);
  return Number(text) === 0 ? text.replace("-", "") : text.replace("-", "−");
}

function superscript(integer) {
  return String(integer).replace(/./g, (c) => "⁰¹²³⁴⁵⁶⁷⁸⁹"[c] ?? "⁻");
}

/** A number that someone chose: all its digits and no more. */
function chosen(value) {
  const size = Math.abs(value);
  return size !== 0 && size < 1e-4 ? number(value, 2) : String(Number(value.toPrecision(6))).replace("-", "−");
}

/** An SI value in the unit that reads best: lengths below 0.1 m in mm, angles in degrees; a count as it is. */
function quantity(value, unit, format = number) {
  if (value === null || value === undefined) return none;
  if (unit === "m" && Math.abs(value) < 0.1 && Math.abs(value) >= 1e-6) return `${format(1000 * value)} mm`;
  if (unit === "rad") return `${format((value * 180) / Math.PI)}°`;
  return unit ? `${format(value)} ${unit}` : chosen(value);
}

/** A duration in whole milliseconds. */
function milliseconds(seconds) {
  return seconds === null ? none : `${fixed(1000 * seconds, 0)} ms`;
}

/** An HTML element: element("td", {class: "good"}, "text", child). */
function element(name, attributes = {}, ...children) {
  const node = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
  node.append(...children);
  return node;
}

/** An SVG element inside `parent`. */
function shape(parent, name, attributes = {}) {
  const node = document.createElementNS("http://www.w3.org/2000/svg", name);
  set(node, attributes);
  parent.append(node);
  return node;
}

function set(node, attributes) {
  for (const [key, value] of Object.entries(attributes)) node.setAttribute(key, value);
}

function byId(id) {
  return document.getElementById(id);
}

/** How the page was made: pairs of a name and a value, in its list "provenance". */
function listProvenance(pairs) {
  byId("provenance").replaceChildren(...pairs.map(([name, value]) =>
    element("div", {}, element("dt", {}, name), element("dd", {}, value))));
}

function capitalised(text) {
  return text.charAt(0).toUpperCase() + text.slice(1);
}
