const LIMIT = 20000;  // runs of refusals that are kept

/** Plans that were refused, again and again, until they were chosen: one entry for each run of refusals. */
export class Refusals {
  constructor() {
    this.all = [];  // agent, plan, from, to, count, why; in the order in which they began
    this.open = new Map();  // by agent and plan
  }

  add(t, event, { agent, chosen, options }) {
    if (event !== "deliberation") return;
    this.open.delete(`${agent} ${chosen}`);
    for (const { plan, why } of options ?? []) if (why) this.refuse(t, agent, plan, why);
  }

  refuse(t, agent, plan, why) {
    const key = `${agent} ${plan}`, known = this.open.get(key);
    if (known) {
      Object.assign(known, { to: t, why, count: known.count + 1 });
      return;
    }
    const run = { agent, plan, why, from: t, to: t, count: 1 };
    this.open.set(key, run);
    this.all.push(run);
    if (this.all.length > LIMIT) this.all.splice(0, LIMIT >> 2);
  }

  /** The runs that overlap the time from `from` to `to`. */
  between(from, to) { return this.all.filter((run) => run.from <= to && run.to >= from); }
}
