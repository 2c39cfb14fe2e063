import { Track, indexAt } from "./track.js";

const LIMIT = 5000;  // failures of an agent that are kept
const REFUSED = "refused, ";  // by the plan: the caller knows, and nothing was lost
const LABEL = /^\w+, (?=\S)/, PLACE = / \(\S+:\d+\)$/;
const SAID = /^(?:action|operation) \S+ .*?(?:was aborted|failed)(?: with code -?\d+)?: /;

/** Failures of goals: those of one intention at one moment are one failure, which a plan may handle. */
export class Failures {
  constructor() {
    this.agents = new Map();  // by name: a track of failures
    this.newest = new Map();  // by intention: the failure that may still be handled
  }

  /** Take a record of a goal; returns the failure that it adds to, or handles: t, agent, intention, goal (the outermost), why, handled. */
  add(t, { agent, goal, state, id, intention, why }) {
    const key = `${agent} ${intention ?? `goal ${id}`}`, known = this.newest.get(key);
    if (state === "failed") {
      if (!why) return null;  // a behaviour of a tree
      const failure = known?.t === t ? known : { t, agent, intention, ids: new Set(), handled: String(why).startsWith(REFUSED) };
      Object.assign(failure, { goal, why: String(why) }).ids.add(id);
      if (failure !== known) this.of(agent).add(t, failure);
      this.newest.set(key, failure);
      return failure;
    }
    // A goal with a plan for its failure is pursued again.
    this.newest.delete(key);
    if (!known?.ids.has(id) || (state !== "pursued" && state !== "recovered")) return null;
    known.handled = true;
    return known;
  }

  of(agent) {
    if (!this.agents.has(agent)) this.agents.set(agent, new Track(LIMIT));
    return this.agents.get(agent);
  }

  /** The last failure of an agent up to time `t` that no plan handled; undefined without one. */
  lost(agent, t) {
    const { times, values } = this.of(agent);
    let last = indexAt(times, t);
    while (values[last]?.handled) last -= 1;
    return values[last];
  }
}

/** Why a goal failed in its shortest words: without the name of the error, the action and the place. */
export function reasonOf(why) { return why.split("\n")[0].replace(PLACE, "").replace(LABEL, "").replace(SAID, ""); }
