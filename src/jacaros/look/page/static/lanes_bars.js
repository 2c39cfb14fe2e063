import { indexAt } from "./track.js";

const FAN = 8;  // bars, or nodes, below one node
const LIMIT = 250000;  // bars of one row that are kept: a live page may be open for days

/** The kinds of bars. The number of one is its place among the `sums` of a node. */
export const KIND = { runs: 0, acts: 1, waits: 2, suspended: 3, done: 4, handled: 5, failed: 6, refused: 7 };
const KINDS = 8, LEVELS = 6;

/**
 * A row of bars in the order of time.
 *
 * Nodes above them hold how many seconds each kind took (of bars without a length: how many there are), so a range of any
 * length is drawn from a few thousand of them. The last bar may be open: its end is infinite, and no node counts it.
 */
export class Bars {
  /** @param {boolean} isCounted the bars have no length: a node says how many there are, not how long they took. */
  constructor(isCounted = false, limit = LIMIT) {
    Object.assign(this, { isCounted, limit, total: 0 });
    this.clear();
  }

  clear() { Object.assign(this, { starts: [], ends: [], kinds: [], whats: [], levels: Array.from({ length: LEVELS }, () => []) }); }

  get count() { return this.starts.length; }

  get isOpen() { return this.count > 0 && this.ends.at(-1) === Infinity; }

  /** Begin a bar at `t`; it ends one that is open. */
  begin(t, kind, what) {
    this.end(t);
    if (this.count > 1.25 * this.limit) this.drop(this.count - this.limit);
    this.push(Math.max(t, this.ends.at(-1) ?? 0), Infinity, kind, what);
  }

  /** End the open bar, as one of this kind. */
  end(t, kind = this.kinds.at(-1)) {
    if (!this.isOpen) return;
    const last = this.count - 1;
    this.ends[last] = Math.max(t, this.starts[last]);
    this.kinds[last] = kind;
    this.sum(last, this.weight(last));
  }

  /** Add a bar without a length. */
  mark(t, kind, what) {
    if (this.count > 1.25 * this.limit) this.drop(this.count - this.limit);
    this.push(t, t, kind, what);
    this.sum(this.count - 1, 1);
  }

  weight(index) { return this.isCounted ? 1 : this.ends[index] - this.starts[index]; }

  /** Make the newest bar one of another kind. */
  recast(kind) {
    this.sum(this.count - 1, -1);
    this.kinds[this.count - 1] = kind;
    this.sum(this.count - 1, 1);
  }

  push(start, end, kind, what) {
    this.starts.push(start);
    this.ends.push(end);
    this.kinds.push(kind);
    this.whats.push(what);
  }

  sum(index, amount) {
    let node = index;
    this.total += amount;
    for (const sums of this.levels) {
      node = Math.floor(node / FAN);
      while (sums.length < (node + 1) * KINDS) sums.push(0);
      sums[node * KINDS + this.kinds[index]] += amount;
    }
  }

  drop(count) {
    const { starts, ends, kinds, whats } = this;
    this.clear();
    for (let i = count; i < starts.length; i++) {
      this.push(starts[i], ends[i], kinds[i], whats[i]);
      if (ends[i] !== Infinity) this.sum(this.count - 1, this.weight(this.count - 1));
    }
  }

  /** Call `take(first, end, sums)` for the bars of a range, in order; those that fit into `grain` seconds come together. */
  each(from, to, grain, take) { new Walk(this, firstAbove(this.ends, from - grain), firstAbove(this.starts, to), grain, take).run(); }

  /** Index of the bar at `t`, or of one that is at most `near` seconds away; -1 for none. */
  at(t, near) {
    const index = Math.max(0, firstAbove(this.starts, t) - 1), { starts, ends } = this;
    const distance = (i) => (i < this.count ? Math.max(0, starts[i] - t, t - ends[i]) : Infinity);
    const best = distance(index + 1) < distance(index) ? index + 1 : index;
    return distance(best) <= near ? best : -1;
  }
}

/** One way through the nodes of a row: indices from `first` to `last`, not below nodes that are shorter than `grain`. */
class Walk {
  constructor(bars, first, last, grain, take) {
    Object.assign(this, { bars, first, last, grain, take, begun: -1, ended: -1, sums: new Float64Array(KINDS) });
  }

  run() {
    const size = FAN ** LEVELS;
    for (let node = Math.floor(this.first / size); node * size < this.last; node++) this.visit(node, LEVELS);
    this.emit();
  }

  visit(node, level) {
    const { bars, first, last } = this, size = FAN ** level, start = node * size, end = Math.min(start + size, bars.count);
    if (end <= first || start >= last) return;
    if (level > 0 && bars.ends[end - 1] - bars.starts[start] >= this.grain) {
      for (let child = 0; child < FAN; child++) this.visit(node * FAN + child, level - 1);
      return;
    }
    if (this.begun >= 0 && bars.ends[end - 1] - bars.starts[this.begun] >= this.grain) this.emit();
    if (this.begun < 0) this.begun = start;
    this.ended = end;
    if (level === 0) this.sums[bars.kinds[start]] += bars.weight(start);
    else for (let kind = 0; kind < KINDS; kind++) this.sums[kind] += bars.levels[level - 1][node * KINDS + kind];
  }

  emit() {
    if (this.begun < 0) return;
    this.take(this.begun, this.ended, this.sums);
    this.begun = -1;
    this.sums.fill(0);
  }
}

/** Index of the first of the sorted `values` that is above `limit`. */
function firstAbove(values, limit) { return indexAt(values, limit) + 1; }
