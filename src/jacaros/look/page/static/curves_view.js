import { CurveDrawing } from "./curve_drawing.js";
import { CurveScale, valueAt } from "./curve_scale.js";
import { button, clock, element, isDark, setText } from "./elements.js";
import { markLine } from "./happenings.js";
import { paced } from "./paced.js";
import { robotColor } from "./palette.js";
import { Series } from "./series.js";
import { keyed, refill } from "./refill.js";
import { fitted } from "./time_canvas.js";
import { TimePointer } from "./time_pointer.js";

const LEAST = 60;  // pixels: the height of the plot
const TOP = 14;  // pixels above it, for marks
const SCALE = 54;  // pixels for the numbers of the right axis
const NEAR = 6;  // pixels between the pointer and a mark

/** Numbers over time: a chip for each, and a plot with two axes, thresholds of contexts, and marks of events. */
export class CurvesView {
  constructor(root, context, { sources, thresholds, log }) {
    Object.assign(this, { root, context, sources, thresholds, log, axis: context.axis, choice: context.curves });
    this.series = new Map();
    this.chips = element("ul", "chips");
    this.more = element("select", "more");
    this.more.setAttribute("aria-label", "Add a curve");
    this.more.addEventListener("change", () => this.choice.set([this.more.value], true));
    this.canvas = element("canvas");
    this.canvas.setAttribute("role", "img");
    this.tip = element("p", "tip");
    this.tip.hidden = true;
    this.hint = element("p", "empty", "Press ∿ beside a belief or property, or drag a robot or message to here.");
    this.plot = element("div", "plot", this.canvas, this.hint, this.tip);
    root.append(element("div", "curves-head", this.chips, this.more), this.plot);
    new TimePointer(this.plot, this.axis, this);
    this.choice.acceptDrops(root);
    this.showValues = paced((sources, t) => sources.forEach((source, i) => setText(this.values[i], valueText(source, t))));
  }

  get empty() { return this.sources.version === 0; }

  show(t) {
    this.t = t;
    const shown = this.choice.shown, stamp = `${this.choice.stamp} ${this.sources.version} ${isDark()}`;
    if (stamp !== this.stamp) {
      this.stamp = stamp;
      this.curves = this.curvesOf(shown);
      this.fill(shown);
      this.axis.right = this.curves.some(({ side }) => side === "right") ? SCALE : 12;
      this.context.time.notify();  // lanes have the same margin
    }
    this.showValues(shown, t);
    this.draw(shown);
  }

  // ---- chips

  fill(shown) {
    refill(this.chips, this.curves.map((curve) => this.chip(curve)));
    this.values = [...this.chips.querySelectorAll(".value")];
    this.hint.hidden = shown.length > 0;
    const others = this.sources.shown().filter((each) => !shown.includes(each));
    this.more.replaceChildren(new Option("+ Curve", ""), ...others.map(({ key, title }) => new Option(title, key)));
    this.more.hidden = !others.length;
    this.canvas.setAttribute("aria-label", `Curves of ${shown.map(({ title }) => title).join(", ")}`);
  }

  chip({ source, side, color }) {
    const { key, title } = source, dot = element("i", "dot"), axis = element("span", "", side === "left" ? "⇤" : "⇥");
    dot.style.background = color;
    axis.title = `on the ${side} axis`;
    const remove = button("act", () => this.choice.set([key], false), "×");
    remove.setAttribute("aria-label", `Remove the curve of ${title}`);
    return element("li", "chip", dot, title, element("b", "value", valueText(source, this.t)), axis, keyed(`remove ${key}`, remove));
  }

  /** The curves to draw. Those with the unit of the first one, or numbers of its size, have the left axis. */
  curvesOf(shown) {
    const groups = shown.map((source) => source.unit || magnitude(this.seriesOf(source)));
    return shown.map((source, i) => ({
      source, series: this.seriesOf(source), scale: source.scale ?? 1, color: robotColor(i),
      side: groups[i] === groups[0] ? "left" : "right",
    }));
  }

  // ---- plot

  draw(shown) {
    const { axis, plot, log, context: { run } } = this, box = [plot.clientWidth, Math.max(LEAST, plot.clientHeight)];
    const stamp = [this.stamp, axis.from, axis.to, axis.width, ...box, run.count].join(" ");
    if (stamp === this.drawn) return;
    this.drawn = stamp;
    const bottom = box[1] - 6;
    const drawing = new CurveDrawing(fitted(this.canvas, ...box), axis, { top: TOP, bottom, end: run.end });
    shown.forEach((source, i) => Object.assign(this.curves[i], { series: this.seriesOf(source), lines: this.thresholds.of(source) }));
    const scales = { left: this.scaleOf("left", bottom), right: this.scaleOf("right", bottom) };
    drawing.scale(scales.left, "left");
    this.marks = log.marksIn(axis.from, axis.to, NEAR * axis.grain);
    for (const mark of this.marks) drawing.mark(mark);
    drawing.within(() => this.drawCurves(drawing, scales));
    drawing.scale(scales.right, "right");
  }

  scaleOf(side, bottom) {
    const own = this.curves.filter((each) => each.side === side);
    return own.length ? new CurveScale(own, this.axis, TOP, bottom) : null;
  }

  drawCurves(drawing, scales) {
    const { curves } = this, labels = [];
    for (const { lines, side, color } of curves) {
      for (const { value, source, label } of lines) {
        const shown = source ? valueAt(source, Math.min(this.axis.to, this.context.run.end)) : value;
        const y = drawing.threshold(shown, source && { series: this.seriesOf(source), source, scale: 1 }, scales[side], color);
        if (!Number.isNaN(y)) labels.push([`${Number(shown.toFixed(3))}${source ? ` ${source.name}` : ""}: ${label}`, y, color]);
      }
    }
    for (const curve of curves) drawing.curve(curve, scales[curve.side], curve.color);
    // Robots of one program have the same thresholds.
    for (const label of new Map(labels.map((each) => [`${each[0]} ${each[1]}`, each])).values()) drawing.thresholdLabel(...label);
  }

  seriesOf(source) {
    if (!this.series.has(source.key)) this.series.set(source.key, new Series(source.track));
    const series = this.series.get(source.key);
    series.grow();
    return series;
  }

  // ---- the pointer

  click(x) {
    const mark = this.markAt(x);
    if (!mark) return false;
    this.context.time.go(mark.t);
    if (mark.leads) this.context.selection.choose(mark.leads);
    return true;
  }

  markAt(x) { return this.marks?.findLast(({ t }) => Math.abs(this.axis.x(t) - x) < NEAR); }

  hover(x) {
    this.tip.hidden = x === null || x < this.axis.left;
    if (this.tip.hidden) return;
    setText(this.tip, this.tellAt(x));
    const half = this.tip.offsetWidth / 2;
    this.tip.style.left = `${Math.max(half, Math.min(this.plot.clientWidth - half, x))}px`;
  }

  tellAt(x) {
    const t = this.axis.t(x), mark = this.markAt(x);
    if (mark) return markLine(mark);
    return [clock(t), ...this.choice.shown.map((source) => `${source.title} ${valueText(source, t)}`)].join("  ");
  }
}

/** The power of ten of the largest value, to tell numbers of different sizes apart. */
function magnitude(series) {
  const [low, high] = series.extremes(0, series.count);
  return Math.floor(Math.log10(Math.max(Math.abs(low), Math.abs(high)) || 1));
}

function valueText(source, t) {
  const value = valueAt(source, t);
  return Number.isNaN(value) ? "–" : `${Number(value.toFixed(Math.abs(value) < 10 ? 2 : 1))} ${source.unit}`.trim();
}
