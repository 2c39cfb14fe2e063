import { element, setText } from "./elements.js";
import { LongList } from "./long_list.js";

const FEW = 8;  // items that need no search

/** Chooses one of many things by name: a list, and above a long one a search box. */
export class Picker {
  /** @param {string} things what is chosen, such as "agents". */
  constructor(things, fill, choose) {
    this.things = things;
    this.list = new LongList(things, fill, choose);
    this.search = element("input", "search");
    Object.assign(this.search, { type: "search", placeholder: `Find ${things}`, spellcheck: false });
    this.search.setAttribute("aria-label", `Find ${things} by name`);
    this.none = element("p", "empty");
    this.root = element("div", "picker", this.search, this.list.root, this.none);
    this.search.addEventListener("input", () => { this.isStale = true; this.onSearch?.(); });
    this.search.addEventListener("keydown", (event) => { if (event.key === "ArrowDown") this.list.root.focus(); });
  }

  /** Show these items, each with a `name`, of which the one named `chosen` is selected. */
  show(items, chosen) {
    const many = items.length > FEW, wanted = many ? this.search.value.trim().toLowerCase() : "";
    const found = wanted ? items.filter(({ name }) => name.toLowerCase().includes(wanted)) : items;
    this.root.hidden = items.length < 2;
    this.search.hidden = !many;
    this.none.hidden = found.length > 0;
    setText(this.none, found.length ? "" : `No ${this.things} with “${this.search.value.trim()}” in the name.`);
    if (!this.root.hidden) this.list.set(found, found.findIndex(({ name }) => name === chosen));
  }
}
