import { Fold } from "./fold.js";
import { PlanUse } from "./plan_use.js";
import { Track } from "./track.js";

const RECENT = 2;  // seconds during which a change of a belief is a recent one
const DECISIONS = 20000;  // moments of deliberations that are kept
const OPEN = new Set(["pursued", "suspended"]);

/** One agent over time: intentions, goals, beliefs, rules, mailbox, plans, and the lines that ran. */
export class Mind {
  constructor(name) {
    this.name = name;
    this.what = "";
    this.states = new Track();
    this.programs = new Track();
    this.plans = new Map();  // by id, of all its programs
    this.beliefs = new Fold(changeBelief);
    this.intentions = new Fold(changeIntention);
    this.goals = new Fold(changeGoal);
    this.mailbox = new Fold(changeMailbox);
    this.use = new PlanUse();
    this.decided = new Track(DECISIONS);
    this.ran = new Map();  // by file: the moments at which lines ran first
  }

  add(t, event, data) { TAKE[event]?.(this, t, data); }

  plan(id) { return this.plans.get(id); }

  /** Plans and rules at time `t`. */
  program(t) { return this.programs.at(t) ?? this.programs.values[0] ?? { plans: [], rules: [] }; }

  /** Whether the agent runs at time `t`; one without a record of its end does. */
  runsAt(t) { return this.states.at(t) !== "ended"; }

  /** A number that is the same as long as nothing that a summary of the agent shows has changed. */
  stamp(t) { return `${this.intentions.countAt(t)} ${this.goals.countAt(t)} ${this.states.at(t) ?? ""}`; }

  /**
   * The intentions at time `t`, the one that changed last first: id, state, stack, waits, since, reason, urgency, cause.
   *
   * Agents that only report goals, such as those in Python, have their open goals as stacks.
   */
  intentionsAt(t) {
    const known = [...this.intentions.at(t).values()];
    if (this.intentions.changes.length) return known.reverse();
    const stacks = new Map();
    for (const goal of this.goals.at(t).values()) {
      if (!OPEN.has(goal.state)) continue;
      const key = goal.intention ?? `goal ${goal.id}`, stack = stacks.get(key) ?? [];
      stacks.delete(key);
      stacks.set(key, [...stack, goal]);
    }
    return [...stacks].map(([id, goals]) => fromGoals(id, goals)).reverse();
  }

  /** The last `count` goals that were over at time `t`, the newest first. */
  pastGoals(t, count) {
    const over = [];
    for (let i = this.goals.countAt(t) - 1; i >= 0 && over.length < count; i--) {
      if (!OPEN.has(this.goals.changes[i].state) && this.goals.changes[i].state !== "resumed") over.push(this.goals.changes[i]);
    }
    // Those of one moment failed from the top of their stack down.
    return over.reverse().sort((a, b) => b.t - a.t);
  }

  /** The beliefs at time `t`, sorted: belief, since, and what changed it (`cause`, or `file` and `line`). */
  beliefsAt(t) { return [...this.beliefs.at(t).values()].sort((a, b) => (a.belief < b.belief ? -1 : 1)); }

  /** Beliefs that went within the last two seconds and did not come back. */
  beliefsGone(t) {
    const held = this.beliefs.at(t), gone = new Map();
    for (const change of this.beliefs.between(t - RECENT, t)) {
      if (change.op === "-" && !held.has(change.belief)) gone.set(change.belief, change);
    }
    return [...gone.values()];
  }

  /** Whether a belief is a recent one at time `t`; initial ones are not. */
  isRecent(belief, t) { return belief.since > 0 && belief.since > t - RECENT; }

  /** Messages that wait to be read at time `t`, the oldest first. */
  mailboxAt(t) { return [...this.mailbox.at(t).values()]; }

  /** Number of deliberations up to time `t`. */
  decisionsAt(t) { return this.decided.countAt(t); }

  runLine(t, file, line) {
    if (!file || !line) return;
    if (!this.ran.has(file)) this.ran.set(file, new Map());
    const lines = this.ran.get(file);
    if (!lines.has(line)) lines.set(line, t);
  }
}

const TAKE = {
  agent(mind, t, { what, state }) {
    mind.what = what ?? mind.what;
    mind.states.add(t, state);
  },
  program(mind, t, { plans = [], rules = [] }) {
    mind.programs.add(t, { plans, rules });
    for (const plan of plans) mind.plans.set(plan.id, plan);
  },
  belief(mind, t, data) {
    mind.beliefs.add(t, { ...data, belief: String(data.belief), t });
    mind.runLine(t, data.file, data.line);
  },
  goal(mind, t, data) { mind.goals.add(t, { ...data, goal: String(data.goal), why: data.why ? String(data.why) : "", t }); },
  intention(mind, t, data) {
    for (const { file, line } of data.stack ?? []) mind.runLine(t, file, line);
    mind.intentions.add(t, data);
  },
  message(mind, t, data) { mind.mailbox.add(t, { ...data, t }); },
  deliberation(mind, t, data) {
    mind.decided.add(t, data.id);
    mind.use.add(t, data);
    const plan = mind.plan(data.chosen);
    if (plan) mind.runLine(t, plan.file, plan.line);
  },
  cause(mind, t, data) { if (data.kind === "act") mind.runLine(t, data.file, data.line); },
};

function changeBelief(beliefs, { op, belief, t, ...by }) {
  // Another belief with the same functor that comes replaces nothing: the record says `-` for the old one.
  if (op === "-") beliefs.delete(belief);
  else beliefs.set(belief, { ...by, belief, since: t });
}

function changeIntention(intentions, data) {
  intentions.delete(data.id);
  if (data.state !== "over") intentions.set(data.id, data);
}

function changeGoal(goals, { t, state, ...data }) {
  const key = data.id ?? data.goal, known = goals.get(key);
  if (!OPEN.has(state) && state !== "resumed") goals.delete(key);
  else if (state === "pursued" || !known) {
    goals.delete(key);
    goals.set(key, { ...data, state: state === "resumed" ? "pursued" : state, since: t });
  } else goals.set(key, { ...known, ...data, state: state === "resumed" ? "pursued" : state });
}

function changeMailbox(messages, { t, state, ...data }) {
  if (state === "read") messages.delete(data.id);
  else messages.set(data.id, { ...data, since: t });
}

function fromGoals(id, goals) {
  const top = goals[goals.length - 1];
  return {
    id, state: top.state === "suspended" ? "suspended" : "runs", since: top.since, waits: "", reason: "", urgency: 0,
    stack: goals.map(({ goal }) => ({ goal, step: "" })),
  };
}
