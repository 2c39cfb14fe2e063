import { BeliefList } from "./belief_list.js";
import { Console } from "./console.js";
import { button, element, setText } from "./elements.js";
import { IntentionCards } from "./intention_cards.js";
import { MailList, RuleList } from "./mind_lists.js";
import { OfferedGoals } from "./offered_goals.js";
import { Picker } from "./picker.js";
import { PlanList } from "./plan_list.js";
import { Section } from "./section.js";

/** The agents: a list of all of them, and the mind of the selected one. */
export class AgentsView {
  constructor(root, context, { minds, links }) {
    Object.assign(this, { root, context, minds, links });
    this.chosen = null;
    this.picker = new Picker("agents", (row, item) => this.fillRow(row, item), ({ name }) => context.selection.choose({ agent: name }));
    this.picker.onSearch = () => this.show(this.t);
    this.name = element("h2");
    this.about = element("span", "about");
    this.robots = element("span", "robots-used");
    this.console = new Console(context);
    this.offered = new OfferedGoals(context);
    this.sections = [
      new Section("Intentions", new IntentionCards(context)),
      new Section("Beliefs", new BeliefList(context)),
      new Section("Mailbox", new MailList(context)),
      new Section("Rules", new RuleList(), false),
      new Section("Plans", new PlanList(context), false),
    ];
    this.mind = element("div", "mind", element("div", "mind-head", this.name, this.about, this.robots), this.console.root, this.offered.root, ...this.sections.map(({ root: each }) => each));
    root.append(this.picker.root, this.mind);
  }

  get empty() { return this.minds.agents.size === 0; }

  show(t) {
    this.t = t;
    const mind = this.choose(t);
    this.mind.hidden = !mind;
    if (!mind) return;
    this.showList(mind);
    setText(this.name, mind.name);
    setText(this.about, [mind.what === "python" ? "Python" : "", mind.runsAt(t) ? "" : "ended"].filter(Boolean).join(", "));
    this.showRobots(mind, t);
    this.console.show(mind, t);
    this.offered.show(mind, t);
    for (const section of this.sections) section.show(mind, t);
  }

  /** The selected agent, or one of the selected robot, else the one that was shown last. */
  choose(t) {
    const { agent, robot } = this.context.selection.current, { agents } = this.minds;
    const wanted = agent ?? (robot === undefined ? undefined : this.links.agents(robot, t)[0]);
    if (agents.has(wanted)) this.chosen = wanted;
    if (!agents.has(this.chosen)) this.chosen = agents.keys().next().value;
    return agents.get(this.chosen);
  }

  showList(mind) {
    if (this.listed !== this.minds.version) {
      this.listed = this.minds.version;
      this.items = [...this.minds.agents.values()];
    }
    this.picker.show(this.items, mind.name);
  }

  fillRow(row, mind) {
    const stamp = `${mind.name} ${mind.stamp(this.t)}`;
    if (row.dataset.stamp === stamp) return;
    row.dataset.stamp = stamp;
    const [first] = mind.intentionsAt(this.t), top = first?.stack?.at(-1);
    const runs = mind.runsAt(this.t);
    row.replaceChildren(element("span", `dot ${runs ? first?.state ?? "idle" : "ended"}`), element("b", "", mind.name),
      element("span", "doing", runs ? top?.step || top?.goal || "" : "ended"));
  }

  showRobots(mind, t) {
    const used = this.links.robots(mind.name, t);
    if (used.join() === this.used) return;
    this.used = used.join();
    this.robots.replaceChildren(...used.map((robot) => button("jump", () => this.context.selection.choose({ agent: mind.name, robot }), robot)));
  }
}
