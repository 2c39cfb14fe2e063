import { Changing } from "./changing.js";

/**
 * What is selected: a plain object with some of `agent`, `robot`, `intention` (of the agent), `plan` (of the agent),
 * `artifact`, `cause` (the id of a link), `file` and `line`, `door`, `person`, `obstacle`.
 */
export class Selection extends Changing {
  current = {};

  /** Select this instead of what was selected. */
  choose(what) {
    this.current = { ...what };
    this.notify();
  }

  clear() { this.choose({}); }

  /** Whether everything in `what` is selected: `has({agent: "guard", intention: 3})`. */
  has(what) { return Object.entries(what).every(([key, value]) => this.current[key] === value); }
}
