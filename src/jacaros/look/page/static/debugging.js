import { Track } from "./track.js";

/** Whether the run was paused, at which speed it went, and what a pause does not stop. */
export class Debugging {
  constructor() {
    this.states = new Track();
    this.notes = [];  // changes that users made
  }

  add(t, event, data) { if (event === "debug") this.states.add(t, data); }

  /** State at time `t`: state, why, speed, cannot, and agent, file and line of the step before which it is held. */
  at(t) { return this.states.at(t) ?? { state: "running", why: "", cannot: [] }; }

  /** The newest state. */
  get now() { return this.states.values.at(-1) ?? { state: "running", why: "", cannot: [] }; }
}
