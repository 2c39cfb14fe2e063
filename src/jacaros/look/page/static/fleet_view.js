import { decimals, element, setText } from "./elements.js";
import { momentButton } from "./jumps.js";
import { keyed, refill } from "./refill.js";

const MOST = 100;  // names of agents, or of workspaces, of one member
const NOTABLE = 0.1;  // seconds from which on the offset of a clock is marked
const STATES = { self: "this system", joined: "joined", lost: "does not answer" };

/** The fleet: what is known of each member. */
export class FleetView {
  constructor(root, context, fleet) {
    Object.assign(this, { root, context, fleet });
    this.summary = element("h2");
    this.list = element("ul", "members");
    root.append(this.summary, this.list);
  }

  get empty() { return this.fleet.members.changes.length === 0; }

  show(t) {
    const count = this.fleet.members.countAt(t);
    if (count === this.shown) return;
    this.shown = count;
    const members = this.fleet.membersAt(t), lost = members.filter(({ state }) => state === "lost").length;
    setText(this.summary, `${members.length} ${members.length === 1 ? "system" : "systems"}${lost ? `, ${lost} of them ${lost === 1 ? "does" : "do"} not answer` : ""}`);
    refill(this.list, members.map((each) => this.card(each)));
  }

  card(member) {
    const { member: name, state, since } = member, about = element("span", `state ${state}`, STATES[state] ?? state);
    if (state !== "self") about.append(" since ", momentButton(this.context, since, `member ${name}`));
    const rows = [["Agents", names(member.agents)], ["Workspaces", names(member.workspaces)], ...measured(member), ["Page", state === "self" ? "" : pageLink(member.page)]];
    return element("li", `member ${state}`, element("header", "", element("b", "", name), about),
      element("dl", "", ...rows.filter(([, value]) => value).flatMap(([title, value]) => [element("dt", "", title), element("dd", "", value)])));

    function pageLink(address) {
      // The address comes from another computer: anything but a web address stays a text.
      if (!/^https?:\/\/[^\s]+$/.test(address ?? "")) return address;
      const made = element("a", "", address);
      Object.assign(made, { href: address, target: "_blank", rel: "noopener noreferrer", title: `Needs the token that ${name} has printed` });
      return keyed(`page of ${name}`, made);
    }
  }
}

function names(all) {
  return all.length > MOST ? `${all.slice(0, MOST).join(", ")} and ${all.length - MOST} more` : all.join(", ");
}

function measured({ state, delay, offset }) {
  if (state === "self" || delay === null || delay === undefined) return [];
  const ahead = element("span", Math.abs(offset ?? 0) < NOTABLE ? "" : "apart", clockText(offset ?? 0, delay / 2));
  return [["Delay", `${decimals(delay * 1000, 1)} ms there and back`], ["Clock", ahead]];
}

/** The offset of a clock in words; it is not known to more than half the delay. */
function clockText(offset, accuracy) {
  if (Math.abs(offset) < Math.max(0.001, accuracy)) return "as here";
  const size = Math.abs(offset) < 1 ? `${decimals(Math.abs(offset) * 1000, 0)} ms` : `${decimals(Math.abs(offset), 2)} s`;
  return `${size} ${offset > 0 ? "ahead" : "behind"}`;
}
