import { button, element } from "./elements.js";
import { textOf } from "./breakpoints.js";
import { Popover } from "./popover.js";
import { keyed, refill } from "./refill.js";

const KINDS = {
  line: { title: "line", example: "patrol.asl:14", at: (text) => ({ line: lineOf(text) }) },
  plan: { title: "plan", example: "label of the plan", at: (text, agent) => ({ plan: { agent, plan: text.replace(/^@/, "") } }) },
  event: { title: "event", example: "+!go(_)", at: (text) => ({ event: text }) },
  condition: { title: "condition", example: "battery(B) & B < 20", at: (text, agent) => ({ condition: text, agent }) },
};

/** The list of breakpoints, and fields for another one. */
export class BreakpointsForm {
  constructor(context, minds) {
    Object.assign(this, { context, minds });
    this.list = element("ul", "breakpoints");
    this.kind = element("select", "", ...Object.entries(KINDS).map(([kind, { title }]) => new Option(title, kind)));
    this.kind.setAttribute("aria-label", "Kind of breakpoint");
    this.agent = element("select");
    this.agent.setAttribute("aria-label", "Agent");
    this.field = element("input", "entry");
    Object.assign(this.field, { type: "text", spellcheck: false, required: true });
    this.field.setAttribute("aria-label", "Where to stop");
    const add = element("button", "plain", "Add");
    const form = element("form", "console-form", this.kind, this.agent, this.field, add);
    form.addEventListener("submit", (event) => { event.preventDefault(); this.add(); });
    this.kind.addEventListener("change", () => this.prompt());
    this.popover = new Popover("Breakpoints", this.list, form);
    this.root = this.popover.root;
    this.prompt();
  }

  prompt() {
    this.field.placeholder = KINDS[this.kind.value].example;
    this.agent.hidden = this.kind.value === "line" || this.kind.value === "event";
  }

  async add() {
    const { actions, breakpoints } = this.context, place = () => KINDS[this.kind.value].at(this.field.value.trim(), this.agent.value);
    const done = await actions.run(this.field, async () => breakpoints.change(place(), "add"));
    if (done !== undefined) this.field.value = "";
  }

  show() {
    const { breakpoints, actions } = this.context, stamp = `${breakpoints.version} ${this.minds.version}`;
    this.root.hidden = !breakpoints.allowed;
    if (stamp === this.stamp) return;
    this.stamp = stamp;
    this.popover.summary.textContent = breakpoints.all.size ? `Breakpoints (${breakpoints.all.size})` : "Breakpoints";
    refill(this.list, [...breakpoints.all].map(([text, at]) => {
      const remove = button("act", () => actions.run(remove, () => breakpoints.change(at, "remove")), "×");
      remove.setAttribute("aria-label", `Remove the breakpoint ${text}`);
      return element("li", "", element("code", "", text), keyed(text, remove));
    }));
    const chosen = this.agent.value || this.context.selection.current.agent;
    this.agent.replaceChildren(...[...this.minds.agents.keys()].map((name) => new Option(name, name)));
    if (chosen && this.minds.agents.has(chosen)) this.agent.value = chosen;
  }
}

function lineOf(text) {
  const [, file, line] = /^(.*?):?(\d+)$/.exec(text) ?? [];
  if (!file) throw new Error("expected a file and a line, such as patrol.asl:14");
  return { file, line: Number(line) };
}
