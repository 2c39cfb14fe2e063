import { Failures } from "./failures.js";
import { Bars, KIND } from "./lanes_bars.js";

const DEEPEST = 12;  // goals of a stack that have bars
const TRIGGERS = 500;  // newest deliberations of an agent that are kept
const OUTCOMES = new Set(["achieved", "failed", "recovered", "dropped", "replaced"]);

/**
 * What took time, as bars: intentions of agents with their goals, operations of artifacts, and owners of resources.
 *
 * `agents`, `artifacts` and `resources` are lanes by name.
 */
export class Lanes {
  constructor() {
    Object.assign(this, { agents: new Map(), artifacts: new Map(), resources: new Map(), operations: new Map(), version: 0 });
  }

  add(t, event, data) {
    if (!TAKE[event]) return;
    TAKE[event](this, t, data);
    this.version += 1;
  }

  agent(name) { return known(this.agents, name, () => new AgentLane(name)); }

  /** Who has a resource at `t`, in words; "" for no agent. Of robots with the same resource it is that of the one which `agent` uses. */
  owner(resource, t, agent) {
    const found = [...this.resources.values()].filter(({ name }) => name.split("/").at(-1) === resource);
    const { bars } = found.find((each) => each.bars.whats.some((what) => what.agent === agent)) ?? found[0] ?? {}, index = bars?.at(t, 0) ?? -1;
    return index < 0 ? "" : bars.whats[index].holder;
  }
}

const TAKE = {
  agent(lanes, t, { agent, state }) { if (state === "ended") lanes.agent(agent).close(t); else lanes.agent(agent); },
  goal(lanes, t, data) { lanes.agent(data.agent).goal(t, { ...data, goal: String(data.goal) }); },
  intention(lanes, t, data) { lanes.agent(data.agent).intention(t, data); },
  deliberation(lanes, t, data) { lanes.agent(data.agent).deliberation(t, data); },
  operation(lanes, t, data) {
    if (data.state !== "began") {
      const { what, places = [] } = lanes.operations.get(data.id) ?? {};
      lanes.operations.delete(data.id);
      if (what) Object.assign(what, { to: t, outcome: data.state, why: data.reason });
      for (const bars of places) bars.end(t, data.state !== "failed" ? KIND.done : data.reason === "cancelled" ? KIND.suspended : KIND.failed);
      return;
    }
    const what = { ...data, from: t }, places = [known(lanes.artifacts, data.artifact, () => new Rows(data.artifact)).free()];
    if (data.agent) places.push(lanes.agent(data.agent).actions.free());
    for (const bars of places) bars.begin(t, KIND.acts, what);
    lanes.operations.set(data.id, { what, places });
  },
  resource(lanes, t, { resource, holder }) {
    const { bars } = known(lanes.resources, resource, () => ({ name: resource, bars: new Bars() }));
    bars.end(t);
    if (holder) bars.begin(t, KIND.acts, { resource, holder, agent: /^\[(.*?)\]/.exec(holder)?.[1] });
  },
  ended(lanes, t) { for (const lane of lanes.agents.values()) lane.close(t); },
};

/** Rows of bars that may overlap: one that begins takes the first row without an open one. */
class Rows {
  constructor(name) { Object.assign(this, { name, rows: [] }); }

  /** Whether one of its bars has a length. */
  get lasts() { return this.rows.some(({ lasts }) => lasts); }

  free() {
    const found = this.rows.find((each) => !each.isOpen) ?? new Bars();
    if (!this.rows.includes(found)) this.rows.push(found);
    return found;
  }
}

/** An agent: each intention in one of `slots`, a row of its states and one for each level of its stack of goals. */
class AgentLane {
  constructor(name) {
    Object.assign(this, { name, slots: [], open: new Map(), actions: new Rows("actions"), refusals: new Bars(true), refused: new Map(), triggers: new Map(), failures: new Failures() });
  }

  deliberation(t, { id, trigger, intention, parent, chosen, options }) {
    this.triggers.set(id, trigger);
    if (this.triggers.size > TRIGGERS) this.triggers.delete(this.triggers.keys().next().value);
    // The records of a goal say neither its cause nor the event in whose plan it is.
    this.latest = { id, trigger, event: intention === null || intention === undefined ? undefined : this.triggers.get(parent) };
    for (const { plan, why } of options ?? []) {
      if (!why) continue;
      this.refused.set(plan, (this.refused.get(plan) ?? 0) + 1);
      this.refusals.mark(t, chosen === null && trigger.startsWith("+!") ? KIND.refused : KIND.waits, { agent: this.name, plan, why, cause: id });
    }
  }

  goal(t, data) {
    const { id, goal, state, intention, why } = data, key = intention ?? `goal ${id}`, mine = this.open.get(key), failure = this.failures.add(t, data);
    if (failure?.handled) failure.marks?.recast(KIND.handled);
    if (state === "pursued") this.pursue(t, key, { id, goal });
    else if (!mine) return;
    else if (OUTCOMES.has(state)) this.finish(t, key, id, state, why, failure);
    else mine.set(t, state === "suspended" ? KIND.suspended : KIND.runs, "");
  }

  pursue(t, key, { id, goal }) {
    const { latest } = this, isDecided = latest?.trigger === `+${goal}`;
    const mine = this.open.get(key) ?? this.begin(t, key, ((isDecided && latest.event) || goal).replace(/^\+!/, "!"));
    mine.push(t, { agent: this.name, intention: key, id, goal, cause: isDecided ? latest.id : undefined });
  }

  begin(t, key, goal) {
    const slot = this.slots.find((each) => !each.isTaken) ?? new Slot();
    if (!this.slots.includes(slot)) this.slots.push(slot);
    const made = slot.take(t, { agent: this.name, intention: key, goal, from: t, isEvent: /^[+-]/.test(goal) });
    this.open.set(key, made);
    return made;
  }

  finish(t, key, id, state, why, failure) {
    const mine = this.open.get(key), isLowest = mine.goals[0]?.id === id, goal = mine.pop(t, id, state, why);
    if (failure && goal) this.fail(t, goal, mine.failures, failure);
    if (mine.root.isEvent ? !mine.goals.length && !mine.isSeen : isLowest) this.over(t, key, state, why);
  }

  /** Mark a failure. Goals that fail together have one mark, that of the lowest. */
  fail(t, { cause }, marks, failure) {
    if (!failure.marks) marks.mark(t, KIND.failed, failure);
    Object.assign(failure, { cause, marks: failure.marks ?? marks });
  }

  over(t, key, state, why) {
    this.open.get(key).end(t, state, why);
    this.open.delete(key);
  }

  intention(t, { id, state, stack, waits, since, reason, cause }) {
    if (state === "over") {
      if (this.open.has(id)) this.over(t, id, "over");
      return;
    }
    const lowest = stack?.[0]?.goal ?? "", mine = this.open.get(id) ?? this.begin(Math.min(t, since || t), id, lowest);
    mine.isSeen = true;
    if (lowest && !lowest.startsWith("!")) Object.assign(mine.root, { goal: lowest, isEvent: true });
    mine.root.cause ??= cause || undefined;
    if (state === "suspended") mine.set(t, KIND.suspended, reason === "suspend_ia" ? "" : reason);
    else if (state === "waits") mine.set(Math.min(t, since || t), waits?.startsWith("the action ") ? KIND.acts : KIND.waits, waits);
    else mine.set(t, KIND.runs, "");
  }

  close(t) { for (const key of [...this.open.keys()]) this.over(t, key, "dropped"); }
}

/** The rows of one intention at a time. */
class Slot {
  constructor() { Object.assign(this, { states: new Bars(), failures: new Bars(true), levels: [], goals: [], isTaken: false }); }

  take(t, root) {
    Object.assign(this, { isTaken: true, isSeen: false, root, goals: [] });
    this.states.begin(t, KIND.runs, { root, words: "" });
    return this;
  }

  set(t, kind, words) {
    const { states, root } = this, last = states.whats.at(-1), isSame = last.words === words && (kind === KIND.suspended || t <= states.starts.at(-1));
    if (states.kinds.at(-1) === kind && (isSame || !last.words || !words)) last.words ||= words;
    else states.begin(t, kind, { root, words });
  }

  push(t, goal) {
    const depth = this.goals.push(goal) - (this.root.isEvent ? 1 : 2);
    goal.from = t;
    if (depth < 0) this.root.cause ??= goal.cause;  // the bar of the intention is that of its goal
    else if (depth < DEEPEST) (this.levels[depth] ??= new Bars()).begin(t, KIND.runs, goal);
  }

  pop(t, id, outcome, why) {
    const index = this.goals.findIndex((each) => each.id === id);
    if (index < 0) return undefined;
    const [goal] = this.goals.splice(index, 1), bars = this.levels.find((each) => each.whats.at(-1) === goal);
    Object.assign(goal, { to: t, outcome, why });
    bars?.end(t, outcome === "failed" && why ? KIND.failed : outcome === "dropped" ? KIND.suspended : KIND.done);
    return goal;
  }

  end(t, outcome, why) {
    for (const goal of [...this.goals]) this.pop(t, goal.id, outcome, why);
    Object.assign(this.root, { to: t, outcome, why });
    this.states.end(t);
    this.isTaken = false;
  }
}

function known(map, key, make) {
  if (!map.has(key)) map.set(key, make());
  return map.get(key);
}
