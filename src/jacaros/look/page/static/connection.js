import { Changing } from "./changing.js";
import { startPage, fragment } from "./main.js";

const FIRST_WAIT = 0.5, LONGEST_WAIT = 10;  // seconds before the page connects again

/** What the page asks of the run, over its link. */
class Commands extends Changing {
  constructor() {
    super();
    this.can = new Set();
    this.link = null;
    this.number = 0;
    this.waiting = new Map();
  }

  /** Send a command; the promise has the result, or fails with the reason in words. */
  send(command, args = {}) {
    if (!this.link) return Promise.reject(new Error("not connected to the run"));
    const id = ++this.number;
    this.link.send(JSON.stringify({ ...args, id, do: command }));
    return new Promise((resolve, reject) => this.waiting.set(id, { resolve, reject }));
  }

  reply({ id, ok, error, result }) {
    const { resolve, reject } = this.waiting.get(id) ?? {};
    this.waiting.delete(id);
    if (ok) resolve?.(result); else reject?.(new Error(error ?? "the command failed"));
  }

  allow(names) {
    this.can = new Set(names);
    this.notify();
  }

  disconnect() {
    this.link = null;
    for (const { reject } of this.waiting.values()) reject(new Error("the connection was lost"));
    this.waiting.clear();
    this.allow([]);
  }
}

/**
 * Connects the page with a run, again and again until the run has ended.
 *
 * `open(listener)` opens a link. It calls `opened(link)` of its listener, where `link.send(text)` sends a command, then
 * `received(text)` with each message, and `closed()` at the end.
 */
export class Connection {
  constructor(open) {
    this.open = open;
    this.commands = new Commands();
    this.wait = FIRST_WAIT;
    this.heard = Date.now();
    this.begin();
    this.connect();
    setInterval(() => { if (this.page.time.lost) this.page.time.notify(); }, 1000);
  }

  begin() {
    this.page = startPage({ live: true, commands: this.commands });
    this.hasStarted = false;
  }

  connect() {
    this.open({
      opened: (link) => {
        this.commands.link = link;
        this.wait = FIRST_WAIT;
        this.page.notice("");
      },
      received: (text) => this.receive(JSON.parse(text)),
      closed: () => this.lose(),
    });
  }

  lose() {
    this.commands.disconnect();
    if (this.page.run.over) {
      this.page.time.end(null);
      this.page.notice("The run has ended. You can still go back in time.");
      return;
    }
    this.page.time.end(this.heard);
    document.body.classList.add("stale");
    setTimeout(() => this.connect(), this.wait * 1000);
    this.wait = Math.min(LONGEST_WAIT, this.wait * 2);
  }

  receive(message) {
    this.heard = Date.now();
    if (Array.isArray(message)) this.page.run.addAll(message);
    else if (message.kind === "hello") this.greet(message);
    else if (message.kind === "can") this.commands.allow(message.can);
    else if (message.kind === "reply") this.commands.reply(message);
  }

  greet({ title, can, live = true }) {
    // The server sends its whole history to every connection: a page that connects again would have it twice.
    if (this.hasStarted) { location.reload(); return; }
    this.hasStarted = true;
    if (title) this.page.setTitle(title);
    this.commands.allow(can ?? []);
    this.page.time.canBeLive = live;
    const t = fragment().get("t");
    if (!live || t !== null) this.startAt(Number(t) || 0);
  }

  /** Show the moment `t`, as soon as the records up to it are there. */
  startAt(t) {
    this.page.time.go(t);
    if (t === 0) return;
    const end = this.page.run.onChange(() => {
      this.page.time.go(t);
      if (this.page.run.end >= t) end();
    });
  }
}
