import { clock } from "./elements.js";
import { planName, refusalWords, shortName } from "./link_words.js";
import { KIND } from "./lanes_bars.js";
import { duration } from "./section.js";

const STATES = ["running", "acting", "waiting", "suspended"];
const MOST = 3;  // plans of folded refusals that are named

/** The lines that tell about the bars from `first` to `end` of a row of lanes. */
export function barLines({ bars, sort }, first, end, index, { minds, lanes }) {
  const what = bars.whats[first], from = bars.starts[first], to = bars.ends[end - 1];
  if (sort === "messages") return [`${what.from} to ${what.to}: ${what.performative} ${what.content}`, `sent ${clock(from)}, ${to === Infinity ? "not read" : `read ${clock(to)}`}`];
  if (sort === "refusals") return refusals(bars, first, end, index, minds);
  if (sort === "failures") return failures(bars, first, end);
  if (end - first > 1) return [`${end - first} ${sort === "states" ? "states of intentions" : sort}`, span(from, to)];
  if (sort === "resources") return [`${what.resource} is held by ${what.holder}`, span(from, to)];
  if (sort === "states") return [title(what.root), `${STATES[bars.kinds[first]]}${reason(what.words, bars.kinds[first])} ${span(from, to)}`,
    ...owner(what, lanes, to === Infinity ? from + 1 : (from + to) / 2), ...outcome(what.root)];
  if (sort === "goals") return [title(what), ...outcome(what)];
  return [`${what.operation} of ${shortName(what.artifact)}`, `${what.agent ? `by ${what.agent} ` : ""}${span(from, to)}`, ...(what.outcome === "failed" ? [`failed: ${what.why}`] : [])];
}

function title({ agent, goal, intention }) { return `${agent}: ${goal}, intention ${intention}`; }

function reason(words, kind) { return words ? `${kind === KIND.waits ? " for" : ":"} ${words.replace(/^the action /, "")}` : ""; }

/** Who has the resource that an intention waits for, or was suspended for. */
function owner({ words, root }, lanes, t) {
  const resource = /^(?:preempted\((\w+)\)|the resource (\w+))/.exec(words ?? ""), holder = resource && lanes.owner(resource[1] ?? resource[2], t, root.agent);
  return holder ? [`held by ${holder}`] : [];
}

function outcome({ from, to, outcome: end, why }) {
  if (to === undefined) return [`open since ${clock(from)}`];
  const words = !end || end === "over" ? "ended" : end;
  return [`${words} ${clock(to)} after ${duration(to - from)}`, ...(why ? why.split("\n") : [])];
}

function span(from, to) { return to === Infinity ? `since ${clock(from)}` : `${clock(from)} to ${clock(to)} (${duration(to - from)})`; }

function failures(bars, first, end) {
  if (end - first === 1) {
    const { agent, goal, why, handled } = bars.whats[first];
    return [`${agent}: ${goal} failed${handled ? "; a plan handled it" : ""}`, clock(bars.starts[first]), ...why.split("\n")];
  }
  const lost = bars.whats.slice(first, end).filter((each) => !each.handled).length;
  return [`${end - first} failures, ${lost} of them lost goals`, span(bars.starts[first], bars.starts[end - 1])];
}

/** A refused plan, and how often plans were refused from the first to the end. */
function refusals(bars, first, end, index, minds) {
  const { agent, plan, why } = bars.whats[index], counts = new Map(), name = (id) => planName(minds.plan(agent, id));
  for (const each of bars.whats.slice(first, end)) counts.set(each.plan, (counts.get(each.plan) ?? 0) + 1);
  const most = [...counts].sort((a, b) => b[1] - a[1]).slice(0, MOST).map(([id, n]) => `${name(id)} refused ${n === 1 ? "once" : `${n} times`}`);
  return [`${name(plan)} refused: ${refusalWords(why)}`, clock(bars.starts[index]), `In view: ${most.join(", ")}${counts.size > MOST ? ", …" : ""}`];
}
