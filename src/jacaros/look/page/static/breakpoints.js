import { button } from "./elements.js";

/** The breakpoints of the run, also those that other pages or a program set. */
export class Breakpoints {
  constructor(context, debugging) {
    this.context = context;
    this.debugging = debugging;
    this.known = null;
    this.byText = new Map();
    this.changes = 0;
  }

  /** A number that is another one when breakpoints have changed. */
  get version() { return this.all && this.changes; }

  /** By their text: `at`, as the command has it. */
  get all() {
    const set = this.debugging.now.breakpoints ?? this.known;
    if (set !== this.known) {
      this.known = set;
      this.byText = new Map(set.map((at) => [textOf(at), at]));
      this.changes += 1;
    }
    return this.byText;
  }

  /** Whether breakpoints can be set in this run. */
  get allowed() { return this.context.commands.can.has("breakpoint"); }

  has(at) { return this.all.has(textOf(at)); }

  /** Set a breakpoint, or remove it. */
  async change(at, op) {
    await this.context.commands.send("breakpoint", { op, at });
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
