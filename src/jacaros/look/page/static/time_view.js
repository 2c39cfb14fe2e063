import { button, clock, element, isDark, themeColor } from "./elements.js";
import { fitted } from "./time_canvas.js";

const RULER = 18;  // pixels
const KEYS = { "+": 1.5, "=": 1.5, "-": 1 / 1.5, "_": 1 / 1.5 };

/** Time: the ruler, the line of the moment that is shown, and zoom; lanes and curves draw themselves below it. */
export class TimeView {
  constructor(root, context) {
    Object.assign(this, { root, axis: context.axis, time: context.time, run: context.run });
    this.ruler = element("canvas", "ruler");
    this.ruler.setAttribute("aria-hidden", "true");
    this.now = element("div", "now");
    this.body = root.querySelector(".times");
    this.body.prepend(this.ruler);
    this.body.append(this.now);
    this.follow = this.tool("Follow", "Follow the end of the run again", () => this.axis.follow());
    this.tools = element("div", "tools", this.tool("−", "Show a longer time", () => this.axis.zoom(1 / 1.5)),
      this.tool("+", "Show a shorter time", () => this.axis.zoom(1.5)), this.tool("All", "All of the run", () => this.axis.all()), this.follow);
    root.prepend(element("header", "", element("h2", "", "Time"), this.tools));
    this.ruler.addEventListener("click", ({ offsetX }) => this.time.go(this.axis.t(offsetX)));
    root.tabIndex = 0;
    root.addEventListener("keydown", (event) => this.press(event));
  }

  get empty() { return this.run.end === 0; }

  tool(text, label, act) {
    const made = button("plain layer", act, text);
    made.setAttribute("aria-label", label);
    made.title = label;
    return made;
  }

  show(t) {
    const { axis, body } = this, { clientWidth } = body;
    axis.left = Math.round(Math.min(130, clientWidth * 0.22));
    axis.width = Math.max(10, clientWidth - axis.left - axis.right);
    axis.update(t);
    const x = axis.x(t);
    this.follow.hidden = !this.time.live || axis.mode === "auto";
    this.now.hidden = !axis.has(t);
    this.now.style.transform = `translateX(${x.toFixed(1)}px)`;
    const stamp = `${axis.from} ${axis.to} ${axis.width} ${isDark()}`;
    if (stamp === this.stamp) return;
    this.stamp = stamp;
    this.draw(clientWidth);
  }

  draw(width) {
    const pen = fitted(this.ruler, width, RULER), ticks = this.axis.ticks(), isFine = ticks.length > 1 && ticks[1] - ticks[0] < 0.1;
    pen.font = "11px system-ui, sans-serif";
    pen.fillStyle = themeColor("muted");
    pen.textAlign = "center";
    for (const t of ticks) {
      const x = Math.round(this.axis.x(t));
      pen.fillRect(x, RULER - 4, 1, 4);
      const text = isFine ? `${t.toFixed(2)} s` : tickText(t, ticks);
      pen.fillText(text, Math.min(x, width - 2 - pen.measureText(text).width / 2), RULER - 6);
    }
  }

  /** Zoom with the keys, and pan when the panel itself has the focus. */
  press(event) {
    if (event.target.matches("input, select") || event.ctrlKey || event.metaKey || event.altKey) return;
    const { axis } = this, factor = KEYS[event.key], side = event.target === this.root ? { ArrowLeft: -0.1, ArrowRight: 0.1 }[event.key] : undefined;
    if (factor) axis.zoom(factor);
    else if (side) axis.pan(side * axis.span);
    else if (event.key === "0") axis.all();
    else return;
    event.preventDefault();
  }
}

/** A moment as 1:05, with tenths when the ticks are near. */
function tickText(t, ticks) {
  if (ticks.length > 1 && ticks[1] - ticks[0] < 1) return clock(t);
  return clock(t).slice(0, -2);
}
