import { planName } from "./link_words.js";

/** What the programs of agents compare beliefs with, from their `program` records. */
export class CurveThresholds {
  constructor(minds, sources) {
    Object.assign(this, { minds, sources, byAgent: new Map() });
  }

  add(t, event, { agent, thresholds }) {
    if (event === "program") this.byAgent.set(agent, thresholds ?? []);
  }

  /** The beliefs that are compared with something, as sources. */
  compared() {
    const found = new Set();
    for (const source of this.sources.shown()) if (source.agent && this.of(source).length) found.add(source);
    return [...found];
  }

  /** The lines of a source: each has `label`, and `value`, a number, or `source`, another belief. */
  of({ agent, name, argument }) {
    const lines = new Map();
    for (const [each, thresholds] of agent ? [[agent, this.byAgent.get(agent) ?? []]] : this.byAgent) {
      for (const threshold of thresholds) {
        if (threshold.belief !== name || threshold.argument !== argument) continue;
        const other = threshold.other && this.sources.get(`belief ${each} ${threshold.other} ${threshold.other_argument ?? 0}`);
        if (threshold.other && !other) continue;
        const key = other?.key ?? threshold.value, line = lines.get(key) ?? { value: threshold.value, source: other, labels: new Set() };
        line.labels.add(threshold.rule ?? planName(this.minds.plan(each, threshold.plan)));
        lines.set(key, line);
      }
    }
    return [...lines.values()].map(({ labels, ...line }) => ({ ...line, label: [...labels].join(", ") }));
  }
}
