import { themeColor } from "./elements.js";

const DASHES = [5, 4];
const HALF_TURN = 180;  // degrees: 180 and -180 are the same heading
const COARSE = 1000;  // numbers of a line that are looked at for a place
const PLACES = 12, STAY = 8, MANY = 40;  // of labels of thresholds: places along the line, and parts of curves that a better one saves
const MARKS = {
  failure: ["▲", "bad"], handled: ["△", "bad"], task: ["●", "accent"], docked: ["■", "dock"], intervention: ["◆", "person"], pause: ["‖", "muted"],
};

/** Draws curves, their axes and thresholds, and marks, with a pen on a canvas. */
export class CurveDrawing {
  constructor(pen, axis, { top, bottom, end }) {
    Object.assign(this, { pen, axis, top, bottom, end, lines: [] });
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
    this.lines.push(line);
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

  /** Write the label of a threshold at the height `y` where it hides the least; it stays at its place in `last` unless another is much better. */
  thresholdLabel(text, y, color, last) {
    const { pen, axis } = this, width = pen.measureText(text).width + 8, step = Math.max(0, axis.width - width - 8) / (PLACES - 1), found = [];
    for (const middle of [y - 8, y + 9]) {
      for (let n = 0; n < PLACES && middle > this.top && middle < this.bottom; n++) {
        const x = axis.left + 4 + n * step, box = [x, middle - 7, x + width, middle + 7], place = `${n} ${middle < y}`;
        found.push({ x, box, middle, place, cost: this.hiddenBy(box) - (last.get(text) === place ? STAY : 0) });
      }
    }
    if (!found.length) return;
    const { x, box: [left, top, right, bottom], middle, place } = found.reduce((best, each) => (each.cost < best.cost ? each : best));
    last.set(text, place);
    for (let n = 0; n < MANY; n++) this.lines.push([left, top, right, bottom]);  // other labels go elsewhere
    pen.globalAlpha = 0.8;
    pen.fillStyle = themeColor("surface");
    pen.fillRect(left, top, width, 14);
    pen.globalAlpha = 1;
    pen.textAlign = "left";
    pen.fillStyle = color;
    pen.fillText(text, x + 4, middle);
  }

  /** How many parts of curves are in a box. */
  hiddenBy([left, top, right, bottom]) {
    let count = 0;
    for (const line of this.lines) {
      const step = 2 * Math.ceil(line.length / COARSE);
      for (let i = step; i < line.length; i += step) {
        const x = line[i - step], y = line[i - step + 1], u = line[i], v = line[i + 1];
        if (x < right && u > left && Math.min(y, v) < bottom && Math.max(y, v) > top) count += 1;
      }
    }
    return count;
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
