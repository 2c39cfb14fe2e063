import { indexAt } from "./track.js";

const BLOCK = 16;  // values of one level of the pyramid that make one of the next

/**
 * A number over time, ready to be drawn at any scale.
 *
 * The track has `times` and `values`; NaN marks a missing value. Above it stands a pyramid of the smallest and largest values of blocks,
 * which grows with the track, so that the extremes of any stretch cost a few comparisons.
 */
export class Series {
  constructor(track) {
    this.track = track;
    this.forget();
  }

  forget() {
    this.levels = [];
    this.count = 0;
    this.first = this.track.times[0];
  }

  /** Take what the track has received since the last time. */
  grow() {
    const { times, values } = this.track;
    if (times[0] !== this.first || values.length < this.count) this.forget();  // it has dropped its oldest values
    this.count = values.length;
    let below = { lows: values, highs: values };
    for (let level = 0; below.lows.length >= BLOCK; level++) {
      const above = this.levels[level] ??= { lows: [], highs: [] };
      for (let start = above.lows.length * BLOCK; start + BLOCK <= below.lows.length; start += BLOCK) {
        const box = [Infinity, -Infinity];
        widen(box, below, start, start + BLOCK);
        above.lows.push(box[0]);
        above.highs.push(box[1]);
      }
      below = above;
    }
  }

  /** Smallest and largest value of those with the indexes `from` to `to` - 1; [Infinity, -Infinity] without any. */
  extremes(from, to) {
    const box = [Infinity, -Infinity];
    let level = { lows: this.track.values, highs: this.track.values };
    for (let height = 0; from < to; height++) {
      const above = this.levels[height], up = Math.ceil(from / BLOCK), down = Math.floor(to / BLOCK);
      if (!above || up >= down) {
        widen(box, level, from, to);
        break;
      }
      widen(box, level, from, up * BLOCK);
      widen(box, level, down * BLOCK, to);
      [from, to, level] = [up, down, above];
    }
    return box;
  }

  /** The indexes of the values that are seen from time `from` to `to`: with the one before, and the one after. */
  stretch(from, to) {
    const { times } = this.track;
    return [Math.max(0, indexAt(times, from)), Math.min(times.length, indexAt(times, to) + 2)];
  }

  /**
   * What to draw from time `from` to `to`: times and values in turn, at most two points for each `grain` seconds, and NaN
   * where the line is broken.
   *
   * A step holds its value until the next one; other lines go straight.
   */
  points(from, to, grain, isStep) {
    const { times, values } = this.track, [start, end] = this.stretch(from, to), points = [];
    if ((end - start) * grain <= 2 * (to - from)) {
      for (let i = start; i < end; i++) points.push(times[i], values[i]);
      return points;
    }
    let last = NaN;
    // Columns lie on a grid of their own: they would flicker if they moved with the range.
    for (let i = start; i < end;) {
      const column = Math.floor(times[i] / grain), next = Math.max(i + 1, indexAt(times, (column + 1) * grain) + 1);
      const [low, high] = this.extremes(i, Math.min(next, end));
      if (low > high) points.push(times[i], NaN);
      else if (Math.abs(last - high) < Math.abs(last - low)) points.push(times[i], high, times[i], low);
      else points.push(times[i], low, times[i], high);
      last = values[next - 1];
      if (isStep && next < end && Math.floor(times[next] / grain) > column + 1) points.push(times[next - 1], last);
      i = next;
    }
    return points;
  }
}

function widen(box, { lows, highs }, from, to) {
  for (let i = from; i < to; i++) {
    if (lows[i] < box[0]) box[0] = lows[i];
    if (highs[i] > box[1]) box[1] = highs[i];
  }
}
