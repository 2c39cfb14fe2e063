import { indexAt } from "./track.js";

const OPEN = new Set(["pursued", "suspended"]);

/** What agents pursue, over time. */
export class Goals {
  constructor() {
    this.times = [];
    this.events = [];
  }

  add(t, event, data) {
    if (event !== "goal") return;
    this.times.push(t);
    this.events.push({ ...data, t });
  }

  countAt(t) { return indexAt(this.times, t) + 1; }

  /** The goals of every agent after the first `count` events, oldest first. */
  after(count) {
    const goals = new Map();
    for (const { t, agent, goal, state, id, intention, why } of this.events.slice(0, count)) {
      const key = `${agent}/${id ?? goal}`, known = goals.get(key);
      if (state === "pursued" || !known) {
        goals.delete(key);
        goals.set(key, { agent, goal, state, since: t, intention });
      } else Object.assign(known, { state: state === "resumed" ? "pursued" : state, since: t, why });
    }
    return [...goals.values()].map((goal) => ({ ...goal, isOpen: OPEN.has(goal.state) }));
  }
}
