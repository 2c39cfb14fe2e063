import { indexAt } from "./track.js";

const LEAST = 64;  // changes between two checkpoints, at least
const LIMIT = 20000;  // changes that are kept: a live page may be open for days

/**
 * A map that changes over time, and what it held at any moment.
 *
 * Checkpoints are copies of the map.  They are as far apart as the map is large, so that they need about as much memory as
 * the changes do, and a moment is reached from the nearest one before it.
 */
export class Fold {
  /**
   * @param {function(Map, object)} apply makes a change in a map.
   * @param {number} limit changes that are kept; before the oldest one the map is as it was then.
   */
  constructor(apply, limit = LIMIT) {
    this.apply = apply;
    this.limit = limit;
    this.times = [];
    this.changes = [];
    this.checkpoints = [{ count: 0, map: new Map() }];
    this.newest = new Map();
    this.shown = { count: 0, map: new Map() };
  }

  add(t, change) {
    const last = this.times[this.times.length - 1] ?? -Infinity, { length } = this.checkpoints;
    this.times.push(Math.max(t, last));
    this.changes.push(change);
    this.apply(this.newest, change);
    const passed = this.changes.length - this.checkpoints[length - 1].count;
    if (passed >= Math.max(LEAST, 2 * this.newest.size)) {
      this.checkpoints.push({ count: this.changes.length, map: new Map(this.newest) });
    }
    if (this.changes.length > 1.25 * this.limit) this.drop(this.changes.length - this.limit);
  }

  /** Drop the first `count` changes. */
  drop(count) {
    const map = new Map(this.mapAfter(count));
    this.times.splice(0, count);
    this.changes.splice(0, count);
    const later = this.checkpoints.filter((each) => each.count > count);
    this.checkpoints = [{ count: 0, map }, ...later.map((each) => ({ count: each.count - count, map: each.map }))];
    this.shown = { count: 0, map: new Map(map) };
  }

  /** Number of changes up to time `t`: the map is the same as long as this is. */
  countAt(t) { return indexAt(this.times, t) + 1; }

  /** The map at time `t`, to be read only. */
  at(t) {
    const count = this.countAt(t);
    return count === this.changes.length ? this.newest : this.mapAfter(count);
  }

  mapAfter(count) {
    const start = this.checkpointBefore(count);
    // Playing on is cheaper from where the last question was.
    if (this.shown.count > count || this.shown.count < start.count) this.shown = { count: start.count, map: new Map(start.map) };
    for (; this.shown.count < count; this.shown.count++) this.apply(this.shown.map, this.changes[this.shown.count]);
    return this.shown.map;
  }

  checkpointBefore(count) {
    let low = 0, high = this.checkpoints.length;
    while (low < high) {
      const middle = (low + high) >> 1;
      if (this.checkpoints[middle].count <= count) low = middle + 1; else high = middle;
    }
    return this.checkpoints[low - 1];
  }

  /** The changes after time `from`, up to time `to`, oldest first. */
  between(from, to) { return this.changes.slice(indexAt(this.times, from) + 1, this.countAt(to)); }
}
