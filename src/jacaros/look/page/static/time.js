import { Changing } from "./changing.js";

const LAG = 0.15;  // seconds that the page is behind the run, so that robots glide from one sample to the next
const JUMP = 3;  // seconds of lag that are made up for in one step

/**
 * The moment that is shown.
 *
 * `now`: seconds since the run began; `live`: follow the end of the run; `playing`: move on by itself, at `speed`.
 */
export class Time extends Changing {
  constructor(run, live) {
    super();
    this.run = run;
    this.now = 0;
    this.live = live;
    this.canBeLive = live;
    this.lost = null;  // when the last message of a run came whose connection is lost, by Date.now()
    this.playing = false;
    this.speed = 1;
  }

  /** Show the moment `t`; a live page stops following the run. */
  go(t) {
    this.now = Math.min(this.run.end, Math.max(0, t));
    this.live = false;
    this.notify();
  }

  /** Follow the run again. */
  follow() {
    this.playing = false;
    this.live = this.canBeLive;
    this.now = this.run.end;
    this.notify();
  }

  /** The run sends nothing more: its last message came at `heard`, or null when it has ended. */
  end(heard) {
    Object.assign(this, { lost: heard, live: false, canBeLive: false });
    this.notify();
  }

  play() {
    if (this.live) return;
    if (this.now >= this.run.end) this.now = 0;
    this.playing = true;
    this.notify();
  }

  pause() {
    this.playing = false;
    this.live = false;
    this.notify();
  }

  /** Play or pause what was; a run that is followed is not held. */
  toggle() { if (this.playing) this.pause(); else this.play(); }

  /** Move on by `seconds` of real time; true when the moment has changed. */
  tick(seconds) {
    const before = this.now;
    if (this.live) this.approach(seconds);
    else if (this.playing) this.advance(seconds * this.speed);
    return this.now !== before;
  }

  approach(seconds) {
    const lag = this.run.end - this.now, step = lag * Math.min(1, seconds / LAG);
    this.now = lag < 0.002 || lag > JUMP ? this.run.end : this.now + step;
  }

  advance(seconds) {
    this.now = Math.min(this.run.end, this.now + seconds);
    if (this.now < this.run.end) return;
    this.playing = false;
    if (this.canBeLive && !this.run.over) this.live = true;
    this.notify();
  }
}
