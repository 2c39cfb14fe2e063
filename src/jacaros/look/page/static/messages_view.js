import { draggable } from "./curve_choice.js";
import { button, clock, element } from "./elements.js";
import { showWhy } from "./jumps.js";
import { keyed, moveByArrows, refill } from "./refill.js";
import { messageKeys } from "./series_sources.js";

const ROWS = 60;  // messages in the chart
const MOST = 8;  // agents that have a line

/** Messages between agents as a sequence chart, the newest at the bottom. */
export class MessagesView {
  constructor(root, context, messages) {
    Object.assign(this, { root, context, messages });
    this.only = element("input");
    this.only.type = "checkbox";
    this.only.addEventListener("change", () => context.time.notify());
    this.filter = element("label", "only", this.only, " only of the selected agent");
    this.chart = element("div", "chart");
    this.chart.setAttribute("role", "list");
    this.chart.setAttribute("aria-label", "Messages, oldest first");
    this.note = element("p", "empty");
    root.append(this.filter, this.note, this.chart);
    moveByArrows(this.chart, ".arrow");
  }

  get empty() { return this.messages.all.length === 0; }

  show(t) {
    const { agent, cause } = this.context.selection.current;
    this.filter.hidden = agent === undefined;
    const shown = this.messages.last(t, ROWS, this.only.checked ? agent : undefined);
    const stamp = `${this.messages.countAt(t)} ${shown.filter((each) => each.read <= t).length} ${this.only.checked ? agent : ""} ${cause}`;
    if (stamp === this.stamp) return;
    this.stamp = stamp;
    const atEnd = this.root.scrollTop + this.root.clientHeight >= this.root.scrollHeight - 40;
    this.draw(shown, t);
    if (atEnd) this.root.scrollTop = this.root.scrollHeight;
  }

  draw(shown, t) {
    const agents = busiest(shown), left = shown.filter((each) => !agents.includes(each.from) || !agents.includes(each.to));
    this.note.hidden = shown.length > 0 && !left.length;
    this.note.textContent = shown.length ? `${left.length} messages of other agents are not in the chart: select an agent.` : "No messages yet.";
    this.chart.style.setProperty("--columns", String(agents.length));
    this.chart.style.minWidth = `${54 + agents.length * 74}px`;
    const head = element("div", "chart-head", element("span"), ...agents.map((agent) => keyed(`agent ${agent}`, button("jump", () => {
      this.context.selection.choose({ agent });
      this.context.open("agents");
    }, agent))));
    refill(this.chart, [head, ...shown.filter((each) => !left.includes(each)).map((each) => this.row(each, agents, t))]);
  }

  row(message, agents, t) {
    const from = agents.indexOf(message.from), to = agents.indexOf(message.to), first = Math.min(from, to), last = Math.max(from, to);
    const text = `${message.performative} ${message.content}`, isRead = message.read <= t;
    const arrow = button(`arrow ${from < to ? "right" : from > to ? "left" : "self"}${isRead ? "" : " unread"}`,
      () => showWhy(this.context, { agent: message.from, cause: message.id }), element("span", "", element("b", "", message.performative), ` ${message.content}`));
    arrow.style.gridColumn = from === to ? `${from + 2} / span 1` : `${first + 2} / ${last + 3}`;
    arrow.style.setProperty("--span", String(Math.max(1, last - first + 1)));
    arrow.title = text;
    arrow.setAttribute("aria-label", `${clock(message.sent)} ${message.from} to ${message.to}: ${text}${isRead ? "" : ", not read yet"}`);
    const row = element("div", `message${this.context.selection.has({ cause: message.id }) ? " selected" : ""}`, element("time", "", clock(message.sent)), keyed(`message ${message.id}`, draggable(arrow, messageKeys(message))));
    row.setAttribute("role", "listitem");
    return row;
  }
}

/** The agents with most of the messages, in the order in which they first appear. */
function busiest(messages) {
  const counts = new Map();
  for (const { from, to } of messages) for (const each of [from, to]) counts.set(each, (counts.get(each) ?? 0) + 1);
  const kept = new Set([...counts].sort((a, b) => b[1] - a[1]).slice(0, MOST).map(([agent]) => agent));
  return [...counts.keys()].filter((agent) => kept.has(agent));
}
