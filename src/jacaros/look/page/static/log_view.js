import { button, clock, element } from "./elements.js";

const PAGE = 200;  // lines that are in the document; earlier ones come on request

/** What agents printed and what happened up to now. */
export class LogView {
  constructor(root, { selection, time }, log) {
    this.log = log;
    this.time = time;
    this.selection = selection;
    this.count = -1;
    this.pages = 1;
    this.list = element("ol");
    this.list.setAttribute("aria-label", "Output of the agents and events up to now");
    this.earlier = button("plain earlier", () => this.showEarlier(), "Show earlier lines");
    this.none = element("p", "empty", "No output yet.");
    root.append(element("h2", "", "Output and events"), this.none, this.list);
    this.list.addEventListener("keydown", (event) => this.press(event));
  }

  get empty() { return !this.log.entries.times.length; }

  show(t) {
    const count = this.log.entries.countAt(t);
    if (count === this.count) return;
    const atEnd = this.list.scrollTop >= (this.end ?? 0) - 30;
    const first = Math.max(0, count - PAGE * this.pages);
    if (count > this.count && this.count >= 0 && first === this.first) this.append(this.count, count);
    else this.fill(first, count);
    this.count = count;
    this.none.hidden = count > 0;
    if (atEnd || this.isReplaced) this.scrollToEnd();
  }

  /** Show the last line; of one that is longer than the list, its beginning. */
  scrollToEnd() {
    const { list } = this;
    list.scrollTop = list.scrollHeight;
    list.scrollTop -= Math.max(0, (list.lastElementChild?.offsetHeight ?? 0) - list.clientHeight);
    this.end = list.scrollTop;
  }

  fill(first, count) {
    this.list.replaceChildren();
    if (first > 0) this.list.append(element("li", "", this.earlier));
    this.first = first;
    this.isReplaced = true;
    this.append(first, count);
    this.isReplaced = true;
  }

  append(from, to) {
    this.isReplaced = false;
    this.list.append(...this.log.entries.values.slice(from, to).map((entry) => this.line(entry)));
    // One line is reached by the tab key, the arrow keys move on from it.
    for (const line of this.list.querySelectorAll('button[tabindex="0"]')) line.tabIndex = -1;
    const last = this.list.lastElementChild?.querySelector("button");
    if (last) last.tabIndex = 0;
  }

  line(entry) {
    const text = element("span", "text");
    if (entry.who) text.append(element("span", "who", entry.who), " ");
    const [first, ...rest] = entry.text.split("\n");
    text.append(first, ...(rest.length ? [element("span", "rest", `\n${rest.join("\n")}`)] : []));
    const line = button("line", () => this.choose(entry), element("time", "", clock(entry.t)), text);
    line.tabIndex = -1;
    return element("li", entry.sort, line);
  }

  choose(entry) {
    this.time.go(entry.t);
    if (entry.who) this.selection.choose({ agent: entry.who });
    else if (entry.robot) this.selection.choose({ robot: entry.robot });
  }

  showEarlier() {
    this.pages += 1;
    const height = this.list.scrollHeight;
    this.fill(Math.max(0, this.count - PAGE * this.pages), this.count);
    this.list.scrollTop = this.list.scrollHeight - height;
  }

  press(event) {
    const lines = [...this.list.querySelectorAll("button")], at = lines.indexOf(document.activeElement);
    const to = { ArrowDown: at + 1, ArrowUp: at - 1 }[event.key];
    if (at < 0 || to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    lines[Math.min(lines.length - 1, Math.max(0, to))].focus();
  }
}
