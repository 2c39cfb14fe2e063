import { Changing } from "./changing.js";

const LEAST = 0.01;  // seconds: the shortest range
const SPAN = 120, SHORTEST = 10;  // seconds of a live run
const EDGE = 0.9;  // part of the width at which a moment that moves is held
const TICK = 70;  // pixels between two ticks, at least
const STEPS = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1, 2, 5, 10, 15, 30, 60, 120, 300, 600, 900, 1800, 3600, 7200, 21600, 43200, 86400];

/**
 * The range of time that lanes and curves show.
 *
 * `from`, `to`: seconds. `left`: pixels before the range, and `right` after it, for labels; `width`: pixels of the range. A recording is shown
 * whole, a live run with its last two minutes, until you zoom or pan.
 */
export class TimeAxis extends Changing {
  constructor(time) {
    super();
    Object.assign(this, { time, from: 0, to: 1, left: 120, right: 12, width: 1, mode: "auto" });
    this.seen = 0;  // the moment at the last update
    this.wasLive = false;
  }

  /** The pixel of a moment, from the left edge of the labels. */
  x(t) { return this.left + (t - this.from) / (this.to - this.from) * this.width; }

  /** The moment of a pixel. */
  t(x) { return this.from + (x - this.left) * this.grain; }

  /** Seconds of a pixel. */
  get grain() { return (this.to - this.from) / this.width; }

  get span() { return this.to - this.from; }

  has(t) { return t >= this.from && t <= this.to; }

  /** Make the range `factor` times shorter; the moment `t` stays where it is. */
  zoom(factor, t = this.has(this.time.now) ? this.time.now : (this.from + this.to) / 2) {
    const span = Math.min(Math.max(this.time.run.end * 1.05, this.span), Math.max(LEAST, this.span / factor)), part = (t - this.from) / this.span;
    this.show(t - part * span, t + (1 - part) * span);
  }

  pan(seconds) { this.show(this.from + seconds, this.to + seconds); }

  /** Show this range, moved to where the run is. */
  show(from, to) {
    this.mode = "still";
    this.set(from, to - from);
    this.notify();
  }

  /** Show the whole run. */
  all() {
    this.mode = "all";
    this.notify();
  }

  /** Show the end of a live run, or the whole recording, again. */
  follow() {
    this.mode = "auto";
    this.notify();
  }

  set(from, span) {
    const end = Math.max(this.time.run.end * 1.05, span);
    this.from = Math.max(0, Math.min(from, end - span));
    this.to = this.from + Math.max(LEAST, span);
  }

  /** Follow the run and its moment `t`; called before each drawing. */
  update(t) {
    const { live, canBeLive, run } = this.time, before = this.seen;
    if (live && !this.wasLive) this.mode = "auto";
    Object.assign(this, { seen: t, wasLive: live });
    if (this.mode === "all" || (this.mode === "auto" && !canBeLive)) this.set(0, Math.max(1, run.end));
    else if (this.mode === "auto" && live) this.followEnd(run.end);
    else if (t !== before) this.keepInView(t, before);
  }

  followEnd(end) {
    const span = Math.min(SPAN, Math.max(SHORTEST, end / EDGE));
    this.from = Math.max(0, end - EDGE * span);
    this.to = this.from + span;
  }

  keepInView(t, before) {
    const { span, time } = this, moves = time.live || time.playing;
    if (moves && !this.has(before)) return;  // you look at something else meanwhile
    if (t > this.from + (moves ? EDGE : 1) * span) this.set(t - (moves ? EDGE : 0.5) * span, span);
    else if (t < this.from) this.set(t - span / 2, span);
  }

  /** Moments for ticks, at round numbers of seconds. */
  ticks() {
    const step = STEPS.find((each) => each >= TICK * this.grain) ?? STEPS.at(-1), ticks = [];
    for (let n = Math.ceil(this.from / step); n * step <= this.to; n++) ticks.push(n * step);
    return ticks;
  }
}
