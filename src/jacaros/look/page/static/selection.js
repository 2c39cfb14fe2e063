/**
 * What is selected: a plain object with some of `agent`, `robot`, `intention` (of the agent), `plan` (of the agent),
 * `artifact`, `cause` (the id of a link), `file` and `line`, `door`, `person`, `obstacle`.
 *
 * Fires "change".
 */
export class Selection extends EventTarget {
  constructor() {
    super();
    this.current = {};
  }

  /** Select this instead of what was selected. */
  choose(what) {
    this.current = { ...what };
    this.dispatchEvent(new Event("change"));
  }

  clear() { this.choose({}); }

  /** Whether everything in `what` is selected: `has({agent: "guard", intention: 3})`. */
  has(what) { return Object.entries(what).every(([key, value]) => this.current[key] === value); }

  onChange(listener) { this.addEventListener("change", listener); }
}
