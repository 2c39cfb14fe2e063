import { clock } from "./elements.js";

const spaced = (name) => String(name ?? "").replaceAll("_", " ");

/** Events that people read, in words. */
const WORDS = {
  docked: (d) => `docked at ${d.dock}`, undocked: (d) => `left ${d.dock}`,
  charging: (d) => `charging from ${Math.round(d.level)} %`, charged: () => "fully charged",
  bump: (d) => `bumped into a wall, ${d.side}`, collision: (d) => `collided with ${d.with}, ${d.side}`,
  task: (d) => `${d.task}${d.room ? ` in the ${spaced(d.room)}` : ""}`,
  door_opened: (d) => `door ${d.door} opens`, door_closed: (d) => `door ${d.door} closes`,
  person_comes: (d) => `${d.person} comes`, person_goes: (d) => `${d.person} goes`,
  obstacle_placed: (d) => `${spaced(d.obstacle)} placed`, obstacle_removed: (d) => `${spaced(d.obstacle)} removed`,
  picked: (d) => `picked up ${d.object}`, placed: (d) => `put down ${d.object}`,
  robot_placed: (d) => `moved by hand to (${d.x}, ${d.y})`, battery_set: (d) => `battery set to ${Math.round(d.level)} %`,
  fault: (d) => `fault ${d.fault} (${spaced(d.kind)}) ${d.state}${d.why ? `: ${d.why}` : ""}`,
  fell: () => "fell down a cliff",
  battery_empty: () => "battery empty", command_timeout: () => "stopped: no commands received",
  log: (d) => d.text, intervention: (d) => d.what,
  debug: (d) => (d.state === "paused" ? `paused${d.why && d.why !== "pause" ? `: ${d.why}` : ""}` : "continues"),
  ended: (d) => `the run ended with code ${d.code}`,
};

const FAILURES = new Set(["bump", "collision", "fault", "fell", "battery_empty", "command_timeout"]);

/** The sorts of marks: class, and name. */
const SORTS = { failure: "failure", handled: "failure that a plan handled", task: "task done", docked: "docked", intervention: "your change", pause: "paused" };

/** An event in words, undefined when people do not read it. */
export function inWords(event, data, severalRobots) {
  if (event === "log" && data.level === "info") return undefined;
  const words = WORDS[event]?.(data);
  return words && severalRobots && data.robot ? `${data.robot}: ${words}` : words;
}

/** The sort of mark for an event, undefined for none. */
export function sortOf(event, data) {
  if (FAILURES.has(event)) return event === "fault" && /ends|acts/.test(data.state) ? undefined : "failure";
  // Behaviours of trees fail without a reason as a matter of course.
  if (event === "goal") return data.state === "failed" && data.why ? "failure" : undefined;
  if (event === "operation") return undefined;
  if (event === "log") return data.level === "error" ? "failure" : undefined;
  if (event === "debug") return data.state === "paused" ? "pause" : undefined;
  return event === "docked" || event === "task" || event === "intervention" ? event : undefined;
}

/** How loud a line of the log is: a lost goal as loud as a failure of a robot, a safe stop less. */
export function toneOf(event, { level, text, code }) {
  if (event === "ended" && code) return "failure";
  if (event === "command_timeout") return "warning";  // the robot stopped, as it should
  if (event !== "log" || level === "info") return undefined;
  return level === "error" || text.includes("has no plan for its failure") ? "failure" : "warning";
}

/** A mark of `Log.marksIn` in words. */
export function markLine({ t, sort, text, more, until }) { return `${clock(t)} ${SORTS[sort]}: ${text}${more ? `, and ${more} more until ${clock(until)}` : ""}`; }

/** The text of a mark. */
export function markText(event, data, severalRobots) {
  if (event === "goal") return `${data.agent}: ${data.goal} failed: ${data.why.split("\n")[0]}`;
  return inWords(event, data, severalRobots) ?? event;
}
