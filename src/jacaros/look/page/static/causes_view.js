import { button, clock, element } from "./elements.js";
import { momentButton, placeButton } from "./jumps.js";
import { linkPlace, linkWords, planName, refusalWords } from "./link_words.js";
import { keyed, moveByArrows, refill } from "./refill.js";
import { WhyQuestion } from "./why_question.js";

const LATELY = 40;  // links that are listed when none is selected
const LONGEST = 60;  // lines of a chain
const LONGEST_ROUND = 12;  // links of a round of a loop
const LEAVES = new Set(["command", "operation", "event", "act"]);

/** Why: the causes of what is selected back to the sensor, its effects forward, and the decisions on the way. */
export class CausesView {
  constructor(root, context, { causes, minds, links, environment }) {
    Object.assign(this, { root, context, causes, minds, links, environment });
    this.question = new WhyQuestion(context);
    this.picture = element("div", "why");
    root.append(this.question.root, this.picture);
    moveByArrows(this.picture, ".link");
  }

  get empty() { return this.causes.links.size === 0; }

  show(t) {
    this.question.show();
    const selected = this.context.selection.current, link = this.causes.get(selected.cause);
    // Of a live run the list grows all the time: it is drawn again at most twice a second.
    const stamp = JSON.stringify([selected, link ? this.causes.links.size : Math.floor(t * 2), link ? Math.floor(t) : 0]);
    if (stamp === this.stamp) return;
    this.stamp = stamp;
    refill(this.picture, link ? this.story(link, t) : this.lately(selected, t));
  }

  story(link, t) {
    const chain = this.causes.chain(link.id), forward = this.causes.forward(link.id, t);
    const back = button("plain back", () => this.context.selection.choose({ ...this.context.selection.current, cause: undefined }), "← Recent activity");
    const nodes = [keyed("back", back), element("h2", "asked", linkWords(link, this.minds, t)), this.place(link, "asked")];
    if (link.kind === "event") nodes.push(...this.decision(link));
    nodes.push(element("h3", "", "Because of"));
    if (chain.length > 1) nodes.push(element("ol", "chain", ...this.folded(chain.slice(1), t)));
    else nodes.push(element("p", "empty", link.parent ? "The cause was not recorded." : "Nothing before it: the chain begins here."));
    nodes.push(element("h3", "", "Led to"));
    if (forward.length) nodes.push(element("ol", "effects", ...commandsJoined(forward).map((each) => this.item(each.link, t, each))));
    else nodes.push(element("p", "empty", "Nothing has happened yet."));
    nodes.push(...this.beliefs(link));
    return nodes;
  }

  /** A chain in which the newest round of a loop stands for the earlier ones. */
  folded(chain, t) {
    const same = (link) => JSON.stringify([link.kind, link.agent, linkPlace(link, this.minds) ?? linkWords(link, this.minds, t).replace(/[-\d.]+/g, "#")]);
    const places = chain.map(same), items = [];
    for (let at = 0; at < chain.length;) {
      const [size, rounds] = loop(places, at);
      items.push(...chain.slice(at, at + size).map((each) => this.item(each, t)));
      at += size * rounds;
      if (rounds > 1) items.push(element("li", "rounds", element("time", "", clock(chain[at - 1].t)), `${rounds - 1} earlier rounds like this`));
    }
    return items.slice(0, LONGEST);
  }

  place(link, key) {
    const place = linkPlace(link, this.minds), parts = ["at ", momentButton(this.context, link.t, key)];
    if (place) parts.push(" · ", placeButton(this.context, place, key));
    if (link.agent && link.kind !== "remote") parts.push(" · ", keyed(`${key} agent`, button("jump", () => this.openAgent(link), link.agent)));
    return element("p", "where", ...parts);
  }

  openAgent(link) {
    this.context.selection.choose({ agent: link.agent, intention: link.intention ?? undefined });
    this.context.open("agents");
  }

  /** Why this plan, and why not the others. */
  decision({ agent, chosen, options = [], untried = [] }) {
    const plan = (id) => this.minds.plan(agent, id), lines = [];
    for (const option of options) lines.push(this.candidate(plan(option.plan), "refused", refusalWords(option.why), option.plan));
    if (chosen !== null && chosen !== undefined) {
      const context = plan(chosen)?.context;
      lines.push(this.candidate(plan(chosen), "chosen", context ? `its context holds: ${context}` : "no context: always applicable", chosen));
    }
    for (const id of untried) lines.push(this.candidate(plan(id), "untried", "not tried: an earlier plan was applicable", id));
    if (!lines.length) return [element("p", "empty", "No plan is relevant for this event.")];
    return [element("h3", "", chosen === null ? "Why no plan" : "Why this plan"), element("ol", "candidates", ...lines)];
  }

  candidate(plan, kind, words, id) {
    const sign = { chosen: "✓", refused: "✗", untried: "·" }[kind];
    return element("li", kind, element("span", "sign", sign), element("span", "", element("code", "", planName(plan)), " ",
      placeButton(this.context, plan, `candidate ${id}`), element("span", "words", words)));
  }

  beliefs({ beliefs = [] }) {
    if (!beliefs.length) return [];
    return [element("h3", "", "Changed beliefs"), element("ul", "changed", ...beliefs.map(({ op, belief, agent }) => element("li", "", `${agent}: `, element("code", "", `${op}${belief}`))))];
  }

  item(link, t, { depth = 0, more = 0, until = 0 } = {}) {
    const selected = this.context.selection.has({ cause: link.id });
    const row = button("link", () => this.choose(link), element("time", "", clock(link.t)), element("span", "words", `${linkWords(link, this.minds, t)}${more ? `, and ${more} more until ${clock(until)}` : ""}`));
    row.dataset.kind = link.kind;
    const place = linkPlace(link, this.minds);
    const made = element("li", selected ? "selected" : "", keyed(`link ${link.id}`, row), ...(place ? [placeButton(this.context, place, `link ${link.id}`)] : []));
    if (depth) made.style.setProperty("--depth", String(Math.min(depth - 1, 8)));
    return made;
  }

  choose(link) {
    const { agent, artifact, robot } = this.context.selection.current;
    this.context.selection.choose({ agent: link.kind === "remote" ? agent : link.agent ?? agent, artifact, robot, cause: link.id });
  }

  /** The last links of what is selected, or of the run. */
  lately(selected, t) {
    const fits = this.filter(selected, t), found = this.causes.last(t, LATELY, onceForEach(fits));
    const title = element("h2", "asked", selected.agent ? `Recent activity of ${selected.agent}` : selected.robot ? `Recent activity of ${selected.robot}` : "Recent activity");
    if (!found.length) return [title, element("p", "empty", "Nothing has happened yet.")];
    return [title, element("p", "empty", "Select a line to see its causes and effects."), element("ol", "effects", ...found.map((each) => this.item(each, t)))];
  }

  filter({ agent, intention, artifact, robot }, t) {
    if (intention !== undefined) return (link) => link.agent === agent && link.intention === intention;
    if (agent !== undefined) return (link) => link.agent === agent;
    if (artifact !== undefined) return (link) => link.artifact === artifact;
    if (robot !== undefined) {
      const agents = this.links.agents(robot, t);
      return (link) => LEAVES.has(link.kind) && (this.environment.artifacts.get(link.artifact)?.robot === robot || agents.includes(link.agent));
    }
    return (link) => LEAVES.has(link.kind);
  }
}

/** How many links the loop has that begins at `at`, and the number of its rounds; 1 and 1 without one. */
function loop(places, at) {
  for (let size = 1; size <= LONGEST_ROUND; size++) {
    let n = 0;
    while (at + size + n < places.length && places[at + n] === places[at + size + n]) n += 1;
    if (n >= size * 2) return [size, Math.floor(n / size) + 1];
  }
  return [1, 1];
}

/** Effects with the commands of one operation joined: the first one knows how many `more` there were, `until` when. */
function commandsJoined(effects) {
  const joined = [], commands = new Map();
  for (const effect of effects) {
    const { link } = effect, first = link.kind === "command" ? commands.get(`${link.parent} ${link.topic}`) : undefined;
    if (first) Object.assign(first, { more: (first.more ?? 0) + 1, until: link.t });
    else joined.push(effect);
    if (link.kind === "command" && !first) commands.set(`${link.parent} ${link.topic}`, effect);
  }
  return joined;
}

/** Accept what `fits` accepts, but of the commands of one operation only the first that is asked for. */
function onceForEach(fits) {
  const known = new Set();
  return (link) => {
    if (!fits(link)) return false;
    const key = link.kind === "command" ? `${link.parent} ${link.topic}` : null;
    if (known.has(key)) return false;
    if (key) known.add(key);
    return true;
  };
}
