import { draggable } from "./curve_choice.js";
import { button, clock, element, rounded } from "./elements.js";
import { showWhy } from "./jumps.js";
import { keyed, moveByArrows, refill } from "./refill.js";
import { messageKeys } from "./series_sources.js";

const ROWS = 60;  // messages in the list

/** Messages between agents as a list, the newest at the bottom. The lanes show them as arrows. */
export class MessagesView {
  constructor(root, context, messages) {
    Object.assign(this, { root, context, messages });
    this.only = element("input");
    this.only.type = "checkbox";
    this.only.addEventListener("change", () => context.time.notify());
    this.filter = element("label", "only", this.only, " only of the selected agent");
    this.list = element("ol", "exchange");
    this.list.setAttribute("aria-label", "Messages, oldest first");
    root.append(this.filter, this.list);
    moveByArrows(this.list, ".message");
  }

  get empty() { return !this.messages.sent.times.length; }

  show(t) {
    const { agent, cause } = this.context.selection.current;
    this.filter.hidden = agent === undefined;
    const shown = this.messages.last(t, ROWS, this.only.checked ? agent : undefined);
    const stamp = `${this.messages.sent.countAt(t)} ${shown.filter((each) => each.read <= t).length} ${this.only.checked ? agent : ""} ${cause}`;
    if (stamp === this.stamp) return;
    this.stamp = stamp;
    const atEnd = this.root.scrollTop + this.root.clientHeight >= this.root.scrollHeight - 40;
    refill(this.list, shown.length ? shown.map((each) => this.row(each, t)) : [element("li", "empty", "No messages yet.")]);
    if (atEnd) this.root.scrollTop = this.root.scrollHeight;
  }

  row(message, t) {
    const { id, from, to, performative, content, sent, read } = message, text = `${performative} ${content}`, isUnread = read > t;
    const made = button("message", () => showWhy(this.context, { agent: from, cause: id }),
      element("time", "", clock(sent)), element("span", "", element("b", "", `${from} → ${to}`), isUnread ? " not read yet" : ""),
      element("span", "said", `${performative} `, element("code", "", rounded(content))));
    made.title = text;
    made.setAttribute("aria-label", `${clock(sent)} ${from} to ${to}: ${text}${isUnread ? ", not read yet" : ""}`);
    return element("li", this.context.selection.has({ cause: id }) ? "selected" : "", keyed(`message ${id}`, draggable(made, messageKeys(message))));
  }
}
