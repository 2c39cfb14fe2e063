import { indexAt } from "./track.js";

/** Messages between agents, in the order in which they were sent. */
export class Messages {
  constructor() {
    this.all = [];  // id, from, to, performative, content, sent, read
    this.times = [];
    this.byId = new Map();
  }

  add(t, event, data) {
    if (event !== "message") return;
    const known = this.byId.get(data.id);
    if (data.state === "read") {
      if (known) known.read = Math.min(known.read, t);
      return;
    }
    const made = { ...data, sent: t, read: Infinity };
    this.all.push(made);
    this.times.push(t);
    this.byId.set(data.id, made);
  }

  countAt(t) { return indexAt(this.times, t) + 1; }

  /** The last `count` messages that were sent up to time `t`, the oldest first, of one agent if `agent` is given. */
  last(t, count, agent) {
    const found = [];
    for (let i = this.countAt(t) - 1; i >= 0 && found.length < count; i--) {
      const message = this.all[i];
      if (!agent || message.from === agent || message.to === agent) found.unshift(message);
    }
    return found;
  }
}
