import { indexAt } from "./track.js";

const LIMIT = 250000;  // bars of one row that are kept: a live page may be open for days

/** The kinds of bars. The number of one is its place among sums. */
export const KIND = { runs: 0, acts: 1, waits: 2, suspended: 3, done: 4, handled: 5, failed: 6, refused: 7 };
const KINDS = 8;

/**
 * A row of bars in the order of time. The last bar may be open: its end is infinite.
 *
 * `sums` has for each bar what each kind took before it, in seconds (of bars without a length: how many there were), so bars of
 * any number are merged in one step. Open bars do not count.
 */
export class Bars {
  /** @param {boolean} isCounted the bars have no length: sums say how many there are, not how long they took. */
  constructor(isCounted = false, limit = LIMIT) {
    Object.assign(this, { isCounted, limit, starts: [], ends: [], kinds: [], whats: [], sums: new Array(KINDS).fill(0) });
  }

  get count() { return this.starts.length; }

  get isOpen() { return this.ends.at(-1) === Infinity; }

  /** Whether one of its bars counts. */
  get lasts() { return this.isOpen || this.sums.slice(-KINDS).some((sum) => sum > 0); }

  /** Begin a bar at `t`; it ends one that is open. */
  begin(t, kind, what) {
    this.end(t);
    this.push(Math.max(t, this.ends.at(-1) ?? 0), Infinity, kind, what);
  }

  /** End the open bar, as one of this kind. */
  end(t, kind = this.kinds.at(-1)) {
    if (!this.isOpen) return;
    const last = this.count - 1;
    this.ends[last] = Math.max(t, this.starts[last]);
    this.kinds[last] = kind;
    this.add(this.isCounted ? 1 : this.ends[last] - this.starts[last]);
  }

  /** Add a bar without a length. */
  mark(t, kind, what) {
    this.push(t, t, kind, what);
    this.add(1);
  }

  /** Make the newest bar, which is a mark, one of another kind. */
  recast(kind) {
    this.add(-1);
    this.kinds[this.count - 1] = kind;
    this.add(1);
  }

  push(start, end, kind, what) {
    const { starts, ends, kinds, whats, sums } = this;
    if (this.count > 1.25 * this.limit) this.drop(this.count - this.limit);
    starts.push(start);
    ends.push(end);
    kinds.push(kind);
    whats.push(what);
    for (let kind = 0; kind < KINDS; kind++) sums.push(sums[sums.length - KINDS]);
  }

  drop(count) {
    for (const list of [this.starts, this.ends, this.kinds, this.whats]) list.splice(0, count);
    this.sums.splice(0, count * KINDS);
  }

  /** Count the newest bar. */
  add(amount) { this.sums[this.count * KINDS + this.kinds.at(-1)] += amount; }

  /** Call `take(first, end, sums)` for the bars of a range, in order; those that fit into `grain` seconds come together. */
  each(from, to, grain, take) {
    const { starts, ends, sums } = this, stop = firstAbove(starts, to), own = new Float64Array(KINDS);
    for (let first = firstAbove(ends, from - grain), end; first < stop; first = end) {
      end = Math.max(first + 1, Math.min(stop, firstAbove(ends, starts[first] + grain)));
      for (let kind = 0; kind < KINDS; kind++) own[kind] = sums[end * KINDS + kind] - sums[first * KINDS + kind];
      take(first, end, own);
    }
  }

  /** Index of the bar at `t`, or of one that is at most `near` seconds away; -1 for none. */
  at(t, near) {
    const index = Math.max(0, firstAbove(this.starts, t) - 1), { starts, ends } = this;
    const distance = (i) => (i < this.count ? Math.max(0, starts[i] - t, t - ends[i]) : Infinity);
    const best = distance(index + 1) < distance(index) ? index + 1 : index;
    return distance(best) <= near ? best : -1;
  }
}

/** Index of the first of the sorted `values` that is above `limit`. */
function firstAbove(values, limit) { return indexAt(values, limit) + 1; }
