import { element } from "./elements.js";

/** A button that unfolds a small window below it; Escape, and a click elsewhere, close it. */
export class Popover {
  constructor(title, ...content) {
    this.summary = element("summary", "plain", title);
    this.window = element("div", "window", ...content);
    this.root = element("details", "popover", this.summary, this.window);
    // On the document: the focus is nowhere when the button that had it is gone.
    document.addEventListener("keydown", (event) => {
      if (event.key !== "Escape" || !this.root.open) return;
      this.close();
      this.summary.focus();
    });
    document.addEventListener("pointerdown", (event) => { if (!this.root.contains(event.target)) this.close(); });
  }

  close() { this.root.open = false; }
}
