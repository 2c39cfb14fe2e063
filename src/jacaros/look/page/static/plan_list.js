import { element } from "./elements.js";
import { momentButton, placeButton, whyButton } from "./jumps.js";
import { planName, refusalWords } from "./link_words.js";
import { keyed } from "./refill.js";

/** The plans of an agent: how often each was chosen and refused, and why. */
export class PlanList {
  constructor(context) {
    this.context = context;
    this.hideEmpty = true;
  }

  count(mind, t) { return mind.program(t).plans.length; }

  stamp(mind, t) { return `${mind.programs.since(t) ?? 0} ${mind.decisionsAt(t)} ${this.context.selection.current.plan ?? ""}`; }

  nodes(mind, t) {
    const { plans } = mind.program(t);
    // What a program includes comes below what it says itself.
    const own = plans.filter(({ file }) => !isIncluded(file)), included = plans.filter(({ file }) => isIncluded(file));
    const nodes = own.map((plan) => this.plan(mind, plan, t));
    if (!included.length) return nodes;
    const rest = element("details", "included", element("summary", "", `${included.length} included plans`), ...included.map((plan) => this.plan(mind, plan, t)));
    rest.open = !own.length || included.some(({ id }) => this.context.selection.has({ agent: mind.name, plan: id }));
    return [...nodes, keyed("included", rest)];
  }

  plan(mind, plan, t) {
    const chosen = mind.use.chosen(plan.id, t), refused = mind.use.refused(plan.id, t), key = `plan ${plan.id}`;
    const title = element("span", "plan-title", element("code", "", planName(plan)));
    if (plan.label && planName(plan) !== plan.trigger) title.append(" ", element("code", "trigger", plan.trigger));
    if (plan.context) title.append(" ", element("code", "context", `: ${plan.context}`));
    const made = element("details", `plan${chosen ? "" : " unused"}`, element("summary", "", title, counts(chosen, refused)));
    made.append(...this.details(mind, plan, t, key));
    made.open = this.context.selection.has({ agent: mind.name, plan: plan.id });
    return keyed(key, made);
  }

  details(mind, plan, t, key) {
    const last = mind.use.lastChoice(plan.id, t), reasons = mind.use.reasons(plan.id, t);
    const lines = [element("p", "where", placeButton(this.context, plan, key), this.breakpoint(mind, plan, key))];
    if (last) {
      lines.push(element("p", "", "last chosen at ", momentButton(this.context, last.t, `${key} last`), " for ", element("code", "", last.trigger), " ",
        whyButton(this.context, { agent: mind.name, cause: last.id }, `${key} last`)));
    }
    if (reasons.length) lines.push(element("ul", "reasons", ...reasons.map((reason, n) => this.reason(mind, reason, `${key} ${n}`))));
    if (!last && !reasons.length) lines.push(element("p", "empty", "No event has triggered this plan yet."));
    return lines;
  }

  reason(mind, { why, count, last }, key) {
    return element("li", "", element("b", "", `${count}×`), " refused: ", refusalWords(why), " (last for ", element("code", "", last.trigger), " at ",
      momentButton(this.context, last.t, key), ") ", whyButton(this.context, { agent: mind.name, cause: last.id }, key));
  }

  breakpoint(mind, plan, key) {
    const { breakpoints } = this.context;
    if (!breakpoints?.allowed) return element("span");
    const toggle = breakpoints.toggle({ plan: { agent: mind.name, plan: plan.label || plan.id } });
    return keyed(`${key} breakpoint`, toggle);
  }
}

function counts(chosen, refused) {
  const made = element("span", "counts");
  made.append(element("span", chosen ? "chosen" : "never", chosen ? `✓ ${chosen}` : "never ran"));
  if (refused) made.append(" ", element("span", "refused", `✗ ${refused}`));
  made.title = `chosen ${chosen} times, refused ${refused} times`;
  return made;
}

function isIncluded(file) { return String(file ?? "").startsWith("$"); }
