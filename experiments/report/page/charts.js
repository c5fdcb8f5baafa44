"use strict";
// The charts, drawn by dygraphs: one time window and one cursor for all.

const axisWidth = 52; // pixels of every value axis, so that charts and lanes align
const drawnSamples = 4000; // more than that in a window are drawn as lowest and highest of each stretch

const charts = {
  all: [],
  window: wholeRun,
  settling: false,

  start() {
    byId("signals").hidden = lastSample === 0;
    if (lastSample === 0) return;
    this.all = chartList().map((chart) => this.build(chart));
    for (const name of ["whole", "contact", "detection"]) {
      byId(`window-${name}`).addEventListener("click", () => this.zoomTo(name));
      byId(`window-${name}`).hidden = name !== "whole" && report.contacts.length === 0;
    }
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.recolour());
    clock.follow((sample) => this.show(sample));
  },

  build(chart) {
    const plot = element("div", { class: "plot" });
    const cursor = element("div", { class: "cursor", "aria-hidden": "true" });
    const figure = element("figure", { class: "chart", id: `chart-${chart.id}`, "aria-label": chart.title },
      element("figcaption", {}, element("b", {}, chart.title), symbolOf(chart), element("span", { class: "soft" }, chart.unit),
        element("span", { class: "legend" }, ...chart.series.map((series, i) => legendEntry(chart, series, i)))),
      element("div", { class: "plot-frame" }, plot, cursor));
    byId("charts").append(figure);
    chart.readings = [...figure.querySelectorAll(".reading")];
    chart.cursor = cursor;
    chart.plot = plot;
    chart.graph = new Dygraph(plot, rowsOf(chart, this.window), { ...this.options(chart), ...windowOf(chart, this.window) });
    return chart;
  },

  options(chart) {
    return {
      labels: ["time", ...chart.series.map((series) => series.label)],
      ...colours(chart),
      series: Object.fromEntries(chart.series.map((series) => [series.label, { strokeWidth: series.wide ? 5 : 1.4 }])),
      legend: "never",
      highlightCircleSize: 0,
      axisLabelFontSize: 11,
      xRangePad: 0,
      axes: {
        x: { axisLabelFormatter: (time) => `${Number(time.toFixed(4))} s`, pixelsPerLabel: 70, axisLabelWidth: 64 },
        y: { axisLabelFormatter: (value) => String(Number(value.toPrecision(6))).replace("-", "−"), pixelsPerLabel: 24, axisLabelWidth: axisWidth - 6 },
      },
      underlayCallback: (canvas, area, graph) => drawUnderlay(canvas, area, graph, chart),
      drawCallback: (graph, first) => { if (!first && !this.settling) this.setWindow(graph.xAxisRange()); },
      clickCallback: (event, time) => clock.seekTime(time),
      highlightCallback: (event, time) => this.read(sampleAt(time)),
      unhighlightCallback: () => this.read(clock.sample),
    };
  },

  /** Gives all charts the same stretch of time; `name` is that of the button that asked for it. */
  setWindow([from, to], name = "") {
    for (const button of byId("windows").children) button.setAttribute("aria-pressed", String(button.id === `window-${name}`));
    const least = 4 * report.period;
    const middle = (from + to) / 2;
    if (to - from < least) [from, to] = [middle - least / 2, middle + least / 2];
    this.window = [Math.max(wholeRun[0], from), Math.min(wholeRun[1], to)];
    this.settling = true;
    for (const chart of this.all) {
      chart.graph.updateOptions({ file: rowsOf(chart, this.window), ...windowOf(chart, this.window) });
    }
    this.settling = false;
    lanes.setWindow(this.window);
    this.placeCursors();
  },

  /** "whole", or the surroundings of the contact that the clock is at: "contact", "detection". */
  zoomTo(name) {
    const contact = contactAt(timeOf(clock.sample));
    if (name === "whole" || !contact) {
      this.setWindow(wholeRun, "whole");
    } else if (name === "contact") {
      this.setWindow([contact.start - 0.06, (contact.removed ?? contact.start + 0.5) + 0.12], name);
    } else {
      this.setWindow([contact.start - 0.01, (contact.detected ?? contact.start + 0.05) + 0.015], name);
    }
  },

  show(sample) {
    this.turnPage(timeOf(sample));
    this.placeCursors();
    this.read(sample);
  },

  /** Moves the window on when the time has left it. */
  turnPage(time) {
    const [from, to] = this.window;
    if (time >= from - 1e-9 && time <= to + 1e-9) return;
    const span = to - from;
    const start = Math.min(Math.max(wholeRun[0], time - 0.1 * span), wholeRun[1] - span);
    this.setWindow([start, start + span]);
  },

  placeCursors() {
    const time = timeOf(clock.sample);
    for (const { graph, cursor } of this.all) cursor.style.transform = `translateX(${graph.toDomXCoord(time)}px)`;
    lanes.placeCursor(time);
  },

  /** Writes the values at a sample into the legends. */
  read(sample) {
    for (const { series, readings, decimals } of this.all) {
      series.forEach(({ values }, i) => { readings[i].textContent = fixed(values[sample], decimals); });
    }
  },

  recolour() {
    this.settling = true;
    for (const chart of this.all) chart.graph.updateOptions(colours(chart));
    this.settling = false;
  },

};

function symbolOf({ symbol }) {
  return symbol ? element("i", {}, symbol[0], element("sub", {}, symbol[1])) : "";
}

/** Swatch, name and reading; pressing it hides or shows the series. A series that is alone is only read. */
function legendEntry(chart, series, index) {
  if (chart.series.length === 1) return element("span", { class: "reading" }, none);
  const swatch = element("span", { class: series.wide ? "swatch wide" : "swatch" });
  swatch.style.background = `var(${series.colour})`;
  const entry = element("button", { type: "button", "aria-pressed": "true", title: "Hide or show" },
    swatch, series.label, element("span", { class: "reading" }, none));
  entry.addEventListener("click", () => {
    const visible = entry.getAttribute("aria-pressed") !== "true";
    entry.setAttribute("aria-pressed", String(visible));
    charts.settling = true;
    chart.graph.setVisibility(index, visible);
    charts.settling = false;
  });
  return entry;
}

/** A colour of page.css as it is now, light or dark. */
function colour(variable) {
  return getComputedStyle(document.documentElement).getPropertyValue(variable).trim();
}

function colours(chart) {
  return {
    colors: chart.series.map((series) => colour(series.wide ? `${series.colour}-pale` : series.colour)),
    gridLineColor: colour("--grid"),
    axisLineColor: colour("--line"),
  };
}

/** [time, value, ...] for dygraphs: every sample in the window if they are few, else their envelope. */
function rowsOf(chart, [from, to]) {
  const first = Math.max(0, sampleAt(from) - 1);
  const last = Math.min(lastSample, sampleAt(to) + 1);
  const stride = Math.ceil((last - first + 1) / (drawnSamples / 2));
  if (stride <= 2) return range(first, last, 1).map((k) => [timeOf(k), ...chart.series.map(({ values }) => values[k])]);
  return range(first, last, stride).flatMap((k) => {
    const end = Math.min(last + 1, k + stride);
    const spans = chart.series.map(({ values }) => lowestAndHighest(values, k, end));
    return [[timeOf(k), ...spans.map(([low]) => low)], [timeOf(k + stride / 2), ...spans.map(([, high]) => high)]];
  });
}

function range(first, last, stride) {
  return Array.from({ length: Math.floor((last - first) / stride) + 1 }, (_, i) => first + i * stride);
}

/** Of the samples from ... to - 1 that have a value; null where none has. */
function lowestAndHighest(values, from, to) {
  let [low, high] = [null, null];
  for (let sample = from; sample < to; sample += 1) {
    const value = values[sample];
    if (value === null) continue;
    if (low === null || value < low) low = value;
    if (high === null || value > high) high = value;
  }
  return [low, high];
}

/** Options that show a stretch of time: its values with a margin, and no less than the chart's least span. */
function windowOf(chart, [from, to]) {
  const seen = chart.series.map(({ values }) => lowestAndHighest(values, sampleAt(from), sampleAt(to) + 1));
  let low = Math.min(...seen.map(([value]) => value ?? Infinity));
  let high = Math.max(...seen.map(([, value]) => value ?? -Infinity));
  if (low > high) [low, high] = [0, 0];
  if (chart.reach) high = Math.max(high, ...chart.bounds.map((bound) => bound.value));
  if (chart.fromZero) low = Math.min(0, low);
  const missing = Math.max(0, chart.least - (high - low));
  const margin = 0.07 * (high - low + missing);
  const below = chart.fromZero && low === 0 ? 0 : missing / 2 + margin;
  return { dateWindow: [from, to], valueRange: [low - below, high + (chart.fromZero ? missing : missing / 2) + margin] };
}

/** Contacts as bands, detections as lines, and the chart's bounds. */
function drawUnderlay(canvas, area, graph, chart) {
  canvas.save();
  canvas.beginPath();
  canvas.rect(area.x, area.y, area.w, area.h);
  canvas.clip();
  for (const contact of report.contacts) {
    const [from, to] = [contact.start, contactEnd(contact)].map((time) => graph.toDomXCoord(time));
    canvas.fillStyle = colour("--contact-band");
    canvas.fillRect(from, area.y, Math.max(1, to - from), area.h);
    if (contact.detected === null) continue;
    canvas.fillStyle = colour("--detect");
    canvas.fillRect(graph.toDomXCoord(contact.detected) - 0.75, area.y, 1.5, area.h);
  }
  drawBounds(canvas, area, graph, chart.bounds);
  canvas.restore();
}

/** Dashed lines with their names, where a name does not run into the one before. */
function drawBounds(canvas, area, graph, bounds) {
  const named = [];
  for (const { name, value } of bounds) {
    const y = graph.toDomYCoord(value);
    if (y < area.y || y > area.y + area.h) continue;
    const baseline = y > area.y + 16 ? y - 4 : y + 12;
    const free = named.every((other) => Math.abs(other - baseline) > 13);
    if (free) named.push(baseline);
    drawBound(canvas, area, y, free ? name : "", baseline);
  }
}

function drawBound(canvas, area, y, name, baseline) {
  canvas.strokeStyle = canvas.fillStyle = colour("--soft");
  canvas.setLineDash([5, 4]);
  canvas.lineWidth = 1;
  canvas.beginPath();
  canvas.moveTo(area.x, y);
  canvas.lineTo(area.x + area.w, y);
  canvas.stroke();
  canvas.setLineDash([]);
  canvas.font = "11px system-ui, sans-serif";
  canvas.textAlign = "right";
  canvas.strokeStyle = colour("--paper");
  canvas.lineWidth = 4;
  canvas.lineJoin = "round";
  canvas.strokeText(name, area.x + area.w - 6, baseline);
  canvas.fillText(name, area.x + area.w - 6, baseline);
}
