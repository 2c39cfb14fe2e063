import { element, isDark, setText } from "./elements.js";
import { showWhy } from "./jumps.js";
import { Bars, KIND } from "./lanes_bars.js";
import { LanesDrawing } from "./lanes_drawing.js";
import { barLines } from "./lanes_words.js";
import { planName, shortName } from "./link_words.js";
import { TimePointer } from "./time_pointer.js";

const NEAR = 5;  // pixels around a bar, or a mark, in which it is pointed at
const THIN = 3;  // pixels around an arrow
const FOLDED = 2;  // intentions of a folded agent that have a high row
const LEGEND = [["runs", "runs"], ["acts", "acts"], ["waits", "waits"], ["suspended", "suspended"], ["lost", "lost goal"], ["handled", "failure with a plan"]];
const HEIGHTS = { states: 16, more: 4, goals: 12, actions: 10, refusals: 8, resources: 12, operations: 12 };

/** Lanes: intentions of each agent, owners of resources and operations of artifacts over time, on one canvas. */
export class LanesView {
  constructor(root, context, { lanes, minds, messages }) {
    Object.assign(this, { root, context, lanes, minds, messages, axis: context.axis, rows: [], open: new Set(), current: null });
    this.canvas = element("canvas");
    this.canvas.setAttribute("aria-hidden", "true");
    this.drawing = new LanesDrawing(this.canvas, this.axis);
    this.space = element("div");
    this.tip = element("p", "lanes-tip");
    this.tip.hidden = true;
    this.cursor = element("button", "cursor", "Bars: the arrow keys move from one to the next");
    root.append(this.cursor, this.canvas, this.space);
    const panel = root.closest(".when");
    panel.append(this.tip);
    panel.querySelector("h2").after(element("ul", "lanes-legend", ...LEGEND.map(([sort, text]) => element("li", sort, text))));
    this.listen();
  }

  listen() {
    new TimePointer(this.root, this.axis, this);
    this.root.addEventListener("scroll", () => this.context.time.notify());
    this.cursor.type = "button";
    this.cursor.addEventListener("keydown", (event) => this.press(event));
    this.cursor.addEventListener("click", () => { if (this.current) this.choose(this.current, this.current.row.bars.starts[this.current.index]); });
    this.cursor.addEventListener("focus", () => this.point(this.current ?? this.firstBar()));
    this.cursor.addEventListener("blur", () => this.point(null));
  }

  get empty() { return !this.lanes.agents.size && !this.lanes.artifacts.size; }

  show() {
    const { axis, root, lanes, context } = this, { clientWidth: width, clientHeight: height, scrollTop: top } = root, { selection, run } = context;
    const stamp = [axis.from, axis.to, axis.width, width, height, top, lanes.version, this.messages.sent.values.at(-1)?.id, JSON.stringify(selection.current), isDark(),
      [...this.open], this.current?.row.key, this.current?.index].join(" ");
    if (stamp === this.stamp || height < 2) return;
    this.stamp = stamp;
    this.layOut();
    this.canvas.style.marginBottom = `${-height}px`;
    this.space.style.height = `${this.height}px`;
    this.drawing.draw(this.rows, { top, width, height, end: run.end, current: this.current, messages: this.arrows(),
      selected: (what) => what.intention !== undefined && selection.has({ agent: what.agent, intention: what.intention }) });
  }

  // ---- rows

  layOut() {
    const { lanes } = this;
    Object.assign(this, { rows: [], height: 4 });
    for (const lane of lanes.agents.values()) this.addAgent(lane);
    for (const { name, bars } of lanes.resources.values()) this.add("resources", bars, { label: `owner: ${name.replace(/^\//, "")}`, isFirst: true });
    for (const { name, rows, lasts } of lanes.artifacts.values()) {
      if (lasts || this.context.selection.has({ artifact: name })) rows.forEach((bars, n) => this.add("operations", bars, { label: n ? "" : shortName(name), isFirst: !n }));
    }
    if (this.current) this.current.row = this.rows.find(({ bars }) => bars === this.current.row.bars) ?? this.current.row;
  }

  add(sort, bars, more = {}) {
    const height = HEIGHTS[sort];
    this.rows.push({ sort: sort === "more" ? "states" : sort, bars, y: this.height, height, isMarks: sort === "refusals", ...more });
    this.height += height + 3;
  }

  addAgent(lane) {
    const { name, slots, actions, refusals } = lane, isOpen = this.open.has(name);
    this.height += 3;
    const isChosen = this.context.selection.has({ agent: name }), head = { label: name, lane, isFirst: true, isOpen, isChosen };
    slots.forEach(({ states, levels, failures }, n) => {
      this.add(isOpen || n < FOLDED ? "states" : "more", states, n ? { failures } : { ...head, failures });
      if (isOpen) for (const level of levels) this.add("goals", level);
    });
    if (!slots.length) this.add("actions", actions.rows[0] ?? refusals, head);
    if (isOpen) for (const [n, row] of actions.rows.entries()) this.add("actions", row, { label: n ? "" : "  actions" });
    if (refusals.count) this.add("refusals", refusals, { label: this.mostRefused(lane) });
  }

  /** How often the plan of the user's programs that was refused most often was refused. */
  mostRefused({ name, refused }) {
    let most = [0, null];
    for (const [id, count] of refused) {
      const plan = this.minds.plan(name, id);
      if (plan && !plan.file?.startsWith("$") && count > most[0]) most = [count, plan];
    }
    return most[1] ? `${most[0]}× ${planName(most[1])} refused` : "";
  }

  /** Messages in view between agents that have lanes, with the heights of these. */
  arrows() {
    const { messages, axis } = this, heights = new Map(this.rows.filter(({ lane }) => lane).map(({ label, y, height }) => [label, y + height / 2]));
    return messages.sent.between(axis.from, axis.to)
      .map((message) => ({ message, from: heights.get(message.from), to: heights.get(message.to), x: axis.x(message.sent), end: axis.x(Math.min(message.read, message.sent + 5 * axis.grain)) }))
      .filter(({ from, to }) => from !== undefined && to !== undefined && from !== to);
  }

  // ---- pointer

  /** The message whose arrow is at a pixel, as a row of its own. */
  findMessage(x, y) {
    const found = this.arrows().findLast((each) => {
      const part = (y - each.from) / (each.to - each.from);
      return part >= 0 && part <= 1 && Math.abs(each.x + part * (each.end - each.x) - x) < THIN;
    });
    if (!found) return null;
    const { from, to, message } = found, bars = new Bars();
    bars.begin(message.sent, KIND.runs, { ...message, agent: message.from, cause: message.id });
    bars.end(message.read);
    return { row: { bars, sort: "messages", y: Math.min(from, to), height: Math.abs(to - from) }, index: 0 };
  }

  /** What is at a pixel: a row, and the bar in it; null for nothing. */
  find(x, y) {
    const { axis } = this, at = y + this.root.scrollTop, message = x < axis.left ? null : this.findMessage(x, at);
    if (message) return message;
    const row = this.rows.find((each) => at >= each.y - 1 && at <= each.y + each.height + 2);
    if (!row) return null;
    if (x < axis.left) return { row, index: -1 };
    const t = axis.t(x), failure = row.failures?.at(t, NEAR * axis.grain) ?? -1;
    if (failure >= 0) return { row: { ...row, bars: row.failures, sort: "failures" }, index: failure };
    const index = row.bars.at(t, NEAR * axis.grain);
    return index < 0 ? null : { row, index };
  }

  hover(x, y) {
    const found = x === null ? null : this.find(x, y);
    this.canvas.style.cursor = found ? "pointer" : "grab";
    this.point(found?.index >= 0 ? found : null, x);
  }

  click(x, y) {
    const found = this.find(x, y);
    if (!found) return x < this.axis.left;
    if (found.index >= 0) this.choose(found, this.axis.t(x));
    else if (found.row.lane) this.toggle(found.row.lane.name);
    return true;
  }

  toggle(name) {
    if (!this.open.delete(name)) this.open.add(name);
    this.context.time.notify();
  }

  /** Show the goals of the agent of a bar below its intentions, or hide them; returns the bar. */
  unfold(found) {
    const what = found.row.bars.whats[found.index], { agent } = what.root ?? what;
    if (this.lanes.agents.has(agent)) this.toggle(agent);
    return found;
  }

  /** Go to the moment `t`, and show why there is this bar. */
  choose({ row, index }, t) {
    const { bars } = row, what = bars.whats[index].root ?? bars.whats[index], { agent, intention, artifact, cause, id } = what;
    this.context.time.go(Math.max(bars.starts[index], Math.min(bars.ends[index], t)));
    showWhy(this.context, { agent, ...(intention === undefined ? {} : { intention }), ...(artifact ? { artifact, cause: id } : { cause }) });
  }

  /** Outline a bar, and tell about it. */
  point(found, x = found ? this.axis.x(found.row.bars.starts[found.index]) : 0) {
    const isSame = found?.row.bars.whats[found.index] === this.current?.row.bars.whats[this.current.index];
    this.current = found;
    this.tip.hidden = !found;
    if (found) this.tell(found, x);
    if (!isSame) this.context.time.notify();
  }

  tell({ row, index }, x) {
    const { bars } = row, [first, end] = this.together(row, index);
    const lines = barLines(row, first, end, index, this), box = this.root.getBoundingClientRect();
    this.tip.replaceChildren(element("b", "", lines[0]), ...lines.slice(1).map((line) => element("span", "", line)));
    setText(this.cursor, lines.join(". "));
    const { offsetWidth, offsetHeight } = this.tip, below = box.top + row.y - this.root.scrollTop + row.height + 6;
    this.tip.style.left = `${Math.max(8, Math.min(innerWidth - offsetWidth - 8, box.left + x - 20))}px`;
    this.tip.style.top = `${below + offsetHeight < innerHeight ? below : below - offsetHeight - row.height - 14}px`;
  }

  /** The bars that the tip describes together with one: of refused plans all in view, of failures those of one mark. */
  together({ bars, sort }, index) {
    const { axis } = this, from = sort === "refusals" ? axis.from : bars.starts[index], to = sort === "refusals" ? axis.to : from;
    let [first, end] = [index, index + 1];
    if (bars.isCounted) bars.each(from, to, sort === "refusals" ? Infinity : NEAR * axis.grain, (a, b) => { if (a <= index && index < b) [first, end] = [a, b]; });
    return [first, end];
  }

  // ---- keys

  firstBar() { return this.nearest(0, 1, this.context.time.now); }

  /** The bar nearest to `t` in the first row from `start` on that has one. */
  nearest(start, step, t) {
    for (let n = start; n >= 0 && n < this.rows.length; n += step) {
      const row = this.rows[n], index = row.bars.at(t, Infinity);
      if (index >= 0) return { row, index };
    }
    return null;
  }

  press(event) {
    const { current } = this;
    if (!current || event.ctrlKey || event.metaKey || event.altKey) return;
    const { row, index } = current, n = this.rows.findIndex(({ bars }) => bars === row.bars), t = row.bars.starts[index];
    const to = {
      ArrowUp: () => this.nearest(n - 1, -1, t), ArrowDown: () => this.nearest(n + 1, 1, t),
      ArrowLeft: () => ({ row, index: Math.max(0, index - 1) }), ArrowRight: () => ({ row, index: Math.min(row.bars.count - 1, index + 1) }),
      o: () => this.unfold(current),
    }[event.key]?.();
    if (to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    if (!to) return;
    const at = to.row.bars.starts[to.index], { axis, root } = this;
    if (!axis.has(at)) axis.show(at - axis.span / 2, at + axis.span / 2);
    root.scrollTop = Math.max(Math.min(root.scrollTop, to.row.y - 20), to.row.y + to.row.height + 20 - root.clientHeight);
    this.point(to);
  }
}
