import { clock } from "./elements.js";
import { reasonOf } from "./failures.js";
import { indexAt } from "./track.js";

const LEVELS = ["error", "warning", "busy", "quiet"];
const LATELY = 60;  // seconds for which a lost goal of an agent that has others is worth a line
const LATE = 0.5;  // seconds after which an intention that lasts is recorded
const FAR = 0.2;  // metres between a pose and the believed one
const SIGNALS = 128;  // exit codes from here on mean that a signal ended the run
const AT_END = 0.3;  // seconds before the end of a run in which it takes the goals from its agents
const DEEDS = [[/^(?:drive|navigate|go|move)_?to/i, "driving to"], [/undock/i, "leaving the dock"], [/dock/i, "docking"], [/charg/i, "charging"], [/^(?:rotate|turn)/i, "turning"]];

/**
 * What matters at a moment, the worst first: what is wrong with agents, robots and the fleet, else what they are doing.
 *
 * Each is `level` (error, warning, busy, quiet), `text` (with code in backquotes), and if known `t`, `agent`, `intention`,
 * `robot`: where a click leads.
 */
export class Headline {
  constructor(models) { Object.assign(this, models); }

  at(t) {
    const found = [...this.ofRun(t), ...this.ofFleet(t), ...this.ofRobots(t)];
    const ended = this.run.over && t >= this.run.end - AT_END, moment = ended ? this.run.end - AT_END : t;
    for (const mind of this.minds.agents.values()) {
      const state = mind.runsAt(moment) && this.ofAgent(mind, moment);
      if (state && !(ended && LEVELS.indexOf(state.level) > 1)) found.push(state);
    }
    return found.sort((a, b) => LEVELS.indexOf(a.level) - LEVELS.indexOf(b.level) || Boolean(a.robot) - Boolean(b.robot));
  }

  ofRun(t) {
    if (this.time.lost) {
      const silent = Math.max(0, Math.round((Date.now() - this.time.lost) / 1000));
      return [{ level: "error", text: `connection to the run lost: last message ${silent} s ago; the page shows what was the case then` }];
    }
    if (!this.run.over || t < this.run.end - AT_END) return [];
    const { code } = this.run, told = this.story.isWhole ? this.story.lines.at(-1)?.text : `the run ended with exit code ${code}`;
    return [{ level: code && code < SIGNALS ? "error" : "quiet", text: told, t: this.run.end }];
  }

  ofFleet(t) {
    const lost = this.fleet.membersAt(t).filter(({ state }) => state === "lost");
    return lost.map(({ member, since }) => ({ level: "error", text: `${member} does not answer since ${clock(since)}`, t: since }));
  }

  ofRobots(t) {
    const found = [];
    for (let index = 0; index < this.world.robotCount; index++) {
      const state = this.world.state(index, t), { name } = this.world.robot(index);
      if (!state) continue;
      if (state.battery >= 0 && state.battery < 0.5 && !state.charging) found.push({ level: "error", text: `${name}: the battery is empty`, robot: name });
      else if (state.touching) found.push({ level: "warning", text: `${name} touches something`, robot: name });
      else if (this.isMisplaced(name, state, t)) found.push({ level: "warning", text: `${name} is not where it believes to be`, robot: name });
    }
    return found;
  }

  /** Whether a robot of the embedded world, where poses are known, believes in a wrong one. */
  isMisplaced(name, { x, y }, t) {
    const believed = this.run.ros === "memory" && this.world.belief(name, t);
    return believed && believed.x !== null && Math.hypot(believed.x - x, believed.y - y) > FAR;
  }

  ofAgent(mind, t) {
    const agent = mind.name, lost = this.log.failures.lost(agent, t);
    // The end of a lost intention is recorded a moment later.
    const intentions = mind.intentionsAt(t).filter(({ id }) => !lost || id !== lost.intention);
    const failed = lost && `\`${lost.goal}\` failed: ${reasonOf(lost.why)}`;
    if (!intentions.length) {
      const since = mind.goals.times[indexAt(mind.goals.times, t)];
      if (since === undefined) return { level: "quiet", text: `${agent}: waits for events`, agent };
      const open = t - since < LATE && [...mind.goals.at(t).values()].find((each) => each.state === "pursued");
      if (open && open.intention !== lost?.intention) return { level: "busy", text: `${agent}: \`${open.goal}\``, agent };
      const words = `${agent}: no goal since ${clock(since)}`;
      // What failed last is why there is no goal; what failed long before is not.
      if (lost && since - lost.t < 1) return { level: "error", text: `${words}, ${failed}`, t: lost.t, agent, intention: lost.intention };
      return { level: "quiet", text: words, t: since, agent };
    }
    if (lost && t - lost.t < LATELY) return { level: "warning", text: `${agent}: ${failed}`, t: lost.t, agent, intention: lost.intention };
    const main = [...intentions].sort((a, b) => weight(b) - weight(a))[0];
    return { level: levelOf(main), text: `${agent}: ${doing(mind, main, t)}`, agent, intention: main.id };
  }
}

/** How much an intention says about what its agent does: one that acts more than one that waits for an event. */
function weight({ state, waits = "", urgency = 0 }) {
  if (state === "suspended" || waits.startsWith("the resource")) return -1000;
  return urgency - (/^the (?:condition|event)/.test(waits) ? 500 : 0);
}

function levelOf({ state, waits = "", stack = [] }) {
  if (state === "suspended" || stack.some(({ goal }) => goal.startsWith("-!"))) return "warning";
  return /^the (?:condition|event|answer|resource)/.test(waits) ? "quiet" : "busy";
}

/** What an intention does, in words. */
function doing(mind, { state, waits = "", reason, since, stack = [] }, t) {
  const long = t - since >= 1 ? ` since ${clock(since)}` : "", goal = stack.length ? ` (\`${stack[0].goal}\`)` : "", failed = stack.findLast((each) => each.goal.startsWith("-!"));
  if (state === "suspended") return `suspended${long}${reason && reason !== "suspend_ia" ? `: ${reason}` : ""}${goal}`;
  const act = /^(?:for )?the (?:action|operation) (.*)$/.exec(waits)?.[1], handling = failed ? ` handles the failure of \`${failed.goal.slice(1)}\`:` : "";
  if (act) return `${handling}${deed(mind, act, t)}${goal}`.trim();
  if (waits) return `${handling} waits for ${waits}${/^the/.test(waits) ? long : ""}${goal}`.trim();
  const step = stack.at(-1)?.step;
  return `${handling} ${step ? `at \`${step}\`` : "runs"}${goal}`.trim();
}

/** An action in words: "driving to corner 2", if the agent believes `corner(2,2,2,90)`. */
function deed(mind, act, t) {
  const [, name, given = ""] = /^(\w+)(?:\((.*)\))?/.exec(act) ?? [null, act], verb = DEEDS.find(([pattern]) => pattern.test(name))?.[1];
  if (!verb) return `\`${act}\``;
  if (verb !== "driving to") return verb;
  const [x, y] = given.split(","), place = y && mind.beliefsAt(t).find(({ belief }) => /^\w+\((\w+),([^,]+),([^,)]+)/.exec(belief)?.slice(2, 4).join() === `${x},${y}`);
  const [, functor, key] = place ? /^(\w+)\((\w+)/.exec(place.belief) : [];
  return `${verb} ${key ? (/^\d/.test(key) ? `${functor} ${key}` : key) : given}`;
}
