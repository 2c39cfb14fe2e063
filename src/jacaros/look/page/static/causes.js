import { Track } from "./track.js";

const LONGEST = 2000;  // links of a chain: rounds of a loop are folded where it is shown
const MOST = 120;  // effects that are shown
const LIMIT = 80000;  // links that are kept: a live page may be open for days

/** The links between what happened: by id, back to what led to one, and forward to what it led to. */
export class Causes {
  constructor() {
    this.links = new Map();
    this.effects = new Map();  // by id: the ids of the links that it led to directly
    this.order = new Track(LIMIT);  // the ids in the order in which the links came
  }

  add(t, event, data) {
    if (event === "cause") this.link({ ...data, t: data.at ?? t });
    else if (event === "deliberation") this.link({ ...data, kind: "event", what: data.trigger, t });
    else if (event === "operation") this.endOperation(t, data);
    else if (event === "message" && data.state === "sent") this.addMessage(t, data);
    else if (event === "belief" && data.cause) this.addBelief(t, data);
  }

  link(link) {
    const known = this.links.get(link.id);
    if (known) {
      // An event is described by two records, an operation too: the later one adds to the first.
      Object.assign(known, { ...link, t: Math.min(known.t, link.t), parent: link.parent || known.parent });
      return;
    }
    this.links.set(link.id, link);
    if (link.parent) {
      if (!this.effects.has(link.parent)) this.effects.set(link.parent, []);
      this.effects.get(link.parent).push(link.id);
    }
    for (const id of this.order.add(Math.max(link.t, this.order.times.at(-1) ?? 0), link.id)) {
      this.links.delete(id);
      this.effects.delete(id);
    }
  }

  endOperation(t, data) {
    if (!data.id) return;
    const { id, artifact, operation, agent, cause } = data;
    if (!this.links.has(id)) this.link({ id, parent: cause, kind: "operation", what: operation, artifact, agent, t });
    const link = this.links.get(id);
    link.call = operation;
    if (data.state !== "began") Object.assign(link, { outcome: data.state, reason: data.reason, ended: t });
  }

  addMessage(t, data) {
    if (!data.id || this.links.has(data.id)) return;
    this.link({ ...data, parent: data.cause ?? 0, kind: "message", what: `${data.performative} ${data.content}`, t });
  }

  addBelief(t, { agent, op, belief, cause }) {
    const link = this.links.get(cause);
    if (!link) return;
    link.beliefs = [...(link.beliefs ?? []).slice(-7), { t, agent, op, belief }];
  }

  /** The id of the link of a step that only changed a belief, which no record has; `parent` is the event of its plan. */
  ofStep(step) {
    const id = `${step.agent} ${step.file}:${step.line} ${step.t}`;
    if (!this.links.has(id)) this.links.set(id, { ...step, id, kind: "act" });
    return id;
  }

  get(id) { return this.links.get(id); }

  /** What led to a link, the link itself first, back to the first known cause. */
  chain(id) {
    const chain = [], seen = new Set();
    for (let link = this.links.get(id); link && !seen.has(link.id) && chain.length < LONGEST; link = this.links.get(link.parent)) {
      seen.add(link.id);
      chain.push(link);
    }
    return chain;
  }

  /** What a link led to up to time `t`, and what that led to: link and depth (1: directly), in the order of a tree. */
  forward(id, t = Infinity) {
    const found = [], open = [...(this.effects.get(id) ?? [])].reverse().map((each) => [each, 1]), seen = new Set([id]);
    while (open.length && found.length < MOST) {
      const [next, depth] = open.pop(), link = this.links.get(next);
      if (!link || seen.has(next) || link.t > t) continue;
      seen.add(next);
      found.push({ link, depth });
      for (const each of [...(this.effects.get(next) ?? [])].reverse()) open.push([each, depth + 1]);
    }
    return found;
  }

  /** The last links up to time `t` that `fits` accepts, the newest first. */
  last(t, count, fits) {
    const found = [];
    for (let i = this.order.countAt(t) - 1; i >= 0 && found.length < count; i--) {
      const link = this.links.get(this.order.values[i]);
      if (fits(link)) found.push(link);
    }
    return found;
  }
}
