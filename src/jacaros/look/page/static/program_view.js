import { coloured, commented } from "./asl_colours.js";
import { button, element, setText } from "./elements.js";
import { shortName } from "./link_words.js";
import { moveByArrows } from "./refill.js";

const MANY = 40;  // agents above which only the selected one is shown in the program

/** The text of a program: current lines, lines and plans that ran and that never ran, breakpoints. */
export class ProgramView {
  constructor(root, context, minds) {
    Object.assign(this, { root, context, minds });
    this.files = element("select");
    this.files.setAttribute("aria-label", "File");
    this.files.addEventListener("change", () => {
      this.follow.checked = false;
      context.selection.choose({ ...this.agentOnly(), file: this.files.value });
    });
    this.follow = element("input");
    Object.assign(this.follow, { type: "checkbox", checked: true });
    this.follow.addEventListener("change", () => {
      this.seen = undefined;
      if (this.follow.checked) context.selection.choose(this.agentOnly());
    });
    this.whose = element("span", "whose");
    this.text = element("div", "listing");
    this.text.setAttribute("role", "list");
    this.text.setAttribute("aria-label", "Lines");
    this.text.tabIndex = 0;  // long lines are scrolled with the arrow keys
    this.legend = legend();
    root.append(element("div", "program-head", this.files, this.whose, element("label", "only", this.follow, " follow the current step")), this.text, this.legend);
    moveByArrows(this.text, ".number");
    this.lines = [];
    context.commands.onChange(() => { this.drawn = undefined; });
  }

  get empty() { return this.minds.sources.size === 0; }

  agentOnly() {
    const { agent } = this.context.selection.current;
    return agent === undefined ? {} : { agent };
  }

  show(t) {
    const agents = this.agents(t), file = this.file(agents, t);
    this.showFiles(file);
    this.draw(file);
    this.mark(file, agents, t);
    this.reveal(file);
  }

  /** The agents whose lines are shown: the selected one, else all, unless there are many. */
  agents() {
    const { agent } = this.context.selection.current, all = [...this.minds.agents.values()];
    const chosen = all.filter(({ name }) => name === agent);
    if (chosen.length) return chosen;
    return all.length > MANY ? all.slice(0, 1) : all;
  }

  file(agents, t) {
    const { file } = this.context.selection.current;
    if (this.minds.sources.has(file)) return file;
    const [first] = agents, plans = first?.program(t).plans ?? [];
    const own = first?.intentionsAt(t)[0]?.stack?.at(-1)?.file ?? plans.find((plan) => this.minds.sources.has(plan.file))?.file;
    if (this.minds.sources.has(this.shown) && (agents.length > 1 || !this.follow.checked)) return this.shown;
    return this.minds.sources.has(own) ? own : this.minds.sources.keys().next().value;
  }

  showFiles(file) {
    if (this.listed !== this.minds.sources.size) {
      this.listed = this.minds.sources.size;
      this.files.replaceChildren(...[...this.minds.sources.keys()].map((each) => new Option(fileTitle(each, this.minds.sources), each)));
    }
    this.files.value = file;
    this.files.title = file;
  }

  draw(file) {
    const lines = this.minds.lines(file);
    if (lines === this.drawn) return;
    this.drawn = lines;
    this.shown = file;
    const inside = commented(lines), settable = this.context.breakpoints.allowed;
    this.lines = lines.map((line, n) => this.line(file, n + 1, coloured(line, inside[n]), settable));
    this.text.replaceChildren(...this.lines);
    this.marked = undefined;
  }

  line(file, number, parts, settable) {
    const at = { line: { file, line: number } };
    const head = settable ? button("number", () => this.toggle(at, head), String(number)) : element("span", "number", String(number));
    if (settable) {
      head.tabIndex = number === 1 ? 0 : -1;
      head.setAttribute("aria-label", `Breakpoint on line ${number}`);
      head.setAttribute("aria-pressed", "false");
    }
    const made = element("div", "code-line", head, element("span", "sign"), element("code", "", ...parts));
    made.setAttribute("role", "listitem");
    return made;
  }

  toggle(at, head) {
    const { breakpoints, actions } = this.context;
    actions.run(head, () => breakpoints.change(at, breakpoints.has(at) ? "remove" : "add"));
  }

  mark(file, agents, t) {
    const { selection, breakpoints } = this.context, { line } = selection.current;
    const stamp = `${file} ${breakpoints.version} ${line} ${agents.map((mind) => `${mind.name} ${mind.stamp(t)} ${mind.decisionsAt(t)}`).join()}`;
    if (stamp === this.marked) return;
    this.marked = stamp;
    const marks = marksOf(file, agents, t), chosen = selection.current.file === file ? line : undefined;
    this.lines.forEach((each, n) => this.markLine(each, marks.get(n + 1) ?? {}, { number: n + 1, isChosen: chosen === n + 1, isHeld: breakpoints.has({ line: { file, line: n + 1 } }) }));
    const runners = agents.filter((mind) => mind.program(t).plans.some((plan) => plan.file === file));
    setText(this.whose, runners.length === 1 ? `as ${runners[0].name} runs it` : runners.length ? `as ${runners.length} agents run it` : "");
  }

  markLine(line, { current, under, ran, plan }, { number, isChosen, isHeld }) {
    const name = `code-line ${plan ?? ""} ${ran ? "ran" : ""} ${current ? "current" : under ? "under" : ""} ${isChosen ? "chosen" : ""} ${isHeld ? "held" : ""}`;
    if (line.className === name) return;
    line.className = name;
    const sign = line.children[1];
    setText(sign, current ? "▶" : under ? "▷" : "");
    sign.title = current ? `current step of ${[...current].join(", ")}` : under ? `waits for a goal above it: ${[...under].join(", ")}` : "";
    if (line.firstElementChild.tagName === "BUTTON") {
      line.firstElementChild.setAttribute("aria-pressed", String(isHeld));
      line.firstElementChild.setAttribute("aria-label", `Breakpoint on line ${number}${current ? ", current line" : ""}`);
    }
    if (current) line.setAttribute("aria-current", "step"); else line.removeAttribute("aria-current");
  }

  /** Scroll to the selected line once, and to the current line whenever it is another one. */
  reveal(file) {
    const { line, file: wanted } = this.context.selection.current, key = `${wanted}:${line}`, isNew = key !== this.revealed;
    this.revealed = key;
    if (wanted === file && line) {
      if (isNew) this.scrollTo(this.lines[line - 1]);
      return;
    }
    const current = this.follow.checked ? this.lines.findIndex((each) => each.classList.contains("current")) : -1;
    if (current < 0 || this.seen === `${file}:${current}`) return;
    this.seen = `${file}:${current}`;
    this.scrollTo(this.lines[current]);
  }

  /** Scroll the panel, but not the page, so that a line is in the middle. */
  scrollTo(line) {
    if (!line) return;
    const box = line.getBoundingClientRect(), outer = this.root.getBoundingClientRect();
    this.root.scrollTop += box.top - outer.top - (outer.height - box.height) / 2;
  }
}

/** The name of a file without its folder, which is shown only where two files have the same name. */
function fileTitle(file, all) {
  if (file.startsWith("$")) return file;
  const name = shortName(file);
  return [...all.keys()].some((each) => each !== file && shortName(each) === name) ? file : name;
}

/** By line: the agents whose current step it is, and those that will come back to it; whether it ran, and its plan. */
function marksOf(file, agents, t) {
  const marks = new Map(), at = (line) => {
    if (!marks.has(line)) marks.set(line, {});
    return marks.get(line);
  };
  for (const mind of agents) {
    for (const plan of mind.program(t).plans) {
      if (plan.file === file) markPlan(at, plan, mind.use.chosen(plan.id, t) > 0);
    }
    for (const [line, first] of mind.ran.get(file) ?? []) if (first <= t) at(line).ran = true;
    for (const { stack = [] } of mind.intentionsAt(t)) {
      stack.forEach((level, n) => { if (level.file === file) markStep(at(level.line), n === stack.length - 1 ? "current" : "under", mind.name); });
    }
  }
  return marks;
}

function markPlan(at, { line, end }, hasRun) {
  for (let each = line; each <= (end || line); each++) {
    const mark = at(each);
    if (hasRun) mark.plan = "used"; else mark.plan ??= "unused";
  }
}

function markStep(mark, kind, agent) { (mark[kind] ??= new Set()).add(agent); }

function legend() {
  const item = (kind, sign, text) => element("li", "", element("i", `swatch ${kind}`, sign), text);
  return element("ul", "legend", item("current", "▶", "current step"), item("used", "", "its plan ran"), item("unused", "", "its plan never ran"), item("held", "●", "breakpoint"));
}
