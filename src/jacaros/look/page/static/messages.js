import { indexAt } from "./track.js";

const LIMIT = 20000;  // messages that are kept: a live page may be open for days

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
    if (this.all.length <= LIMIT) return;
    this.times.splice(0, LIMIT >> 2);
    for (const { id } of this.all.splice(0, LIMIT >> 2)) this.byId.delete(id);
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
