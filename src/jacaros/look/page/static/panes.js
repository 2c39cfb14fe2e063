import { element } from "./elements.js";
import { recall, remember } from "./memory.js";

const LEAST = 12, MOST = 88, STEP = 3;  // percent of both panes together

/** A bar between two panes that divides their room: drag it, or use the arrow keys; a double click or Enter resets it. */
export class Divider {
  /** @param {string} name of what the bar changes, such as "Height of the log". */
  constructor(before, after, name) {
    Object.assign(this, { before, after, name });
    this.bar = element("div", "divider");
    this.bar.tabIndex = 0;
    this.bar.hidden = true;  // until the division is the one that you chose
    for (const [key, value] of Object.entries({ "role": "separator", "aria-label": name, "aria-controls": after.id, "aria-valuemin": LEAST, "aria-valuemax": MOST })) {
      this.bar.setAttribute(key, String(value));
    }
    after.before(this.bar);
    this.bar.addEventListener("pointerdown", (event) => this.bar.setPointerCapture(event.pointerId));
    this.bar.addEventListener("pointermove", (event) => { if (this.bar.hasPointerCapture(event.pointerId)) this.drag(event); });
    this.bar.addEventListener("dblclick", () => this.divide(null));
    this.bar.addEventListener("keydown", (event) => this.press(event));
  }

  /** Whether the panes are side by side: a wide or a narrow window arranges them in another way. */
  get isAcross() { return getComputedStyle(this.bar.parentElement).flexDirection.startsWith("row"); }

  /** Hide the bar unless both panes are shown; otherwise bring back the division that you chose. */
  show() {
    const isUseful = this.before.checkVisibility() && this.after.checkVisibility(), across = this.isAcross;
    if (isUseful === this.bar.hidden || across !== this.across) {
      this.bar.hidden = !isUseful;
      this.across = across;
      this.bar.setAttribute("aria-orientation", across ? "vertical" : "horizontal");
      this.apply(recall(this.key));
    }
  }

  get key() { return `${this.name} ${this.across ? "across" : "down"}`; }

  /** Percent that the second pane has now. */
  get share() {
    const [a, b] = [this.before, this.after].map((pane) => pane.getBoundingClientRect()[this.across ? "width" : "height"]);
    return 100 * b / Math.max(1, a + b);
  }

  drag({ clientX, clientY }) {
    const from = this.before.getBoundingClientRect(), to = this.after.getBoundingClientRect();
    this.divide(this.across ? 100 * (to.right - clientX) / (to.right - from.left) : 100 * (to.bottom - clientY) / (to.bottom - from.top));
  }

  press(event) {
    const back = { ArrowLeft: 1, ArrowUp: 1, ArrowRight: -1, ArrowDown: -1 }[event.key];
    const share = back ? this.share + back * STEP : { Home: MOST, End: LEAST, Enter: null }[event.key];
    if (share === undefined) return;
    event.preventDefault();
    event.stopPropagation();
    this.divide(share);
  }

  /** Give the second pane a share in percent; null: its share by default. */
  divide(share) {
    const text = share === null ? "" : Math.min(MOST, Math.max(LEAST, share)).toFixed(1);
    remember(this.key, text);
    this.apply(text);
  }

  apply(share) {
    this.after.classList.toggle("divided", Boolean(share));
    if (share) this.after.style.setProperty("--share", `${share}%`); else this.after.style.removeProperty("--share");
    this.bar.setAttribute("aria-valuenow", String(Math.round(this.share)));
  }
}
