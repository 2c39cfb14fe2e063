import { themeColor } from "./elements.js";
import { valueAt } from "./curve_scale.js";

const DASHES = [5, 4];
const MARK = { failure: "bad", task: "accent", docked: "dock", intervention: "person", pause: "muted" };  // colours of the theme

/** Draws curves, their axes and thresholds, and marks, with a pen on a canvas. */
export class CurveDrawing {
  constructor(pen, axis, { top, bottom, end }) {
    Object.assign(this, { pen, axis, top, bottom, end });
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "middle";
    pen.lineJoin = "round";
  }

  get right() { return this.axis.left + this.axis.width; }

  /** The numbers of an axis, and lines across the plot for the left one. */
  scale(scale, side) {
    if (!scale) return;
    const { pen, axis } = this, isLeft = side === "left";
    pen.textAlign = "right";
    scale.ticks.forEach((value, n) => {
      const y = Math.round(scale.y(value)), last = n === scale.ticks.length - 1;
      pen.fillStyle = themeColor("grid");
      if (isLeft) pen.fillRect(axis.left, y, axis.width, 1);
      this.label(`${scale.text(value)}${last && scale.unit ? ` ${scale.unit}` : ""}`, isLeft ? axis.left - 6 : this.right - 2, y, themeColor("muted"), !isLeft);
    });
  }

  /** A text; over the plot it has a halo in the colour of the paper. */
  label(text, x, y, color, hasHalo = true) {
    const { pen } = this;
    if (hasHalo) {
      pen.lineWidth = 3;
      pen.strokeStyle = themeColor("surface");
      pen.strokeText(text, x, y);
    }
    pen.fillStyle = color;
    pen.fillText(text, x, y);
  }

  /** Draw only in the plot. */
  within(draw) {
    const { pen, axis } = this;
    pen.save();
    pen.beginPath();
    pen.rect(axis.left, this.top - 1, axis.width, this.bottom - this.top + 2);
    pen.clip();
    draw();
    pen.restore();
  }

  curve({ series, source, scale: factor }, scale, color, dashes = []) {
    const { pen, axis } = this, points = series.points(axis.from, axis.to, axis.grain, source.isStep);
    pen.beginPath();
    let isDown = false, before = 0;
    for (let i = 0; i < points.length; i += 2) {
      const x = axis.x(points[i]), y = scale.y(points[i + 1] * factor), isNumber = y === y;
      if (isDown && source.isStep) pen.lineTo(x, before);
      if (isNumber && isDown) pen.lineTo(x, y);
      else if (isNumber) pen.moveTo(x, y);
      isDown = isNumber;
      before = y;
    }
    if (isDown && source.isStep && points.at(-2) >= source.track.times.at(-1)) pen.lineTo(axis.x(this.end), before);
    this.stroke(color, dashes);
  }

  stroke(color, dashes) {
    const { pen } = this;
    pen.lineWidth = dashes.length ? 1 : 1.5;
    pen.setLineDash(dashes);
    pen.strokeStyle = color;
    pen.stroke();
    pen.setLineDash([]);
  }

  /** A value that a context compares a curve with: a dashed line. Returns the height of its label, NaN for none. */
  threshold({ value, source }, series, scale, color) {
    const { pen, axis } = this, shown = source ? valueAt(source, Math.min(axis.to, this.end)) : value;
    if (source) this.curve({ series, source, scale: 1 }, scale, color, DASHES);
    if (!(shown >= scale.low && shown <= scale.high)) return NaN;
    const y = Math.round(scale.y(shown)) + 0.5;
    if (source) return y;
    pen.beginPath();
    pen.moveTo(axis.left, y);
    pen.lineTo(this.right, y);
    this.stroke(color, DASHES);
    return y;
  }

  thresholdLabel(text, y, color) {
    this.pen.textAlign = "left";
    this.label(text, this.axis.left + 6, y - 7 < this.top + 4 ? y + 8 : y - 7, color);
  }

  /** A line down the plot for each mark, with its sign on top. */
  mark({ t, sort }) {
    const { pen, axis } = this, x = Math.round(axis.x(t)), y = this.top - 5;
    pen.fillStyle = themeColor(MARK[sort] ?? "muted");
    pen.globalAlpha = 0.35;
    pen.fillRect(x, this.top, 1, this.bottom - this.top);
    pen.globalAlpha = 1;
    pen.beginPath();
    if (sort === "failure") { pen.moveTo(x, y - 5); pen.lineTo(x + 5, y + 4); pen.lineTo(x - 5, y + 4); }
    else if (sort === "intervention") { pen.moveTo(x, y - 5); pen.lineTo(x + 5, y); pen.lineTo(x, y + 5); pen.lineTo(x - 5, y); }
    else if (sort === "task") pen.arc(x, y, 4, 0, 2 * Math.PI);
    else pen.rect(x - 4, y - 4, 8, 8);
    pen.fill();
  }

  /** The times for which a plan was refused again and again, at the height `y`. */
  refusals(runs, y, text) {
    const { pen, axis } = this, color = themeColor("warn");
    pen.fillStyle = color;
    for (const { from, to } of runs) {
      const x = Math.max(axis.left, axis.x(from));
      pen.fillRect(x, y - 2, Math.max(3, Math.min(axis.x(to), this.right) - x), 4);
    }
    pen.textAlign = "right";
    let short = text;
    while (short.length > 4 && pen.measureText(short).width > axis.left - 12) short = `${short.slice(0, -2)}…`;
    this.label(short, axis.left - 6, y, color, false);
  }
}
