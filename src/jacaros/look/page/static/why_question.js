import { element } from "./elements.js";

const EXAMPLES = ["why is it standing still", "why did it fail", "did it achieve go(dock)", "+!go(dock)", "battery(X)"];

/** A question to the running system, and its answer.  Hidden where the system takes none, as in a recording. */
export class WhyQuestion {
  constructor(context) {
    this.context = context;
    this.field = element("input", "entry");
    Object.assign(this.field, { type: "text", spellcheck: false, placeholder: EXAMPLES[0] });
    this.field.setAttribute("aria-label", "Ask why");
    this.field.setAttribute("list", "questions");
    const examples = element("datalist", "", ...EXAMPLES.map((each) => new Option(each)));
    examples.id = "questions";
    this.ask = element("button", "plain", "Ask why");
    this.answer = element("pre", "answer");
    this.answer.setAttribute("role", "status");
    const form = element("form", "console-form", this.field, this.ask, examples);
    form.addEventListener("submit", (event) => { event.preventDefault(); this.submit(); });
    this.root = element("div", "question", form, this.answer);
  }

  show() { this.root.hidden = !this.context.commands.can.has("why"); }

  async submit() {
    const question = this.field.value.trim();
    if (!question) return;
    const result = await this.context.actions.run(this.field, () => this.context.commands.send("why", { question }));
    this.answer.textContent = Array.isArray(result) ? result.join("\n") : result ?? "";
  }
}
