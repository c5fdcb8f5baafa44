"use strict";
// The one time that robot, charts and slider show.

const clock = {
  sample: -1,
  playing: false,
  speed: 0.1,
  listeners: [],

  /** Calls listener(sample) now and on every change. */
  follow(listener) {
    this.listeners.push(listener);
    if (this.sample >= 0) listener(this.sample);
  },

  seek(sample) {
    this.sample = Math.min(lastSample, Math.max(0, Math.round(sample)));
    for (const listener of this.listeners) listener(this.sample);
  },

  seekTime(time) {
    this.seek(sampleAt(time));
  },

  step(samples) {
    this.pause();
    this.seek(this.sample + samples);
  },

  play() {
    if (this.playing || lastSample === 0) return;
    if (this.sample >= lastSample) this.seek(0);
    this.playing = true;
    this.announce();
    this.anchor = null;
    requestAnimationFrame((now) => this.advance(now));
  },

  pause() {
    if (!this.playing) return;
    this.playing = false;
    this.announce();
  },

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  },

  /** Moves on by the wall time since the last frame, kept as a fraction of a sample. */
  advance(now) {
    if (!this.playing) return;
    const anchor = this.anchor;
    if (!anchor || anchor.sample !== this.sample || anchor.speed !== this.speed) {
      this.anchor = { now, start: this.sample, sample: this.sample, speed: this.speed };
    } else {
      const due = anchor.start + Math.floor(((now - anchor.now) * 1e-3 * this.speed) / report.period);
      if (due !== this.sample) this.seek(due);
      anchor.sample = this.sample;
    }
    if (this.sample >= lastSample) this.pause();
    requestAnimationFrame((next) => this.advance(next));
  },

  announce() {
    document.dispatchEvent(new CustomEvent("playing", { detail: this.playing }));
  },
};
