import { element } from "./elements.js";
import { keyed, refill } from "./refill.js";

const PERIOD = 1000;  // milliseconds between two looks at goals that have not ended
const OVER = new Set(["achieved", "failed", "refused", "cancelled"]);

/** The goals that the selected agent offers, as forms, and what became of those that callers gave it. */
export class OfferedGoals {
  constructor(context) {
    this.context = context;
    this.forms = element("div", "forms");
    this.given = element("ul", "given");
    this.given.setAttribute("aria-label", "Requested goals");
    this.root = element("details", "section offered", element("summary", "", "Offered goals"), this.forms, this.given);
    this.root.open = true;
  }

  show(mind, t) {
    const { commands, time } = this.context;
    const isLive = commands.can.has("achieve") && mind.runsAt(t) && time.live;
    this.root.hidden = !isLive || !this.forms.hasChildNodes();
    if (!isLive) return;
    if (mind.name !== this.agent) this.load(mind.name);
    const count = mind.goals.countAt(t);
    if (count !== this.count) this.lookSoon();
    this.count = count;
  }

  async load(agent) {
    this.agent = agent;
    this.forms.replaceChildren();
    const offers = await this.send("offers", { agent }).catch(() => []);
    if (agent !== this.agent) return;
    this.forms.replaceChildren(...offers.map((offer) => this.form(offer)));
    this.root.hidden = !offers.length;
    this.look();
  }

  send(command, args) { return this.context.commands.send(command, args); }

  form({ name, doc, schema }) {
    const fields = Object.entries(schema.properties).map(([key, kind]) => new Field(key, kind));
    const submit = element("button", "plain", name), labels = fields.map(({ label }) => label);
    const made = element("form", "numbers", submit, ...labels, element("span", "doc", doc));
    submit.title = doc;
    made.addEventListener("submit", (event) => {
      event.preventDefault();
      const args = Object.fromEntries(fields.map((field) => [field.name, field.value]));
      this.context.actions.run(submit, async () => {
        await this.send("achieve", { agent: this.agent, goal: name, arguments: args });
        this.look();
      });
    });
    return made;
  }

  lookSoon() { this.timer ??= setTimeout(() => this.look(), PERIOD); }

  async look() {
    clearTimeout(this.timer);
    this.timer = undefined;
    if (!this.forms.hasChildNodes()) return;
    const all = await this.send("goals").catch(() => []), goals = all.filter(({ agent }) => agent === this.agent);
    refill(this.given, goals.reverse().map((goal) => this.item(goal)));
    if (goals.some(({ state }) => !OVER.has(state))) this.lookSoon();
  }

  item(goal) {
    const { id, caller, written, state, progress } = goal, item = element("li", state, element("code", "", written), " ", element("b", "", state));
    if (progress !== null && !OVER.has(state)) item.append(" ", bar(progress));
    item.append(element("span", "note", ` ${noteOf(goal)}`));
    if (!OVER.has(state)) item.append(keyed(id, this.context.actions.button("Cancel", `Cancel ${written}`, () => this.send("cancel", { goal: id }).then(() => this.look()))));
    item.title = `asked by ${caller}`;
    return item;
  }
}

/** What the agent says about a goal: how far it is, its results, or why it was refused or has failed. */
function noteOf({ state, note, message, results }) {
  if (state === "achieved") return Object.entries(results).map(([name, value]) => `${name} = ${JSON.stringify(value)}`).join(", ");
  return OVER.has(state) ? message : note;
}

function bar(fraction) {
  const made = element("progress");
  made.value = fraction;
  return made;
}

/** A field for an argument, as its JSON schema says. */
class Field {
  constructor(name, kind) {
    Object.assign(this, { name, kind });
    this.input = kind.enum ? element("select", "", ...kind.enum.map((each) => new Option(each))) : this.entry();
    this.label = element("label", "", `${name} `, this.input);
    this.label.title = kind.description ?? "";
  }

  entry() {
    const { type, minimum = "", maximum = "" } = this.kind, made = element("input");
    if (type === "boolean") return Object.assign(made, { type: "checkbox" });
    made.required = type !== "string";
    if (type !== "number" && type !== "integer") return Object.assign(made, { type: "text", placeholder: type === "string" ? "" : "JSON" });
    return Object.assign(made, { type: "number", step: type === "integer" ? "1" : "any", min: minimum, max: maximum });
  }

  get value() {
    const { type, enum: choices } = this.kind;
    if (choices || type === "string") return this.input.value;
    if (type === "boolean") return this.input.checked;
    return type === "number" || type === "integer" ? this.input.valueAsNumber : parsed(this.input.value);
  }
}

function parsed(text) {
  try { return JSON.parse(text); } catch { return text; }
}
