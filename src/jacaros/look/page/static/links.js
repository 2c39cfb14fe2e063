import { Track } from "./track.js";

/** Which agents use which robots: an agent that focuses an artifact of a robot, or acts on it, uses the robot. */
export class Links {
  constructor() {
    this.robotOf = new Map();  // by artifact
    this.pairs = new Map();  // by agent: the artifacts that it uses, as a track of sets
  }

  add(t, event, data) {
    if (event === "artifact" && data.robot) this.robotOf.set(data.artifact, data.robot);
    if (event === "focus") this.use(t, data.agent, data.artifact, data.on);
    if (event === "operation" && data.state === "began" && data.agent) this.use(t, data.agent, data.artifact, true);
  }

  use(t, agent, artifact, on) {
    if (!this.pairs.has(agent)) this.pairs.set(agent, new Track());
    const track = this.pairs.get(agent), before = track.at(t) ?? new Set();
    if (before.has(artifact) === on) return;
    const after = new Set(before);
    if (on) after.add(artifact); else after.delete(artifact);
    track.add(t, after);
  }

  /** Names of the robots that `agent` uses at time `t`. */
  robots(agent, t) {
    const used = [...(this.pairs.get(agent)?.at(t) ?? [])].map((artifact) => this.robotOf.get(artifact));
    return [...new Set(used.filter(Boolean))];
  }

  /** What is selected with a robot: the agent, too, when only one uses it. */
  selectionOf(robot, t) {
    const agents = this.agents(robot, t);
    return agents.length === 1 ? { robot, agent: agents[0] } : { robot };
  }

  /** Names of the agents that use `robot` at time `t`. */
  agents(robot, t) { return [...this.pairs.keys()].filter((agent) => this.robots(agent, t).includes(robot)); }
}
