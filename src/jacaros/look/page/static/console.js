import { button, element } from "./elements.js";

const KEPT = 100;  // lines of input and output
const PERFORMATIVES = ["tell", "untell", "achieve", "unachieve", "signal", "askOne", "askAll", "tellHow", "untellHow"];

/** A line of AgentSpeak, or a message, for the selected agent.  Only for running agents, when the run allows it. */
export class Console {
  constructor(context) {
    this.context = context;
    this.lines = [];
    this.place = 0;
    this.output = element("ol", "output");
    this.output.setAttribute("aria-label", "Answers");
    this.output.setAttribute("role", "log");
    this.how = element("select", "how");
    this.how.setAttribute("aria-label", "What to do with the line");
    this.field = element("input", "entry");
    Object.assign(this.field, { type: "text", spellcheck: false, autocomplete: "off", autocapitalize: "off" });
    this.field.setAttribute("aria-label", "AgentSpeak");
    this.form = element("form", "console-form", this.how, this.field, send());
    this.root = element("div", "console", this.output, this.form);
    this.form.addEventListener("submit", (event) => { event.preventDefault(); this.submit(); });
    this.field.addEventListener("keydown", (event) => this.press(event));
    this.how.addEventListener("change", () => this.prompt());
    this.allow();
    context.commands.onChange(() => this.allow());
  }

  allow() {
    const { can } = this.context.commands;
    const choices = [...(can.has("console") ? ["AgentSpeak"] : []), ...(can.has("message") ? PERFORMATIVES : [])];
    this.isAllowed = choices.length > 0;
    this.how.replaceChildren(...choices.map((each) => new Option(each === "AgentSpeak" ? each : `send ${each}`, each)));
    this.prompt();
  }

  prompt() { this.field.placeholder = this.how.value === "AgentSpeak" ? "?battery(X)   !go(dock)   +ready" : "content of the message"; }

  show(mind, t) {
    this.root.hidden = !this.isAllowed || !mind.runsAt(t);
    if (mind.name === this.agent) return;
    this.agent = mind.name;
    this.output.replaceChildren();
  }

  async submit() {
    const text = this.field.value.trim(), how = this.how.value;
    if (!text) return;
    this.lines.push(text);
    this.lines.splice(0, this.lines.length - KEPT);
    this.place = this.lines.length;
    this.field.value = "";
    this.write("asked", how === "AgentSpeak" ? text : `${how} ${text}`);
    try {
      const { commands } = this.context;
      const result = how === "AgentSpeak" ? await commands.send("console", { agent: this.agent, text })
        : await commands.send("message", { agent: this.agent, performative: how, text });
      this.write("answer", String(result ?? "sent"));
    } catch (error) { this.write("error", error.message); }
  }

  write(kind, text) {
    this.output.append(element("li", kind, text));
    while (this.output.children.length > KEPT) this.output.firstElementChild.remove();
    this.output.scrollTop = this.output.scrollHeight;
  }

  /** The arrow keys bring back earlier lines. */
  press(event) {
    const step = { ArrowUp: -1, ArrowDown: 1 }[event.key];
    if (!step) return;
    event.preventDefault();
    event.stopPropagation();
    this.place = Math.min(this.lines.length, Math.max(0, this.place + step));
    this.field.value = this.lines[this.place] ?? "";
  }
}

function send() {
  const made = button("plain", () => {}, "Send");
  made.type = "submit";
  return made;
}
