import { button, clock, element, setText } from "./elements.js";
import { moveByArrows, refill, keyed } from "./refill.js";
import { duration } from "./section.js";

const SIGNS = { error: "✖", warning: "⚠", note: "" };

/** The story of a run: lines with `t`, `text`, `level`, `count`, `until`, `agent` and `robot`. */
export class Story {
  constructor() {
    this.lines = [];
    this.isWhole = false;  // the run has ended
    this.span = 0;  // seconds of which the page of a long recording has the extremes of numbers
    this.listener = () => {};
  }

  /** Call `listener` as soon as the story is there, after the records. */
  onTold(listener) { this.listener = listener; }

  add(t, event, data) {
    if (event !== "story") return;
    Object.assign(this, { ...data, isWhole: true });
    queueMicrotask(() => this.listener());
  }
}

/** The story, each line with the way to its moment. A live page asks for it when its tab is opened. */
export class StoryView {
  constructor(root, context, story) {
    Object.assign(this, { root, context, story });
    this.list = element("ol", "story");
    this.list.setAttribute("aria-label", "What happened in this run. Each line goes to its moment.");
    this.again = button("plain", () => this.ask(), "Update");
    this.note = element("p", "about");
    root.append(this.list, this.again, this.note);
    moveByArrows(this.list, ".moment");
  }

  get empty() { return this.story.lines.length === 0 && !this.canAsk; }

  get canAsk() { return this.context.commands.can.has("story"); }

  /** The tab was opened. */
  opened() { if (this.canAsk) this.ask(); }

  async ask() {
    const { actions, commands, time } = this.context;
    const lines = await actions.run(this.again, () => commands.send("story"));
    if (!lines) return;
    this.story.lines = lines;
    this.now = undefined;
    time.notify();
  }

  show(t) {
    this.again.hidden = !this.canAsk;
    const now = this.story.lines.filter((line) => line.t <= t + 0.05).length - 1;
    if (now === this.now) return;
    this.now = now;
    const { span } = this.story;
    setText(this.note, span ? `The recording is long: of values that led to nothing, this page has the lowest and highest of each ${duration(span)}.` : "");
    refill(this.list, this.story.lines.map((line, n) => this.line(line, n)));
  }

  line({ t, text, level, count, until, agent, robot }, n) {
    const sign = element("i", "sign", SIGNS[level] ?? "");
    if (level !== "note") Object.assign(sign, { role: "img", ariaLabel: level });
    const folded = [count > 1 ? `${count} times` : "", until ? `until ${clock(until)}` : ""].filter(Boolean).join(", ");
    const made = button("moment", () => {
      this.context.time.go(t);
      if (agent || robot) this.context.selection.choose(agent ? { agent } : { robot });
    }, element("time", "", clock(t)), sign, element("span", "", ...coded(text), folded ? element("span", "folded", `\u2002${folded.replaceAll(" ", "\u00a0")}`) : ""));
    return element("li", `${level}${n === this.now ? " now" : ""}`, keyed(`story ${n}`, made));
  }
}

/** A text of which the parts in backquotes are code. */
export function coded(text) {
  return text.split("`").map((part, n) => (n % 2 ? element("code", "", part) : part));
}
