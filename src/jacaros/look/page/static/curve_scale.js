import { indexAt } from "./track.js";

const LINE = 20;  // pixels between two numbers of an axis, at least
const NEAR = 0.3;  // a threshold within this part of the curves' range beyond them is in view, too
const ROOM = 0.05;  // part of the range above and below the curves

/** The values that one side of the plot shows: from `low` to `high`, with round numbers at `ticks`. */
export class CurveScale {
  constructor(curves, axis, top, bottom) {
    Object.assign(this, { top, bottom, unit: curves.every(({ source }) => source.unit === curves[0].source.unit) ? curves[0].source.unit : "" });
    const isPercent = this.unit === "%", [least, most] = reach(curves, axis);
    let low = isPercent ? Math.min(0, least) : least, high = isPercent ? Math.max(100, most) : most;
    const near = isPercent ? 0 : NEAR * (high - low);
    for (const { value } of curves.flatMap(({ lines }) => lines)) {
      if (value >= least - near && value <= most + near) [low, high] = [Math.min(low, value), Math.max(high, value)];
    }
    if (!(low <= high)) [low, high] = [0, 1];
    const room = (high - low) * ROOM || Math.abs(high) * 0.1 || 1;
    Object.assign(this, isPercent ? { low, high } : { low: low - room, high: high + room });
    this.ticks = [];
    for (let parts = Math.max(1, Math.floor((bottom - top) / LINE)); this.ticks.length < 2; parts++) this.divide(niceStep(this.high - this.low, parts));
  }

  divide(step) {
    this.digits = Math.max(0, -Math.floor(Math.log10(step) + 1e-6));
    this.ticks = [];
    for (let n = Math.ceil(this.low / step - 1e-6); n * step <= this.high + step * 1e-6; n++) this.ticks.push(n * step);
  }

  y(value) { return this.bottom - (value - this.low) / (this.high - this.low) * (this.bottom - this.top); }

  text(value) { return (Number(value.toFixed(this.digits)) + 0).toFixed(Math.min(6, this.digits)); }
}

/** Smallest and largest value that curves have in view. */
function reach(curves, { from, to }) {
  let low = Infinity, high = -Infinity;
  for (const { series, scale } of curves) {
    const [start, end] = series.stretch(from, to), [least, most] = series.extremes(start, end);
    low = Math.min(low, least * scale);
    high = Math.max(high, most * scale);
  }
  return [low, high];
}

/** The smallest step of 1, 2 or 5 with which `parts` steps span `span`. */
function niceStep(span, parts) {
  const size = 10 ** Math.floor(Math.log10(span / parts));
  return size * [1, 2, 5, 10].find((each) => each * size * parts >= span * (1 - 1e-9));
}

/** The value of a source at time `t`: of a step the last one, of a line between two. */
export function valueAt({ track: { times, values }, isStep, scale = 1 }, t) {
  const i = indexAt(times, t), before = values[i], after = values[i + 1];
  if (i < 0) return NaN;
  const part = isStep || after === undefined || times[i + 1] === times[i] ? 0 : (t - times[i]) / (times[i + 1] - times[i]);
  return (part ? before + (after - before) * part : before) * scale;
}
