import { clock, element } from "./elements.js";
import { momentButton, placeButton, whyButton } from "./jumps.js";
import { keyed } from "./refill.js";
import { age } from "./section.js";

const CRUMBS = 4;  // goals of a stack that are named before it unfolds
const PAST = 3;
const STATES = { runs: "▶ runs", waits: "◔ waits", suspended: "❚❚ suspended" };

/** A card for each intention of an agent: its current step first, then its stack; below them the goals that ended last. */
export class IntentionCards {
  constructor(context) { this.context = context; }

  count(mind, t) { return mind.intentionsAt(t).length; }

  stamp(mind, t) { return `${mind.stamp(t)} ${this.context.selection.current.intention ?? ""}`; }

  nodes(mind, t) {
    const cards = mind.intentionsAt(t).map((intention) => this.card(mind, intention));
    const past = this.past(mind.pastGoals(t, PAST));
    if (!cards.length && !past) return [element("p", "empty", mind.runsAt(t) ? "No intention: the agent waits for an event." : "The agent has ended.")];
    return past ? [...cards, past] : cards;
  }

  card(mind, intention) {
    const { id, state, stack = [], waits, since, reason, urgency, cause } = intention, key = `intention ${id}`;
    const top = stack.at(-1) ?? { goal: "", step: "" };
    const selected = this.context.selection.has({ agent: mind.name, intention: id });
    const card = element("article", `intention ${state}${selected ? " selected" : ""}`);
    card.setAttribute("aria-label", `Intention ${id}: ${top.step || top.goal}`);
    card.append(element("header", "", element("code", "step", top.step || top.goal || "its end"), element("span", "state", STATES[state] ?? state)));
    card.append(element("p", "where", placeButton(this.context, top, key), element("span", "since", "since ", momentButton(this.context, since ?? 0, key), " · ", age(since ?? 0))));
    if (waits) card.append(element("p", "waits", element("b", "", "waits for "), waits));
    if (reason && reason !== "suspend_ia") card.append(element("p", "waits", element("b", "", "suspended: "), reason));
    if (top.step || stack.length > 1) card.append(this.stack(stack, key));
    card.append(this.feet({ mind, id, urgency, cause, key, goal: top.goal }));
    return card;
  }

  /** The goals from the bottom up: as one line, which unfolds. */
  stack(stack, key) {
    const goals = stack.map(({ goal }) => goal), left = goals.length - CRUMBS;
    const shown = left > 0 ? [goals[0], `${left + 1} more`, ...goals.slice(1 - CRUMBS + 1)] : goals;
    const crumbs = element("summary");
    shown.forEach((goal, n) => crumbs.append(...(n ? [element("i", "", " › ")] : []), element("span", left > 0 && n === 1 ? "left" : "", goal)));
    const levels = element("ol", "", ...[...stack].reverse().map((level, n) => element("li", "", element("code", "", level.goal),
      placeButton(this.context, level, `${key} ${n}`), ...(level.step ? [element("span", "at", "at ", element("code", "", level.step))] : []))));
    return keyed(`${key} stack`, element("details", "stack", crumbs, levels));
  }

  feet({ mind, id, urgency, cause, key, goal }) {
    const feet = element("footer", "", whyButton(this.context, { agent: mind.name, intention: id, cause: cause || undefined }, key));
    if (urgency) feet.append(element("span", "urgency", `urgency ${urgency}`));
    const { commands } = this.context;
    if (commands.can.has("console") && goal?.startsWith("!")) {
      feet.append(keyed(`${key} drop`, this.context.actions.button("Drop", `Drop ${goal}`, () => commands.send("console", { agent: mind.name, text: `-${goal}` }))));
    }
    return feet;
  }

  past(goals) {
    if (!goals.length) return null;
    // Goals that served one another failed for one reason: it appears once, below the last of them.
    return element("ul", "past", ...goals.map((goal, n) => this.over(goal, goals[n + 1]?.why !== goal.why)));
  }

  over({ t, goal, state, why, agent, intention }, isReasoned) {
    const item = element("li", state, element("i", "mark"), element("code", "", goal), element("span", "state", `${state} ${clock(t)}`));
    if (why && isReasoned) item.append(reason(why, `goal ${t} ${goal}`));
    item.title = `${agent}: ${goal} ${state}${intention ? `, of intention ${intention}` : ""}`;
    return item;
  }
}

/** Why a goal failed: error and place first; the step and the terms unfold. */
function reason(why, key) {
  const [first, ...rest] = why.split("\n");
  if (!rest.length) return element("span", "why", first);
  return keyed(key, element("details", "why", element("summary", "", first), element("span", "", rest.join("\n"))));
}
