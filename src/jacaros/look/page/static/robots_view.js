import { draggable } from "./curve_choice.js";
import { decimals, button, element, setText } from "./elements.js";
import { robotColor } from "./palette.js";
import { robotKeys } from "./series_sources.js";

const FEW = 4;  // robots whose cards show everything; of more, names and batteries

/** A card for each robot: battery, pose, what happens to it, and the agents that use it. */
export class RobotsView {
  constructor(root, { selection }, world, links) {
    this.root = root;
    this.world = world;
    this.links = links;
    this.selection = selection;
    this.cards = [];
  }

  get empty() { return this.world.robotCount === 0; }

  show(t) {
    this.t = t;
    for (let index = this.cards.length; index < this.world.robotCount; index++) this.cards.push(this.makeCard(index));
    this.root.classList.toggle("many", this.cards.length > FEW);
    this.cards.forEach((card, index) => this.showCard(card, index, t));
  }

  makeCard(index) {
    const name = this.world.robot(index).name;
    const card = {
      name, dot: element("i", "dot"), level: element("span", "level"), fill: element("b"), where: element("span", "where"),
      state: element("span", "state"), agents: element("span", "agents"), gauge: element("span", "gauge"),
    };
    card.gauge.append(card.fill);
    card.gauge.setAttribute("role", "meter");
    card.gauge.setAttribute("aria-label", `battery of ${name}`);
    card.gauge.setAttribute("aria-valuemin", "0");
    card.gauge.setAttribute("aria-valuemax", "100");
    const title = element("span", "name", card.dot, name);
    card.root = button("robot card", () => this.selection.choose(this.links.selectionOf(name, this.t)), title, card.level, card.gauge,
      card.where, card.state, card.agents);
    this.root.append(draggable(card.root, robotKeys(name)));
    return card;
  }

  showCard(card, index, t) {
    const state = this.world.state(index, t);
    card.root.hidden = state === null;
    if (state === null) return;
    const level = Math.round(state.battery), agents = this.links.agents(card.name, t);
    card.dot.style.background = robotColor(index);
    const isFlat = level === 0 && !state.charging;
    card.root.classList.toggle("flat", isFlat);
    setText(card.level, level < 0 ? "" : isFlat ? "⚠ 0 %" : `${level} %`);
    card.gauge.hidden = level < 0;
    card.gauge.setAttribute("aria-valuenow", String(level));
    card.fill.style.width = `${Math.max(0, state.battery)}%`;
    card.fill.className = level > 50 ? "high" : level > 20 ? "middle" : "low";
    setText(card.where, `x ${decimals(state.x, 2)}  y ${decimals(state.y, 2)}  ${degrees(state.yaw)}°`);
    card.state.className = `state ${state.charging ? "charging" : state.touching ? "touching" : ""}`;
    setText(card.state, state.charging ? "⚡ charging" : state.touching ? "⚠ touching" : "");
    setText(card.agents, agents.length ? `used by ${agents.join(", ")}` : "");
    card.root.setAttribute("aria-pressed", String(this.isSelected(card.name, t)));
  }

  isSelected(name, t) {
    const { robot, agent } = this.selection.current;
    return robot === name || (agent !== undefined && this.links.robots(agent, t).includes(name));
  }
}

/** An angle in whole degrees, from -180 to 180. */
function degrees(angle) { return Math.round(Math.atan2(Math.sin(angle), Math.cos(angle)) * 180 / Math.PI); }
