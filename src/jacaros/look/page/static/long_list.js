import { element } from "./elements.js";

const ROW = 30;  // pixels
const AROUND = 4;  // rows beyond the visible ones

/**
 * A list box of which only the visible rows are in the document, so that it may have thousands.
 *
 * The arrow keys, Page Up, Page Down, Home and End choose another row, as in every list box.
 */
export class LongList {
  /**
   * @param {string} label of the list.
   * @param {function(HTMLElement, object)} fill writes an item into a row.
   * @param {function(object)} choose is called with the item that the user chose.
   */
  constructor(label, fill, choose) {
    Object.assign(this, { fill, choose, items: [], selected: -1, rows: [] });
    this.sheet = element("div", "sheet");
    this.sheet.setAttribute("role", "presentation");
    this.root = element("div", "long-list", this.sheet);
    this.root.setAttribute("role", "listbox");
    this.root.setAttribute("aria-label", label);
    this.root.tabIndex = 0;
    this.id = `list-${label.toLowerCase().replace(/\W+/g, "-")}`;
    this.root.addEventListener("scroll", () => this.show());
    this.root.addEventListener("keydown", (event) => this.press(event));
    this.sheet.addEventListener("click", (event) => {
      const row = event.target.closest(".item");
      if (row) this.choose(this.items[Number(row.dataset.index)]);
    });
  }

  /** Show these items; `selected` is the index of the chosen one, -1 for none. */
  set(items, selected) {
    this.items = items;
    this.sheet.style.height = `${items.length * ROW}px`;
    if (selected !== this.selected && selected >= 0 && this.root.clientHeight) this.reveal(selected);
    this.selected = selected;
    this.show();
  }

  show() {
    const height = this.root.clientHeight || 6 * ROW;
    const first = Math.max(0, Math.floor(this.root.scrollTop / ROW) - AROUND);
    const count = Math.min(this.items.length - first, Math.ceil(height / ROW) + 2 * AROUND);
    while (this.rows.length < count) this.addRow();
    while (this.rows.length > Math.max(0, count)) this.rows.pop().remove();
    this.rows.forEach((row, n) => this.showRow(row, first + n));
    const active = this.rows.find((row) => Number(row.dataset.index) === this.selected);
    if (active) this.root.setAttribute("aria-activedescendant", active.id);
    else this.root.removeAttribute("aria-activedescendant");
  }

  addRow() {
    const row = element("div", "item");
    row.setAttribute("role", "option");
    this.rows.push(row);
    this.sheet.append(row);
  }

  showRow(row, index) {
    if (row.dataset.index !== String(index)) {
      row.dataset.index = String(index);
      row.id = `${this.id}-${index}`;
      row.style.transform = `translateY(${index * ROW}px)`;
      row.setAttribute("aria-posinset", String(index + 1));
    }
    row.setAttribute("aria-setsize", String(this.items.length));
    row.setAttribute("aria-selected", String(index === this.selected));
    this.fill(row, this.items[index]);
  }

  reveal(index) {
    const top = index * ROW, bottom = top + ROW, { scrollTop, clientHeight } = this.root;
    if (top < scrollTop) this.root.scrollTop = top;
    else if (bottom > scrollTop + clientHeight) this.root.scrollTop = bottom - clientHeight;
  }

  press(event) {
    const page = Math.max(1, Math.floor(this.root.clientHeight / ROW) - 1), last = this.items.length - 1;
    const to = {
      ArrowDown: this.selected + 1, ArrowUp: this.selected - 1, PageDown: this.selected + page, PageUp: this.selected - page,
      Home: 0, End: last,
    }[event.key];
    if (to === undefined || last < 0 || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    this.choose(this.items[Math.min(last, Math.max(0, to))]);
  }
}
