"use strict";
// Slider, buttons and keys that move the clock.

const leastOverview = 1; // newtons behind the slider at its full height; less is noise

const player = {
  start() {
    byId("player").hidden = lastSample === 0;
    if (lastSample === 0) return;
    this.slider = byId("time");
    this.slider.max = String(lastSample);
    this.slider.addEventListener("input", () => {
      clock.pause();
      clock.seek(Number(this.slider.value));
    });
    byId("play").addEventListener("click", () => clock.toggle());
    byId("back").addEventListener("click", () => clock.step(-1));
    byId("forward").addEventListener("click", () => clock.step(1));
    byId("speed").addEventListener("change", (event) => { clock.speed = Number(event.target.value); });
    byId("watch").hidden = report.contacts.length === 0;
    byId("watch").addEventListener("click", () => this.watch());
    document.addEventListener("keydown", (event) => this.key(event));
    document.addEventListener("playing", (event) => this.showPlaying(event.detail));
    this.drawOverview();
    this.drawMarks();
    clock.follow((sample) => this.show(sample));
  },

  show(sample) {
    const time = timeOf(sample);
    const since = sinceContact(time);
    this.slider.value = String(sample);
    this.slider.setAttribute("aria-valuetext", `${fixed(time, 3)} seconds${since ? `, ${since}` : ""}`);
    this.slider.style.setProperty("--done", `${(100 * sample) / lastSample}%`);
    byId("clock").replaceChildren(element("b", {}, `${fixed(time, 3)} s`), element("span", {}, since));
  },

  showPlaying(playing) {
    byId("play").setAttribute("aria-label", playing ? "Pause" : "Play");
    byId("play-icon").setAttribute("d", playing ? "M4 3h3v10H4zm5 0h3v10H9z" : "M4 2.5 13 8l-9 5.5z");
  },

  /** Plays the contact that the clock is at slowly, from shortly before it begins. */
  watch() {
    const contact = contactAt(timeOf(clock.sample));
    clock.pause();
    clock.speed = 0.05;
    byId("speed").value = "0.05";
    charts.zoomTo("contact");
    clock.seekTime(contact.start - 0.04);
    clock.play();
  },

  key(event) {
    const target = event.target;
    const typing = target.matches("input[type=search], select, textarea");
    if (typing || event.ctrlKey || event.altKey || event.metaKey) return;
    const stride = event.shiftKey ? 10 : 1;
    const acts = {
      ArrowLeft: () => clock.step(-stride),
      ArrowRight: () => clock.step(stride),
      " ": () => clock.toggle(),
    };
    if (!(event.key in acts) || (event.key === " " && target.matches("button, summary"))) return;
    event.preventDefault();
    acts[event.key]();
  },

  /** The contact force over the whole run, behind the slider. */
  drawOverview() {
    const force = report.columns.contact_force ?? magnitudeOf("estimated_force");
    if (!force) return;
    const buckets = 600;
    const peaks = Array.from({ length: buckets }, () => 0);
    force.forEach((value, sample) => {
      const bucket = Math.min(buckets - 1, Math.floor((sample / (lastSample + 1)) * buckets));
      peaks[bucket] = Math.max(peaks[bucket], value ?? 0);
    });
    const largest = Math.max(...peaks, leastOverview);
    const outline = peaks.map((value, i) => [i, 30 - (28 * value) / largest]);
    set(byId("overview"), { viewBox: `0 0 ${buckets} 30` });
    shape(byId("overview"), "path", { d: `M0 30${polyline(outline).replace("M", "L")}L${buckets} 30Z` });
  },

  /** Where contacts last and where they were detected. */
  drawMarks() {
    const share = (time) => `${(100 * (time - wholeRun[0])) / (wholeRun[1] - wholeRun[0])}%`;
    for (const contact of report.contacts) {
      const band = element("span", { class: "band" });
      band.style.left = share(contact.start);
      band.style.width = share(wholeRun[0] + contactEnd(contact) - contact.start);
      byId("time-marks").append(band);
      if (contact.detected === null) continue;
      const tick = element("span", { class: "tick" });
      tick.style.left = share(contact.detected);
      byId("time-marks").append(tick);
    }
  },
};
