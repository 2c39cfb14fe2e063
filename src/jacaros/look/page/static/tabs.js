import { button } from "./elements.js";
import { recall, remember } from "./memory.js";
import { paced } from "./paced.js";

/**
 * The panels beside the map, one at a time: a list of tabs as the ARIA practices describe it (arrow keys move).
 *
 * A panel without content has no tab.
 */
export class Tabs {
  /** @param {Array<[HTMLElement, object]>} panels elements with their views; a view without content is `empty`. */
  constructor(list, panels, context) {
    this.list = list;
    this.time = context.time;
    this.panels = panels.map(([panel, view]) => ({ panel, view, show: paced((t) => view.show(t)), tab: this.makeTab(panel) }));
    this.chosen = recall("tab");
    list.addEventListener("keydown", (event) => this.press(event));
    list.addEventListener("scroll", () => this.showEdges());
    list.addEventListener("wheel", ({ deltaY }) => { list.scrollLeft += deltaY; }, { passive: true });
    new ResizeObserver(() => this.reveal()).observe(list);
  }

  makeTab(panel) {
    const tab = button("tab", () => this.open(panel.id), panel.dataset.title);
    tab.id = `tab-${panel.id}`;
    tab.hidden = true;
    tab.setAttribute("role", "tab");
    tab.setAttribute("aria-controls", panel.id);
    panel.setAttribute("role", "tabpanel");
    panel.setAttribute("aria-labelledby", tab.id);
    panel.tabIndex = 0;
    this.list.append(tab);
    return tab;
  }

  /** Open a panel by its id, for example from a view: `context.open("causes")`. */
  open(id) {
    this.chosen = id;
    remember("tab", id);
    this.arrange();
    this.time.notify();
  }

  /** Panels that have something to show. */
  get available() { return this.panels.filter(({ view }) => !view.empty); }

  arrange() {
    const available = this.available;
    const open = available.find(({ panel }) => panel.id === this.chosen) ?? available[0];
    const tabs = `${open?.panel.id}: ${available.map(({ panel }) => panel.id)}`;
    for (const each of this.panels) {
      each.tab.hidden = !available.includes(each);
      each.panel.hidden = each !== open;
      each.tab.tabIndex = each === open ? 0 : -1;
      each.tab.setAttribute("aria-selected", String(each === open));
    }
    if (tabs !== this.arranged) {
      this.arranged = tabs;
      this.reveal();
    }
    if (open !== this.shown) {
      this.shown = open;
      open?.view.opened?.();
    }
    return open;
  }

  /** Scroll the row of tabs, if it is longer than its room, so that the open one is seen. */
  reveal() {
    const tab = this.list.querySelector("[aria-selected=true]"), { list } = this;
    if (!tab) return;
    const box = tab.getBoundingClientRect(), room = list.getBoundingClientRect();
    if (box.left < room.left || box.right > room.right) list.scrollLeft += box.left - room.left - (room.width - box.width) / 2;
    this.showEdges();
  }

  /** Fade the row of tabs at the sides where there are more of them. */
  showEdges() {
    const { scrollLeft, clientWidth, scrollWidth, classList } = this.list;
    classList.toggle("more-before", scrollLeft > 1);
    classList.toggle("more-after", scrollLeft + clientWidth < scrollWidth - 1);
  }

  show(t) { this.arrange()?.show(t); }

  press(event) {
    const tabs = this.available.map(({ tab }) => tab), at = tabs.indexOf(document.activeElement);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (at < 0 || to === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    const tab = tabs[(to + tabs.length) % tabs.length];
    this.open(tab.getAttribute("aria-controls"));
    tab.focus();
  }
}
