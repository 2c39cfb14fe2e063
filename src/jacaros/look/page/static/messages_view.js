import { draggable } from "./curve_choice.js";
import { button, clock, element, rounded } from "./elements.js";
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
    const agents = talking(shown), left = shown.filter((each) => !agents.includes(each.from) || !agents.includes(each.to));
    this.note.hidden = shown.length > 0 && !left.length;
    this.note.textContent = shown.length ? `${left.length} messages of other agents are not in the chart: select an agent.` : "No messages yet.";
    this.chart.style.setProperty("--columns", String(agents.length));
    this.chart.style.minWidth = `${54 + agents.length * 74}px`;
    const head = element("div", "chart-head", element("span"), ...agents.map((agent) => keyed(`agent ${agent}`, button("jump", () => {
      this.context.selection.choose({ agent });
      this.context.open("agents");
    }, agent))));
    head.setAttribute("role", "listitem");
    refill(this.chart, [head, ...shown.filter((each) => !left.includes(each)).map((each) => this.row(each, agents, t))]);
  }

  row(message, agents, t) {
    const from = agents.indexOf(message.from), to = agents.indexOf(message.to), first = Math.min(from, to), last = Math.max(from, to);
    const text = `${message.performative} ${message.content}`, isRead = message.read <= t;
    const arrow = button(`arrow ${from < to ? "right" : from > to ? "left" : "self"}${isRead ? "" : " unread"}`,
      () => showWhy(this.context, { agent: message.from, cause: message.id }), element("span", "", element("b", "", message.performative), ` ${rounded(message.content)}`));
    arrow.style.gridColumn = from === to ? `${from + 2} / span 1` : `${first + 2} / ${last + 3}`;
    arrow.style.setProperty("--span", String(Math.max(1, last - first + 1)));
    arrow.title = text;
    arrow.setAttribute("aria-label", `${clock(message.sent)} ${message.from} to ${message.to}: ${text}${isRead ? "" : ", not read yet"}`);
    const row = element("div", `message${this.context.selection.has({ cause: message.id }) ? " selected" : ""}`, element("time", "", clock(message.sent)), keyed(`message ${message.id}`, draggable(arrow, messageKeys(message))));
    row.setAttribute("role", "listitem");
    return row;
  }
}

/** The agents that talk now: those of the newest messages, in the order in which they first appear. */
function talking(messages) {
  const kept = new Set();
  for (const { from, to } of messages.toReversed()) {
    if (new Set([...kept, from, to]).size <= MOST) kept.add(from).add(to);
  }
  return [...new Set(messages.flatMap(({ from, to }) => [from, to]))].filter((agent) => kept.has(agent));
}
