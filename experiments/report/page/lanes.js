"use strict";
// Named states over time as coloured bands: contact, detector, mode.

const lanes = {
  bands: [],

  start() {
    const box = byId("lanes");
    box.hidden = report.lanes.length === 0;
    report.lanes.forEach((lane, i) => box.append(this.build(lane, i)));
    this.cursor = element("div", { class: "cursor", "aria-hidden": "true" });
    box.append(element("div", { class: "lane-cursor" }, this.cursor));
    this.setWindow(charts.window);
  },

  build(lane, index) {
    const track = element("div", { class: "lane-track", role: "img", "aria-label": describeLane(lane) });
    for (const span of laneSpans(lane)) {
      if (span.state < 0) continue;
      const name = lane.states[span.state];
      const title = `${lane.name}: ${name}, ${fixed(span.from, 3)} s to ${fixed(span.to, 3)} s`;
      const band = element("span", { class: `lane-band shade-${shadeOf(lane, index, span.state)}`, title }, element("span", {}, name));
      track.append(band);
      this.bands.push({ band, span });
    }
    return element("div", { class: "lane" }, element("span", { class: "lane-name" }, lane.name), track);
  },

  setWindow([from, to]) {
    this.window = [from, to];
    const share = (time) => (100 * (Math.min(to, Math.max(from, time)) - from)) / (to - from);
    for (const { band, span } of this.bands) {
      band.style.left = `${share(span.from)}%`;
      band.style.width = `${share(span.to) - share(span.from)}%`;
      band.hidden = share(span.to) === share(span.from);
    }
    for (const { band } of this.bands) band.classList.toggle("short", band.firstChild.scrollWidth > band.clientWidth);
  },

  placeCursor(time) {
    if (!this.cursor) return;
    const [from, to] = this.window;
    this.cursor.style.left = `${(100 * (time - from)) / (to - from)}%`;
  },
};

/** Quiet states are grey, the first two lanes have a colour each, states of longer lanes one of six. */
function shadeOf(lane, index, state) {
  if (state === 0) return 0;
  if (lane.states.length === 2 && index < 2) return index + 1;
  return 3 + ((state - 1 + 3 * (index % 2)) % 6);
}

function describeLane(lane) {
  const spans = laneSpans(lane).filter((span) => span.state >= 0);
  return `${lane.name}: ` + spans.map((span) => `${lane.states[span.state]} from ${fixed(span.from, 3)} s`).join(", ");
}
