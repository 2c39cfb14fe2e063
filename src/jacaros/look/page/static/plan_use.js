import { indexAt } from "./track.js";

const LIMIT = 5000;  // choices and refusals of one plan that are kept; earlier ones are counted only

/** How often the plans of an agent were chosen and refused, up to any moment. */
export class PlanUse {
  constructor() {
    this.plans = new Map();  // by plan: chosen and refused
    this.count = 0;  // of deliberations
  }

  /** Count a deliberation. */
  add(t, { id, trigger, chosen, options = [] }) {
    this.count += 1;
    if (chosen !== null && chosen !== undefined) this.of(chosen).chosen.add(t, { t, id, trigger });
    for (const option of options) this.of(option.plan).refused.add(t, { t, id, trigger, why: option.why });
  }

  of(plan) {
    if (!this.plans.has(plan)) this.plans.set(plan, { chosen: new Counted(), refused: new Counted() });
    return this.plans.get(plan);
  }

  /** How often a plan was chosen up to time `t`. */
  chosen(plan, t) { return this.plans.get(plan)?.chosen.countAt(t) ?? 0; }

  /** How often a plan was refused up to time `t`. */
  refused(plan, t) { return this.plans.get(plan)?.refused.countAt(t) ?? 0; }

  /** The last choice of a plan up to time `t`: t, id, trigger. */
  lastChoice(plan, t) { return this.plans.get(plan)?.chosen.upTo(t).at(-1); }

  /** The reasons for which a plan was refused up to time `t`, the newest first, with how often: why, count, last. */
  reasons(plan, t, most = 6) {
    const reasons = new Map(), all = this.plans.get(plan)?.refused.upTo(t) ?? [];
    for (const each of all.reverse()) {
      const known = reasons.get(each.why);
      if (known) known.count += 1;
      else if (reasons.size < most) reasons.set(each.why, { why: each.why, count: 1, last: each });
    }
    return [...reasons.values()];
  }
}

/** Things in the order of time: the newest are kept, all are counted. */
class Counted {
  constructor() {
    this.times = [];
    this.all = [];
    this.dropped = 0;
  }

  add(t, each) {
    this.times.push(t);
    this.all.push(each);
    if (this.all.length <= LIMIT) return;
    this.dropped += LIMIT >> 2;
    this.times.splice(0, LIMIT >> 2);
    this.all.splice(0, LIMIT >> 2);
  }

  countAt(t) { return this.dropped + indexAt(this.times, t) + 1; }
  upTo(t) { return this.all.slice(0, indexAt(this.times, t) + 1); }
}
