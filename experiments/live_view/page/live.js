"use strict";
// Follows a run while it goes on: its feed brings samples; buttons give orders to a simulation.

const chartPeriod = 120; // milliseconds between two drawings of the charts, at least
const framePeriod = 500; // milliseconds between two choices of what of the scene is shown

const live = {
  follows: true,
  seconds: 3, // that charts show while they follow
  moving: false, // it is this that moves clock and window, and not somebody who looks
  paused: false,
  ended: false,
  taken: null, // when the latest samples were taken from the run, by the clock of the computer [ms]
  lag: null, // from there until they were drawn [ms]
  changed: false,
  chartsAreOld: false,
  chartsDrawn: 0,
  framed: 0,

  start() {
    byId("title").textContent = report.title;
    byId("subtitle").textContent = report.subtitle;
    document.title = `${report.title}, live`;
    scene.start();
    this.bind();
    clock.follow((sample) => this.showTime(sample));
    this.feed = new EventSource("feed");
    this.feed.addEventListener("message", (event) => this.take(JSON.parse(event.data)));
    this.feed.addEventListener("open", () => this.say());
    this.feed.addEventListener("error", () => { if (!this.ended) this.say("connection lost"); });
    requestAnimationFrame((now) => this.draw(now));
  },

  bind() {
    byId("pause").addEventListener("click", () => this.order(this.paused ? "go" : "pause"));
    byId("tick").addEventListener("click", () => this.order("tick"));
    byId("speed").addEventListener("change", (event) => this.order(`speed ${event.target.value}`));
    byId("follow").addEventListener("click", () => this.setFollowing(true));
    for (const seconds of [1, 3, 10]) {
      byId(`window-${seconds}`).addEventListener("click", () => { this.seconds = seconds; this.setFollowing(true); });
    }
    for (const word of ["stop", "reset", "start", "go", "end"]) {
      byId(`operator-${word}`).addEventListener("click", () => this.order(word));
    }
    byId("operator-line").addEventListener("keydown", (event) => this.type(event));
    document.addEventListener("keydown", (event) => this.key(event));
  },

  key(event) {
    if (event.target.matches("button, select, input") || event.ctrlKey || event.altKey || event.metaKey || byId("orders").hidden) return;
    if (event.key === " ") byId("pause").click();
    else if (event.key === "ArrowRight") byId("tick").click();
    else return;
    event.preventDefault();
  },

  order(text) {
    fetch("order", { method: "POST", body: text })
      .then((answer) => this.refused(answer.ok ? "" : text))
      .catch(() => this.say("connection lost"));
  },

  refused(text) {
    byId("refused").hidden = text === "";
    byId("refused").textContent = `Not ordered: ${text}. The terminal says why.`;
  },

  /** Enter gives the order that stands in the line. */
  type(event) {
    if (event.key !== "Enter" || event.target.value.trim() === "") return;
    this.order(event.target.value.trim());
    event.target.value = "";
  },

  take(message) {
    if (message.anew) samples.clear();
    if (message.times) {
      samples.append(message);
      this.taken = message.taken;
      this.changed = true;
    }
    if (message.speed !== undefined) this.showPace(message);
    if (message.not_shown !== undefined) this.showLoss(message.not_shown);
    if (message.operated) byId("operator").hidden = false;
    if (message.ended) this.end();
    if (message.over) this.stay();
  },

  showLoss(samplesLost) {
    byId("lost").hidden = samplesLost === 0;
    byId("lost").textContent = `The view did not keep up: ${samplesLost} samples are not shown. The recording has them.`;
  },

  showPace({ speed, paused }) {
    this.paused = paused;
    byId("orders").hidden = byId("speed").hidden = false;
    byId("pause").textContent = paused ? "Go on" : "Pause";
    const listed = [...byId("speed").options].some((option) => Number(option.value) === speed);
    if (!listed) byId("speed").append(element("option", { value: String(speed) }, `${chosen(speed)} times real time`));
    byId("speed").value = String(speed);
    this.say();
  },

  say(text = this.paused ? "paused" : "running") {
    byId("live-state").textContent = text;
    byId("live-state").className = `mark ${text === "running" ? "good" : text === "paused" ? "" : "bad"}`;
  },

  /** The page becomes the report. */
  end() {
    this.ended = true;
    this.feed.close();
    this.say("finished");
    location.replace("report.html");
  },

  /** There is no report: the page stays as it is. */
  stay() {
    this.ended = true;
    this.feed.close();
    this.say("over");
  },

  setFollowing(follows) {
    this.follows = follows;
    byId("follow").hidden = follows;
    this.changed = true;
  },

  showTime(sample) {
    if (!this.moving && report.times.length > 0) this.setFollowing(false);
    const time = report.times[sample];
    byId("clock").replaceChildren(element("b", {}, time === undefined ? none : `${fixed(time, 3)} s`));
    charts.placeCursors();
    charts.read(sample);
  },

  /** The robot whenever samples have come, the charts less often. */
  draw(now) {
    this.moving = true;
    if (this.changed && report.times.length > 1) {
      this.changed = false;
      this.chartsAreOld = true;
      if (this.follows) clock.seek(lastSample);
      this.lag = Date.now() - this.taken;
    }
    if (this.chartsAreOld && now - this.chartsDrawn >= chartPeriod) {
      this.chartsAreOld = false;
      this.chartsDrawn = now;
      this.drawCharts();
    }
    if (now - this.framed >= framePeriod && scene.available()) {
      this.framed = now;
      scene.view(byId("view-close").getAttribute("aria-pressed") === "true");
    }
    this.moving = false;
    requestAnimationFrame((next) => this.draw(next));
  },

  drawCharts() {
    renewCharts();
    if (this.follows) charts.setWindow([wholeRun[1] - this.seconds, wholeRun[1]], String(this.seconds));
    else charts.setWindow(charts.window);
    charts.read(clock.sample);
  },
};

/** Gives every chart its new values, and makes those that have become worth showing. */
function renewCharts() {
  const list = chartList();
  charts.all = list.map((chart, place) => {
    const old = charts.all.find((each) => each.id === chart.id);
    if (old && labelsOf(old) === labelsOf(chart)) {
      return Object.assign(old, { series: chart.series, bounds: chart.bounds, decimals: chart.decimals });
    }
    old?.graph.destroy();
    old?.plot.closest("figure").remove();
    const built = charts.build(chart);
    byId("charts").insertBefore(built.plot.closest("figure"), byId("charts").children[place] ?? null);
    return built;
  });
  lanes.bands = [];
  byId("lanes").replaceChildren();
  lanes.start();
}

function labelsOf(chart) {
  return chart.series.map((series) => series.label).join("|");
}

// Who drags across a chart wants to look there.
const setWindow = charts.setWindow;
charts.setWindow = function (range, name) {
  if (!live.moving) live.setFollowing(false);
  setWindow.call(charts, range, name);
};

live.start();
