import { button, element } from "./elements.js";
import { valueText } from "./environment.js";
import { keyed } from "./refill.js";
import { whyButton } from "./jumps.js";

const CUT = 150;  // characters of a question by which its operation is found

/** The open questions of agents to a person: a button for each option, or a field for any text. */
export class QuestionsView {
  constructor(root, context, environment) {
    Object.assign(this, { root, context, environment, showsAlways: true });
    this.cards = new Map();  // by artifact and number: typed text must stay when another question comes
  }

  show(t) {
    const open = this.openAt(t);
    for (const [key, card] of this.cards) {
      if (!open.has(key)) this.remove(key, card);
    }
    for (const [key, question] of open) {
      if (!this.cards.has(key)) this.cards.set(key, this.root.appendChild(this.card(key, question)));
    }
    const canAnswer = this.context.commands.can.has("answer");
    for (const control of this.root.querySelectorAll(".answers :is(button, input)")) control.disabled = !canAnswer;
  }

  openAt(t) {
    const found = new Map();
    for (const artifact of this.environment.artifacts.values()) {
      if (artifact.type !== "Operator" || !artifact.isThere(t)) continue;
      for (const { name, values } of artifact.propertiesAt(t)) {
        if (name === "question") found.set(`${artifact.path} ${values[0]}`, { artifact, values, t });
      }
    }
    return found;
  }

  card(key, { artifact, values: [number, text, options], t }) {
    const call = `ask("${text.replace(/[\\"]/g, "\\$&")}`.slice(0, CUT), asking = artifact.runningAt(t).find(({ operation }) => operation.startsWith(call));
    const send = (control, given) => this.context.actions.run(control, () => this.context.commands.send("answer", { question: `${artifact.path}-${number}`, given }));
    const answers = Array.isArray(options) && options.length ? this.choices(options.map(valueText), send) : this.field(send);
    const made = element("div", "asked card", element("p", "", element("b", "who", asking?.agent ?? artifact.name), ` asks: ${text} `,
      whyButton(this.context, { artifact: artifact.path, cause: asking?.id }, key)), answers);
    made.setAttribute("role", "group");
    made.setAttribute("aria-label", `question ${number}: ${text}`);
    return keyed(key, made);
  }

  choices(options, send) {
    return element("div", "answers", ...options.map((option, index) => {
      const made = button("plain", () => send(made, index + 1), option);
      return made;
    }));
  }

  field(send) {
    const entry = element("input", "entry"), form = element("form", "answers", entry, element("button", "plain", "Answer"));
    entry.type = "text";
    entry.setAttribute("aria-label", "Answer");
    form.addEventListener("submit", (event) => {
      event.preventDefault();
      if (entry.value.trim()) send(entry, entry.value);
    });
    return form;
  }

  /** Remove an answered question; the focus moves to the next one. */
  remove(key, card) {
    const hadFocus = card.contains(document.activeElement);
    card.remove();
    this.cards.delete(key);
    if (hadFocus) this.root.querySelector(".answers :is(button, input)")?.focus();
  }
}
