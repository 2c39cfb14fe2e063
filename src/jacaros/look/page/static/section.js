import { element, setText } from "./elements.js";
import { refill } from "./refill.js";

/**
 * A part of a panel that unfolds.
 *
 * Its content is an object with `count(thing, t)`, the number in the heading (null: none), `stamp(thing, t)`, a text that
 * is the same as long as the picture is, and `nodes(thing, t)`, the picture.
 */
export class Section {
  constructor(title, content, isOpen = true) {
    this.content = content;
    this.number = element("span", "number");
    this.body = element("div", "body", ...(content.head ?? []));
    this.picture = element("div", "picture");
    this.body.append(this.picture);
    this.root = element("details", "section", element("summary", "", title, " ", this.number), this.body);
    this.root.open = isOpen;
    this.root.addEventListener("toggle", () => { this.stamp = undefined; this.show(this.thing, this.t); });
  }

  show(thing, t) {
    Object.assign(this, { thing, t });
    if (!thing) return;
    const { content } = this, count = content.count(thing, t);
    setText(this.number, count === null ? "" : String(count));
    this.root.hidden = count === 0 && content.hideEmpty === true;
    if (!this.root.open || this.root.hidden) return;
    const stamp = `${thing.name} ${content.stamp(thing, t)}`;
    if (stamp !== this.stamp) {
      this.stamp = stamp;
      refill(this.picture, content.nodes(thing, t));
    }
    showAges(this.picture, t);
  }
}

/** A span that says how long ago `since` was; `showAges` keeps it true. */
export function age(since) {
  const made = element("span", "age");
  made.dataset.since = String(since);
  return made;
}

/** Write how long ago the moments of all ages below `root` were, at time `t`. */
export function showAges(root, t) {
  for (const each of root.querySelectorAll(".age")) setText(each, duration(Math.max(0, t - Number(each.dataset.since))));
}

/** Seconds as a text: 0.3 s, 12 s, 3 min. */
export function duration(seconds) {
  if (seconds < 10) return `${seconds.toFixed(1)} s`;
  return seconds < 120 ? `${Math.round(seconds)} s` : `${Math.round(seconds / 60)} min`;
}
