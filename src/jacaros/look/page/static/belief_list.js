import { button, element, rounded } from "./elements.js";
import { showWhy } from "./jumps.js";
import { placeName } from "./link_words.js";
import { keyed, moveByArrows } from "./refill.js";
import { age } from "./section.js";
import { beliefKeys } from "./series_sources.js";

const MOST = 200;  // beliefs that are shown in one list
const MACHINERY = /^(?:focusing|joinedWsp|joined|current_wsp|connected)(?=\(|\[|$)/;  // what artifacts say about themselves
const ANNOTATION = /\[[^\]]*source\([^)]*\)[^\]]*\]$/;

/** The beliefs of an agent with a filter; recent changes come first and are marked. */
export class BeliefList {
  constructor(context) {
    this.context = context;
    this.filter = element("input", "search");
    Object.assign(this.filter, { type: "search", placeholder: "Filter beliefs", spellcheck: false });
    this.filter.setAttribute("aria-label", "Filter beliefs");
    this.filter.addEventListener("input", () => context.time.notify());
    this.head = [this.filter];
    this.hideEmpty = true;
  }

  count(mind, t) { return mind.beliefs.at(t).size; }

  stamp(mind, t) {
    const recent = mind.beliefs.between(t - 2, t);
    return `${mind.beliefs.countAt(t)} ${recent.length} ${this.filter.value} ${this.context.commands.can.has("console")} ${this.context.curves.stamp}`;
  }

  nodes(mind, t) {
    const wanted = this.filter.value.trim().toLowerCase(), fits = ({ belief }) => belief.toLowerCase().includes(wanted);
    const fitting = mind.beliefsAt(t).filter(fits), machinery = wanted ? [] : fitting.filter(({ belief }) => MACHINERY.test(belief));
    const held = fitting.filter((each) => !machinery.includes(each)), gone = mind.beliefsGone(t).filter(fits);
    const before = replaced(held, gone, mind, t);
    const rank = (belief) => (mind.isRecent(belief, t) ? 0 : 1);
    held.sort((a, b) => rank(a) - rank(b));
    const rows = [
      ...gone.filter((each) => !before.has(functor(each))).map((belief) => this.row(mind, { ...belief, since: belief.t }, "gone")),
      ...held.slice(0, MOST).map((belief) => this.row(mind, belief, rank(belief) ? "" : "recent", before.get(functor(belief)))),
    ];
    this.filter.hidden = mind.beliefs.at(t).size < 6 && !wanted;
    if (!rows.length && !machinery.length) return [element("p", "empty", wanted ? `No belief contains “${wanted}”.` : "No beliefs.")];
    const nodes = [this.list(rows)];
    if (held.length > MOST) nodes.push(element("p", "empty", `${held.length - MOST} more: use the filter.`));
    if (machinery.length) nodes.push(this.folded(mind, machinery));
    return nodes;
  }

  list(rows) {
    const list = element("ul", "beliefs", ...rows);
    moveByArrows(list, ".belief");
    return list;
  }

  /** What artifacts and workspaces say about themselves, in one row that unfolds. */
  folded(mind, machinery) {
    const names = [...new Set(machinery.map(functor))].join(", ");
    const summary = element("summary", "", `${machinery.length} about the environment: `, element("code", "", names));
    return keyed("machinery", element("details", "machinery", summary, this.list(machinery.map((belief) => this.row(mind, belief, "")))));
  }

  row(mind, belief, kind, before) {
    const { belief: text, since } = belief, key = `belief ${kind === "gone" ? "-" : ""}${text}`;
    const main = text.replace(ANNOTATION, ""), sign = { recent: "+", gone: "−" }[kind] ?? "";
    const name = element("span", "", element("code", "", rounded(main)));
    if (before && kind === "recent") name.append(element("s", "was", rounded(before.belief.replace(ANNOTATION, ""))));
    const row = button("belief", () => this.choose(mind, belief), element("span", "sign", sign), name, element("span", "by", ...this.by(belief, text)), age(since));
    row.title = `${kind === "gone" ? "removed: " : ""}${text}`;
    const item = element("li", kind, keyed(key, row));
    const { commands, actions, curves } = this.context, plot = kind !== "gone" && curves.button(beliefKeys(mind.name, text), main);
    if (plot) item.append(keyed(`${key} plot`, plot));
    if (commands.can.has("console") && kind !== "gone") {
      item.append(keyed(`${key} remove`, actions.button("×", `Remove ${main}`, () => commands.send("console", { agent: mind.name, text: `-${text}` }))));
    }
    return item;
  }

  by({ cause, file, line, since }, text) {
    if (file) return [placeName({ file, line })];
    const artifact = /artifact_name\(([^)]*)\)/.exec(text)?.[1], source = artifact ?? /source\(([^)]*)\)/.exec(text)?.[1];
    if (source && source !== "self") return [`from ${source === "percept" ? "perception" : source}`];
    return [cause ? "" : since < 0.5 ? "initial" : ""];
  }

  choose(mind, { belief, cause, intention, file, line, since }) {
    const agent = mind.name, what = `which changed ${rounded(belief.replace(ANNOTATION, ""))}`;
    if (file) {
      const id = this.context.causes.ofStep({ agent, intention, file, line, t: since, what, parent: cause ?? 0 });
      showWhy(this.context, { agent, file, line, cause: id });
    } else if (cause) showWhy(this.context, { agent, cause });
    else this.context.selection.choose({ agent });
  }
}

/** By functor: the belief that went when the only recent one came, which so is its new value. */
function replaced(held, gone, mind, t) {
  const came = new Map(), before = new Map();
  for (const each of held) if (mind.isRecent(each, t)) came.set(functor(each), (came.get(functor(each)) ?? 0) + 1);
  for (const each of gone) if (came.get(functor(each)) === 1) before.set(functor(each), each);
  return before;
}

function functor({ belief }) { return belief.replace(ANNOTATION, "").split("(")[0]; }
