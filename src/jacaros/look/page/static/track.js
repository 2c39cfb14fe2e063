const NONE = [];

/** A value that changes over time, and what it was at any moment. */
export class Track {
  /** @param {number} limit values that are kept; the oldest are dropped first. */
  constructor(limit = Infinity) {
    this.times = [];
    this.values = [];
    this.limit = limit;
  }

  /** Add a value; returns those that are dropped. */
  add(t, value) {
    this.times.push(t);
    this.values.push(value);
    // A quarter in one pass: dropping one value at a time would move all the others each time.
    const excess = this.times.length > this.limit * 1.25 ? this.times.length - this.limit : 0;
    if (!excess) return NONE;
    this.times.splice(0, excess);
    return this.values.splice(0, excess);
  }

  /** The values after time `from`, up to time `to`, oldest first. */
  between(from, to) { return this.values.slice(indexAt(this.times, from) + 1, indexAt(this.times, to) + 1); }

  /** How many values there are up to time `t`. */
  countAt(t) { return indexAt(this.times, t) + 1; }

  /** Value at time `t`, undefined before the first one. */
  at(t) { return this.values[indexAt(this.times, t)]; }

  /** Time of the value at time `t`, undefined before the first one. */
  since(t) { return this.times[indexAt(this.times, t)]; }
}

/** Index of the last of the sorted `times` that is at most `t`; -1 without any. */
export function indexAt(times, t) {
  let low = 0, high = times.length;
  while (low < high) {
    const middle = (low + high) >> 1;
    if (times[middle] <= t) low = middle + 1; else high = middle;
  }
  return low - 1;
}
