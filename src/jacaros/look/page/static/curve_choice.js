import { button } from "./elements.js";
import { recall, remember } from "./memory.js";

const MOST = 4;  // curves that are drawn until you choose some
const TYPE = "application/x-jacaros-curve";

/** The sources that are drawn as curves; remembered, and in the address as `curves`. */
export class CurveChoice {
  constructor(sources, thresholds, time) {
    Object.assign(this, { sources, thresholds, time });
    const given = new URLSearchParams(location.hash.slice(1)).get("curves") ?? recall("curves");
    this.keys = given ? given.split(";") : null;
  }

  /** The sources that are drawn, in the order in which they were chosen. */
  get shown() {
    const chosen = this.sources.known(this.keys ?? []);
    return (chosen.length ? chosen : this.keys?.length === 0 ? [] : this.typical()).map((key) => this.sources.get(key));
  }

  /** What contexts compare, batteries first, and where the only robot is. */
  typical() {
    if (this.typicalOf === this.sources.version) return this.found;
    this.typicalOf = this.sources.version;
    const all = this.sources.shown(), robots = all.filter(({ key }) => key.startsWith("robot ")), compared = this.thresholds.compared();
    compared.sort((one, other) => (other.name === "battery") - (one.name === "battery"));
    const where = robots.filter(({ name, of }) => (name === "x" || name === "y") && robots.every((each) => each.of === of));
    const batteries = compared.some(({ name }) => name === "battery") ? [] : robots.filter(({ name }) => name === "battery");
    const found = [...[...compared, ...batteries].slice(0, MOST - where.length), ...where];
    this.found = (found.length ? found : all.slice(0, MOST)).map(({ key }) => key);
    return this.found;
  }

  has(keys) { return keys.every((key) => this.shown.some((each) => each.key === key)); }

  /** Draw these sources, too, or no longer when all of them are drawn. */
  toggle(keys) { this.set(keys, !this.has(keys)); }

  set(keys, isShown) {
    const others = this.shown.map(({ key }) => key).filter((key) => !keys.includes(key));
    this.keys = isShown ? [...others, ...keys] : others;
    remember("curves", this.keys.join(";"));
    this.time.notify();
  }

  /** The same as long as the same curves are drawn. */
  get stamp() { return this.shown.map(({ key }) => key).join(";"); }

  /** A button that draws what `keys` name as curves, or removes them; it can be dragged to the panel. Null without numbers. */
  button(named, what) {
    const keys = this.sources.known(named);
    if (!keys.length) return null;
    const made = button("act plot", () => this.toggle(keys), "∿"), isShown = this.has(keys);
    made.setAttribute("aria-pressed", String(isShown));
    made.setAttribute("aria-label", `Curve of ${what}`);
    made.title = `${isShown ? "Remove the curve" : "Draw a curve"} of ${what}`;
    return draggable(made, keys);
  }

  /** Let what is dragged to `panel` be drawn. */
  acceptDrops(panel) {
    panel.addEventListener("dragover", (event) => { if (event.dataTransfer.types.includes(TYPE)) event.preventDefault(); });
    panel.addEventListener("drop", (event) => {
      const keys = event.dataTransfer.getData(TYPE);
      if (!keys) return;
      event.preventDefault();
      this.set(this.sources.known(keys.split("\n")), true);
    });
  }
}

/** Let an element be dragged to the curves, when it has numbers. */
export function draggable(node, keys) {
  node.draggable = keys.length > 0;
  node.addEventListener("dragstart", ({ dataTransfer }) => dataTransfer.setData(TYPE, keys.join("\n")));
  return node;
}
