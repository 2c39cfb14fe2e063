import { clock, element } from "./elements.js";

const ALIKE = 2;  // open goals with one signature that are shown: a recursive plan leaves one behind in each round
const PAST = 3;

/** The goals of the agents: the open ones of each intention, and the last that are over. */
export class GoalsView {
  constructor(root, context, goals) {
    this.root = root;
    this.goals = goals;
    this.shown = -1;
  }

  get empty() { return this.goals.events.length === 0; }

  show(t) {
    const count = this.goals.countAt(t);
    if (count === this.shown) return;
    this.shown = count;
    const all = this.goals.after(count);
    const past = all.filter((goal) => !goal.isOpen).sort((a, b) => b.since - a.since).slice(0, PAST);
    this.root.replaceChildren();
    for (const agent of new Set(all.map((goal) => goal.agent))) {
      this.root.append(element("h3", "", agent), ...this.lists(all, past, (goal) => goal.agent === agent));
    }
    if (!all.length) this.root.append(element("p", "empty", "Nothing yet."));
  }

  lists(all, past, own) {
    const stacks = intentions(all.filter((goal) => own(goal) && goal.isOpen)).map((stack) =>
      // The current goal comes first, below it those that it serves.
      element("ul", "intention", ...newest(stack).reverse().map((goal) => item(goal))));
    // Goals that served one another failed for one reason: it appears once, below the last of them.
    const over = past.filter(own).map((goal, n, goals) => item(goal, goals[n + 1]?.why !== goal.why));
    return [...stacks, element("ul", "", ...over)];
  }
}

/** The open goals of an agent by intention, the one that changed last first. */
function intentions(goals) {
  const stacks = new Map();
  for (const goal of goals) {
    const stack = stacks.get(goal.intention) ?? [];
    stacks.delete(goal.intention);
    stacks.set(goal.intention, [...stack, goal]);
  }
  return [...stacks.values()].reverse();
}

/** Of goals with one signature the newest, the oldest of which knows how many were `left` out. */
function newest(goals) {
  const alike = new Map(), kept = [];
  for (const goal of [...goals].reverse()) {
    const key = signature(goal.goal), same = alike.get(key) ?? [];
    alike.set(key, same);
    same.push(goal);
    if (same.length <= ALIKE) kept.unshift(goal);
  }
  for (const same of alike.values()) if (same.length > ALIKE) same[ALIKE - 1].left = same.length - ALIKE;
  return kept;
}

/** Name and number of arguments of a goal. */
function signature(goal) {
  let depth = 0, count = 0, quoted = false;
  for (const c of goal) {
    if (c === '"') quoted = !quoted;
    if (quoted) continue;
    if ("([{".includes(c)) depth += 1;
    else if (")]}".includes(c)) depth -= 1;
    if ((c === "(" || c === ",") && depth === 1) count += 1;
  }
  return `${goal.split("(")[0]}/${count}`;
}

function item(goal, reasoned = false) {
  const text = element("span", "", goal.goal);
  if (goal.left) text.append(element("span", "left", `  and ${goal.left} before it`));
  const state = goal.state === "pursued" ? `since ${clock(goal.since)}` : `${goal.state} ${clock(goal.since)}`;
  const made = element("li", `${goal.state}${goal.isOpen ? "" : " past"}`, element("i"), text, element("span", "state", state));
  if (goal.why && reasoned) made.append(reason(goal.why));
  return made;
}

/** Why a goal failed: error and place first; the step and the terms unfold. */
function reason(why) {
  const [first, ...rest] = why.split("\n");
  if (!rest.length) return element("span", "why", first);
  return element("details", "why", element("summary", "", first), element("span", "", rest.join("\n")));
}
