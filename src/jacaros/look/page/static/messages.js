import { Track } from "./track.js";

const LIMIT = 20000;  // messages that are kept: a live page may be open for days

/** Messages between agents, in the order in which they were sent. */
export class Messages {
  constructor() {
    this.sent = new Track(LIMIT);  // id, from, to, performative, content, sent, read
    this.unread = new Map();  // by id
  }

  add(t, event, data) {
    if (event !== "message") return;
    if (data.state === "read") {
      const known = this.unread.get(data.id);
      if (known) known.read = t;
      this.unread.delete(data.id);
      return;
    }
    const made = { ...data, sent: t, read: Infinity };
    this.sent.add(t, made);
    this.unread.set(data.id, made);
    if (this.unread.size > LIMIT) this.unread.delete(this.unread.keys().next().value);
  }

  /** The last `count` messages that were sent up to time `t`, the oldest first, of one agent if `agent` is given. */
  last(t, count, agent) {
    const found = [];
    for (let i = this.sent.countAt(t) - 1; i >= 0 && found.length < count; i--) {
      const message = this.sent.values[i];
      if (!agent || message.from === agent || message.to === agent) found.unshift(message);
    }
    return found;
  }
}
