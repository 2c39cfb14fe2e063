import { indexAt } from "./track.js";

/** How often the plans of an agent were chosen and refused, up to any moment. */
export class PlanUse {
  constructor() {
    this.plans = new Map();  // by plan: chosen and refused, in the order of time
    this.times = [];
  }

  /** Number of deliberations up to time `t`. */
  countAt(t) { return indexAt(this.times, t) + 1; }

  /** Count a deliberation. */
  add(t, { id, trigger, chosen, options = [] }) {
    this.times.push(t);
    if (chosen !== null && chosen !== undefined) {
      const plan = this.of(chosen);
      plan.chosenTimes.push(t);
      plan.chosen.push({ t, id, trigger });
    }
    for (const option of options) {
      const plan = this.of(option.plan);
      plan.refusedTimes.push(t);
      plan.refused.push({ t, id, trigger, why: option.why });
    }
  }

  of(plan) {
    if (!this.plans.has(plan)) this.plans.set(plan, { chosenTimes: [], chosen: [], refusedTimes: [], refused: [] });
    return this.plans.get(plan);
  }

  /** How often a plan was chosen up to time `t`. */
  chosen(plan, t) { return indexAt(this.plans.get(plan)?.chosenTimes ?? [], t) + 1; }

  /** How often a plan was refused up to time `t`. */
  refused(plan, t) { return indexAt(this.plans.get(plan)?.refusedTimes ?? [], t) + 1; }

  /** The last choice of a plan up to time `t`: t, id, trigger. */
  lastChoice(plan, t) { return this.plans.get(plan)?.chosen[this.chosen(plan, t) - 1]; }

  /** The reasons for which a plan was refused up to time `t`, the newest first, with how often: why, count, last. */
  reasons(plan, t, most = 6) {
    const reasons = new Map(), all = this.plans.get(plan)?.refused ?? [];
    for (let i = this.refused(plan, t) - 1; i >= 0; i--) {
      const known = reasons.get(all[i].why);
      if (known) known.count += 1;
      else if (reasons.size < most) reasons.set(all[i].why, { why: all[i].why, count: 1, last: all[i] });
    }
    return [...reasons.values()];
  }
}
