import { Mind } from "./mind.js";

/** The agents of a run, by name, each with what was in its mind at any moment. */
export class Minds {
  constructor() {
    this.agents = new Map();
    this.sources = new Map();  // by file: its text, the newest last
    this.version = 0;  // grows with each agent
  }

  add(t, event, data) {
    if (event === "source") this.addSource(data);
    else if (event === "message") this.addMessage(t, data);
    else if (OF_AGENTS.has(event) && data.agent) this.agent(data.agent).add(t, event, data);
  }

  addSource({ file, text }) {
    const known = this.sources.get(file) ?? [];
    known.push(String(text).split("\n"));
    this.sources.set(file, known);
  }

  addMessage(t, data) {
    const to = data.to && this.agents.get(data.to);
    if (to) to.add(t, "message", data);
    else if (data.state === "read") for (const each of this.agents.values()) each.add(t, "message", data);
  }

  /** The mind of an agent, made when it is new. */
  agent(name) {
    if (!this.agents.has(name)) {
      this.agents.set(name, new Mind(name));
      this.version += 1;
    }
    return this.agents.get(name);
  }

  /** Lines of a file, as it was read last; undefined when it is unknown. */
  lines(file) { return this.sources.get(file)?.at(-1); }

  /** The text of line `line` of `file`, without blanks around it and comments; "" when it is unknown. */
  lineText(file, line) {
    const written = this.lines(file)?.[line - 1] ?? "";
    return written.replace(/\/\/.*$/, "").trim().replace(/[;.]$/, "");
  }

  /** A plan of an agent: id, label, trigger, context, file, line, end; undefined when it is unknown. */
  plan(agent, id) { return this.agents.get(agent)?.plan(id); }
}

const OF_AGENTS = new Set(["agent", "program", "belief", "goal", "deliberation", "intention", "text", "cause"]);
