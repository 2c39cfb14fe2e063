import { button } from "./elements.js";

/** The breakpoints that were set from this page. */
export class Breakpoints {
  constructor(context) {
    this.context = context;
    this.all = new Map();  // by their text: `at`, as the command has it
    this.version = 0;
  }

  /** Whether breakpoints can be set in this run. */
  get allowed() { return this.context.commands.can.has("breakpoint"); }

  has(at) { return this.all.has(textOf(at)); }

  /** Set a breakpoint, or remove it. */
  async change(at, op) {
    await this.context.commands.send("breakpoint", { op, at });
    if (op === "add") this.all.set(textOf(at), at); else this.all.delete(textOf(at));
    this.version += 1;
    this.context.time.notify();
  }

  /** A button that sets a breakpoint, or removes it. */
  toggle(at) {
    const made = button("jump breakpoint", () => this.context.actions.run(made, async () => {
      await this.change(at, this.has(at) ? "remove" : "add");
      this.mark(made, at);
    }), "");
    this.mark(made, at);
    return made;
  }

  mark(made, at) {
    const isSet = this.has(at);
    made.textContent = isSet ? "● breakpoint" : "○ breakpoint";
    made.setAttribute("aria-pressed", String(isSet));
  }
}

/** A breakpoint for people. */
export function textOf({ line, plan, event, condition, agent }) {
  if (line) return `${line.file.split("/").at(-1)}:${line.line}`;
  if (plan) return `plan ${plan.plan}${plan.agent ? ` of ${plan.agent}` : ""}`;
  return `${event ? `event ${event}` : condition}${agent ? ` of ${agent}` : ""}`;
}
