import { Fold } from "./fold.js";

/** The members of the fleet that the run has joined: systems of other processes and computers, and this one. */
export class Fleet {
  constructor() { this.members = new Fold(change); }

  add(t, event, data) {
    if (event === "member" && data.member) this.members.add(t, { ...data, t });
  }

  /** The members at time `t`, this system first. */
  membersAt(t) {
    const rank = ({ state }) => (state === "self" ? 0 : 1);
    return [...this.members.at(t).values()].sort((a, b) => rank(a) - rank(b) || (a.member < b.member ? -1 : 1));
  }
}

/** One that is lost keeps the names of its agents: they are what is missed. */
function change(members, { t, ...member }) {
  const known = members.get(member.member);
  if (member.state === "left") { members.delete(member.member); return; }
  const { agents, workspaces } = member.state === "lost" && known ? known : member;
  members.set(member.member, { ...member, agents: agents ?? [], workspaces: workspaces ?? [], since: known?.state === member.state ? known.since : t });
}
