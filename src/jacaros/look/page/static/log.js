import { Failures } from "./failures.js";
import { Track } from "./track.js";
import { inWords, markText, sortOf, toneOf } from "./happenings.js";

const LINES = 80000;  // that are kept: a live page may be open for days
const MARKS = 20000;

/** What agents printed and what happened, in the order of time; and the marks of the timeline. */
export class Log {
  constructor() {
    this.debugState = "running";
    this.entries = new Track(LINES);  // t, who (an agent or ""), text, sort, robot
    this.marks = [];  // t, sort, text, and the selection that it leads to
    this.robots = new Set();
    this.failures = new Failures();
  }

  add(t, event, data) {
    if (event === "world") for (const robot of data.robots ?? []) this.robots.add(robot.name);
    const several = this.robots.size > 1;
    if (event === "text") this.enter({ t, who: data.agent, text: data.text, sort: "" });
    // A run begins with a record that it is not paused.
    if (event === "debug") {
      // A new speed or breakpoint is a record, too, but neither a pause nor the end of one.
      if (data.state === this.debugState) return;
      this.debugState = data.state;
    }
    const failure = event === "goal" ? this.failures.add(t, data) : null;
    const words = inWords(event, data, several), sort = sortOf(event, data);
    if (words) this.enter({ t, ...said(words), sort: toneOf(event, data) ?? sort ?? "world", robot: data.robot });
    // Whether a plan handles a failure is known a record later.
    if (sort) this.marks.push({ t, get sort() { return failure?.handled ? "handled" : sort; }, text: markText(event, data, several), leads: leads(data) });
    if (this.marks.length > MARKS) this.marks.splice(0, MARKS >> 2);
  }

  /** The marks from time `from` to `to`; those of one sort that are within `near` seconds are one, with `more` others up to `until`. */
  marksIn(from, to, near) {
    const found = [], last = new Map();
    for (const { t, sort, text, leads: where } of this.marks) {
      if (t < from || t > to) continue;
      const mark = last.get(sort);
      if (mark && t - mark.t < near) Object.assign(mark, { more: mark.more + 1, until: t });
      else {
        last.set(sort, { t, sort, text, leads: where, more: 0 });
        found.push(last.get(sort));
      }
    }
    return found;
  }

  enter(entry) { this.entries.add(entry.t, entry); }
}

/** The agent and the text of a line of the log, such as "[guard] warning: the goal !go failed". */
function said(words) {
  const [, who = "", text] = /^(?:\[([^\]]+)\] )?(?:(?:warning|error): )?([^]*)$/.exec(words);
  return { who, text };
}

function leads({ agent, robot, intention }) {
  if (agent) return { agent, intention };
  return robot ? { robot } : null;
}
