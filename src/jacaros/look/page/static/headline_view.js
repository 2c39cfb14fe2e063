import { button, element } from "./elements.js";
import { showWhy } from "./jumps.js";
import { paced } from "./paced.js";
import { keyed, refill } from "./refill.js";
import { coded } from "./story.js";

const SIGNS = { error: "✖", warning: "⚠", busy: "▶", quiet: "◔" };
const MOST = 30;

/** One line on top: what is wrong, or what is being done. It unfolds when there is more. */
export class HeadlineView {
  constructor(root, context, { headline, causes }) {
    Object.assign(this, { root, context, headline, causes, isOpen: false });
    this.draw = paced((t) => this.fill(this.headline.at(t)));
  }

  get empty() { return this.context.run.count === 0; }

  show(t) { this.draw(t); }

  fill(states) {
    const stamp = JSON.stringify([states.slice(0, MOST), states.length, this.isOpen]);
    if (stamp === this.stamp) return;
    this.stamp = stamp;
    this.root.hidden = !states.length;
    const shown = states.slice(0, this.isOpen ? MOST : 1).map((state, n) => this.line(state, n)), more = states.length - 1;
    if (more > 0) shown[0].append(keyed("more", this.more(more)));
    refill(this.root, shown);
  }

  more(count) {
    const made = button("more", () => {
      this.isOpen = !this.isOpen;
      this.context.time.notify();
    }, this.isOpen ? "less" : `+${count} more`);
    made.setAttribute("aria-expanded", String(this.isOpen));
    return made;
  }

  line(state, n) {
    const { level, text } = state;
    const made = button("what", () => this.go(state), element("i", "sign", SIGNS[level]), element("span", "", ...coded(text)));
    made.setAttribute("aria-label", level === "error" || level === "warning" ? `${level}: ${text}` : text);
    return element("p", level, keyed(`headline ${n}`, made));
  }

  /** The operation that failed at time `t`, or else what the intention did last. */
  cause(agent, intention, t) {
    const own = (fits) => this.causes.last(t, 1, (link) => link.agent === agent && fits(link))[0];
    return own(({ outcome, ended }) => outcome === "failed" && Math.abs(ended - t) < 1) ?? own((link) => link.intention === intention);
  }

  /** Go to the moment, and show what led to a failure. */
  go({ level, t, agent, intention, robot }) {
    const { time, selection, open } = this.context;
    if (t !== undefined) time.go(t);
    if (robot) selection.choose({ robot });
    if (!agent) return;
    const link = level === "error" || level === "warning" ? this.cause(agent, intention, t ?? time.now) : undefined;
    if (link) showWhy(this.context, { agent, intention, cause: link.id });
    else {
      selection.choose({ agent, intention });
      open("agents");
    }
  }
}
