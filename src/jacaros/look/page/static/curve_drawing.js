import { themeColor } from "./elements.js";

const DASHES = [5, 4];
const HALF_TURN = 180;  // degrees: 180 and -180 are the same heading
const MARKS = {
  failure: ["▲", "bad"], handled: ["△", "bad"], task: ["●", "accent"], docked: ["■", "dock"], intervention: ["◆", "person"], pause: ["‖", "muted"],
};

/** Draws curves, their axes and thresholds, and marks, with a pen on a canvas. */
export class CurveDrawing {
  constructor(pen, axis, { top, bottom, end }) {
    Object.assign(this, { pen, axis, top, bottom, end, labels: [] });
    pen.font = "11px system-ui, sans-serif";
    pen.textBaseline = "middle";
    pen.lineJoin = "bevel";
  }

  get right() { return this.axis.left + this.axis.width; }

  /** The numbers of an axis, and lines across the plot for the left one. */
  scale(scale, side) {
    if (!scale) return;
    const { pen, axis } = this, isLeft = side === "left";
    pen.textAlign = isLeft ? "right" : "left";
    scale.ticks.forEach((value, n) => {
      const y = Math.round(scale.y(value)), unit = scale.unit && n === scale.ticks.length - 1 ? ` ${scale.unit}` : "";
      pen.fillStyle = themeColor("grid");
      if (isLeft) pen.fillRect(axis.left, y, axis.width, 1);
      pen.fillStyle = themeColor("muted");
      pen.fillText(scale.text(value) + unit, isLeft ? axis.left - 6 : this.right + 6, y);
    });
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
    const { axis } = this, points = series.points(axis.from, axis.to, axis.grain, source.isStep), { length } = points, line = [];
    // A line that is one pixel wide and on whole pixels is drawn ten times as fast.
    const isDense = length > 2 * axis.width, x = (t) => (isDense ? Math.round(axis.x(t)) + 0.5 : axis.x(t));
    for (let i = 0; i < length; i += 2) {
      if (source.unit === "°" && Math.abs(points[i + 1] - points[i - 1]) * factor > HALF_TURN) line.push(x(points[i]), NaN);
      // The value of a step holds until the next one.
      if (source.isStep && i) line.push(x(points[i]), line.at(-1));
      line.push(x(points[i]), scale.y(points[i + 1] * factor));
    }
    if (source.isStep && points[length - 2] >= source.track.times.at(-1)) line.push(x(this.end), line.at(-1));
    this.line(line, color, dashes, isDense || dashes.length ? 1 : 1.5);
  }

  /** Draw a line through points, x and y in turn, with gaps where y is NaN. */
  line(points, color, dashes = [], width = 1) {
    const { pen } = this;
    pen.beginPath();
    for (let i = 0; i < points.length; i += 2) {
      if (Number.isNaN(points[i - 1] ?? NaN)) pen.moveTo(points[i], points[i + 1]); else pen.lineTo(points[i], points[i + 1]);
    }
    pen.lineWidth = width;
    pen.setLineDash(dashes);
    pen.strokeStyle = color;
    pen.stroke();
    pen.setLineDash([]);
  }

  /**
   * A value that a context compares a curve with: a dashed line, or the `curve` of a belief that changes. Returns the height
   * of its label, NaN for none.
   */
  threshold(value, curve, scale, color) {
    const { axis } = this, y = Math.round(scale.y(value)) + 0.5;
    if (curve) this.curve(curve, scale, color, DASHES);
    else this.line([axis.left, y, this.right, y], color, DASHES);
    return value >= scale.low && value <= scale.high ? y : NaN;
  }

  /** Write the label of a threshold above its line at the height `y`, to the right of the labels that are there. */
  thresholdLabel(text, y, color) {
    const { pen, labels } = this, width = pen.measureText(text).width + 8, middle = y - 8 > this.top ? y - 8 : y + 9;
    const left = Math.max(this.axis.left + 4, ...labels.filter((each) => Math.abs(each.middle - middle) < 14).map(({ right }) => right));
    labels.push({ middle, right: left + width + 4 });
    pen.globalAlpha = 0.8;
    pen.fillStyle = themeColor("surface");
    pen.fillRect(left, middle - 7, width, 14);
    pen.globalAlpha = 1;
    pen.textAlign = "left";
    pen.fillStyle = color;
    pen.fillText(text, left + 4, middle);
  }

  /** A line down the plot for each mark, with its sign on top. */
  mark({ t, sort }) {
    const { pen, top, bottom } = this, x = Math.round(this.axis.x(t)), [sign, color] = MARKS[sort] ?? MARKS.pause;
    pen.fillStyle = themeColor(color);
    pen.globalAlpha = 0.35;
    pen.fillRect(x, top, 1, bottom - top);
    pen.globalAlpha = 1;
    pen.textAlign = "center";
    pen.fillText(sign, x + 0.5, top - 6);
  }
}
