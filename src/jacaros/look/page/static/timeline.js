import { button, clock, element, setText } from "./elements.js";
import { markLine } from "./happenings.js";
import { moveByArrows } from "./refill.js";

const SPEEDS = [0.5, 1, 2, 5, 10, 30, 100];
const NEAR = 7;  // pixels: marks of one sort that are nearer become one
const LONGEST = 45;  // seconds that a replay lasts at the speed it begins with, if one is fast enough
const PLAY = "▶", PAUSE = "❚❚";

/** Time: slider, marks, play and pause, speed, and the way back to a live run. */
export class TimelineView {
  constructor(root, context, log) {
    Object.assign(this, { root, log, time: context.time, axis: context.axis, run: context.run, selection: context.selection });
    this.drawn = { end: -1, length: 0, width: 0 };
    this.hasSpeed = false;
    this.make();
    this.listen();
  }

  make() {
    this.play = button("round", () => this.time.toggle(), PLAY);
    this.play.id = "play";
    this.onAir = element("span", "onair", "Live");
    this.now = element("b", "", "0:00.0");
    this.now.id = "now";
    this.end = element("span");
    this.slider = element("input");
    Object.assign(this.slider, { type: "range", id: "scrub", min: "0", max: "1", step: "0.05", value: "0" });
    this.slider.setAttribute("aria-label", "Time");
    this.marks = element("div", "marks");
    this.marks.setAttribute("role", "group");
    this.marks.setAttribute("aria-label", "Events. The arrow keys move from one to the next.");
    this.tip = element("p", "tip");
    this.tip.hidden = true;
    this.live = button("plain live", () => this.time.follow(), "Back to live");
    this.speed = element("select");
    this.speed.id = "speed";
    for (const speed of SPEEDS) this.speed.append(new Option(speed === 0.5 ? "½×" : `${speed}×`, String(speed)));
    this.speedLabel = element("label", "speed", "Speed ", this.speed);
    this.range = element("div", "range");
    const track = element("div", "track", this.marks, this.slider, element("div", "ranges", this.range), this.tip);
    this.root.append(this.play, this.onAir, element("div", "clock", this.now, " ", this.end), track, this.live, this.speedLabel);
  }

  listen() {
    this.slider.addEventListener("input", () => this.time.go(Number(this.slider.value)));
    this.speed.addEventListener("change", () => { this.time.speed = Number(this.speed.value); });
    moveByArrows(this.marks, ".mark", "ArrowRight", "ArrowLeft");
  }

  show(t) {
    const { time, run } = this;
    this.chooseSpeed();
    setText(this.now, clock(t));
    setText(this.end, `/ ${clock(run.end)}`);
    this.slider.max = String(run.end);
    this.slider.value = String(t);
    this.slider.setAttribute("aria-valuetext", clock(t));
    setText(this.play, time.playing ? PAUSE : PLAY);
    this.play.setAttribute("aria-label", time.playing ? "Pause the replay" : "Play");
    this.play.hidden = time.live;
    this.onAir.hidden = !time.live && !time.lost;
    setText(this.onAir, time.lost ? "Connection lost" : "Live");
    this.onAir.classList.toggle("lost", Boolean(time.lost));
    this.live.hidden = !time.canBeLive || time.live;
    this.speedLabel.hidden = time.live;
    this.showRange();
    this.showMarks();
  }

  /** Mark the part of the run that lanes and curves show. */
  showRange() {
    const { from, span } = this.axis, end = Math.max(this.run.end, 1e-9);
    this.range.hidden = span >= end;
    this.range.style.left = `${100 * from / end}%`;
    this.range.style.width = `${100 * Math.min(1, span / end)}%`;
  }

  /** Play a replay at a speed at which it does not last long. */
  chooseSpeed() {
    if (this.hasSpeed || this.run.end === 0) return;
    this.hasSpeed = true;
    if (!this.time.canBeLive) this.time.speed = Math.max(1, SPEEDS.find((speed) => this.run.end / speed <= LONGEST) ?? 100);
    this.speed.value = String(this.time.speed);
  }

  showMarks() {
    const width = this.marks.clientWidth, { end } = this.run, { length } = this.log.marks;
    // While a run continues, the marks move together: they are placed anew when that is a pixel.
    const moved = Math.abs(end - this.drawn.end) * width > Math.max(1, end);
    if (!moved && length === this.drawn.length && width === this.drawn.width) return;
    this.drawn = { end, length, width };
    const focused = this.marks.contains(document.activeElement) ? Number(document.activeElement.dataset.t) : null;
    this.marks.replaceChildren(...(end > 0 ? this.log.marksIn(0, end, NEAR * end / width) : []).map((mark, index) => this.mark(mark, index === 0)));
    if (focused !== null) this.marks.querySelector(`[data-t="${focused}"]`)?.focus();
  }

  mark(mark, first) {
    const { t, sort, leads } = mark, told = markLine(mark);
    const made = button(`mark ${sort}`, () => {
      this.time.go(t);
      if (leads) this.selection.choose(leads);
    });
    made.dataset.t = String(t);
    made.style.left = `${100 * t / this.run.end}%`;
    made.tabIndex = first ? 0 : -1;
    made.setAttribute("aria-label", told);
    for (const event of ["focus", "pointerenter"]) made.addEventListener(event, () => this.tell(made, told));
    for (const event of ["blur", "pointerleave"]) made.addEventListener(event, () => { this.tip.hidden = true; });
    return made;
  }

  tell(mark, text) {
    setText(this.tip, text);
    this.tip.hidden = false;
    const width = this.marks.clientWidth, half = this.tip.offsetWidth / 2;
    this.tip.style.left = `${Math.max(half, Math.min(width - half, mark.offsetLeft))}px`;
  }
}
