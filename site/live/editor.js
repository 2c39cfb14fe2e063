import { coloured, commented } from "./page/asl_colours.js";

/** A text field for a program, over the same text in colours. */
export class Editor {
  constructor(label) {
    this.root = document.createElement("div");
    this.root.className = "jl-editor";
    this.colours = document.createElement("pre");
    this.colours.setAttribute("aria-hidden", "true");
    this.field = document.createElement("textarea");
    Object.assign(this.field, { spellcheck: false, autocapitalize: "off", autocomplete: "off", wrap: "off" });
    this.field.setAttribute("aria-label", label);
    this.field.addEventListener("input", () => this.draw());
    this.field.addEventListener("scroll", () => {
      this.colours.scrollTop = this.field.scrollTop;
      this.colours.scrollLeft = this.field.scrollLeft;
    });
    this.root.append(this.colours, this.field);
  }

  get text() { return this.field.value; }

  set text(text) {
    this.field.value = text;
    this.draw();
  }

  draw() {
    const lines = this.text.split("\n"), inside = commented(lines);
    this.colours.replaceChildren(...lines.flatMap((line, n) => [...coloured(line, inside[n]), "\n"]));
  }
}
