import { breakable, element, setText } from "./elements.js";
import { refill } from "./refill.js";

/** The ROS graph around the node of the run: topics, who is at them, and the rates of ours. */
export class GraphView {
  constructor(root, context, environment) {
    Object.assign(this, { root, environment });
    this.node = element("h2");
    this.filter = element("input", "search");
    Object.assign(this.filter, { type: "search", placeholder: "Find topics", spellcheck: false });
    this.filter.setAttribute("aria-label", "Find topics by name or type");
    this.filter.addEventListener("input", () => context.time.notify());
    this.table = element("table", "topics");
    this.body = element("tbody");
    const head = [["Topic"], ["Rate"], ["Pub", "Publishers"], ["Sub", "Subscribers"]].map(([short, title = ""]) => {
      const cell = element("th", "", short);
      cell.title = title;
      cell.scope = "col";
      return cell;
    });
    this.table.append(element("thead", "", element("tr", "", ...head)), this.body);
    root.append(this.node, this.filter, this.table);
  }

  get empty() { return this.environment.graphs.values.length === 0; }

  show(t) {
    const graph = this.environment.graph(t), wanted = this.filter.value.trim().toLowerCase();
    if (this.shown && this.shown[0] === graph && this.shown[1] === wanted) return;
    this.shown = [graph, wanted];
    this.filter.hidden = this.table.hidden = !graph;
    setText(this.node, graph ? `Node ${graph.node}` : "The graph has not been read yet.");
    const topics = (graph?.topics ?? []).filter(({ name, type }) => `${name} ${type}`.toLowerCase().includes(wanted));
    topics.sort((a, b) => (Boolean(b.ours) - Boolean(a.ours)) || (a.name < b.name ? -1 : 1));
    refill(this.body, topics.map(row));
  }
}

function row({ name, type, publishers, subscribers, ours, rate }) {
  const ways = { in: "→ in", out: "← out" }[ours];
  const title = element("td", "", element("code", "", name), element("span", "type", ...breakable(type)));
  const made = element("tr", ours ? "ours" : "", title, element("td", "rate", ours ? `${rate} Hz ` : "", element("span", "way", ways ?? "")),
    element("td", "", String(publishers)), element("td", "", String(subscribers)));
  return made;
}
