/** Links between causes and effects in words. */

const VELOCITY = /linear\.x=(-?[\d.e+-]+)|angular\.z=(-?[\d.e+-]+)/g;

const WORDS = {
  sample: (link) => `message on ${link.topic ?? link.what}${rest(link.what, link.topic)}`,
  property: (link) => `property ${within(link)}${of(link.artifact)}`,
  signal: (link) => `signal ${within(link)}${of(link.artifact)}`,
  event: (link, minds) => `event ${link.what}${handled(link, minds)}`,
  act: (link, minds) => `plan step ${stepText(link, minds)}`,
  operation: (link, minds, t) => `operation ${link.call ?? within(link)}${of(link.artifact)}${outcome(link, t)}`,
  command: commandText,
  remote: (link) => `plan step of ${link.agent}${link.what ? `, for ${link.what}` : ""}${link.file ? ` (${placeName(link)})` : ""}`,
  message: (link) => (link.performative ? `message from ${link.from} to ${link.to}: ${link.performative} ${link.content}` : link.what),
};

/** A link in words, as it was at time `t`; `minds` knows the programs. */
export function linkWords(link, minds, t) { return (WORDS[link.kind] ?? ((each) => `${each.kind} ${each.what}`))(link, minds, t); }

/** Where in a program of this run a link arose: file and line; null when it did elsewhere. */
export function linkPlace(link, minds) {
  if (link.kind === "remote") return null;
  if (link.file && link.line) return { file: link.file, line: link.line };
  const plan = link.kind === "event" && minds.plan(link.agent, link.chosen);
  return plan?.line ? { file: plan.file, line: plan.line } : null;
}

/** The last part of an artifact's path or a file's. */
export function shortName(path) { return String(path ?? "").split("/").at(-1); }

/** A plan for people: its label when the program has one, else its trigger. */
export function planName(plan) {
  if (!plan) return "a plan";
  return plan.label && !/^p__\d+/.test(plan.label) ? `@${plan.label}` : plan.trigger;
}

/** A place in a program: patrol.asl:14. */
export function placeName({ file, line }) { return `${shortName(file)}:${line}`; }

/** Why a plan was not taken, in words. */
export function refusalWords(why) { return why || "also applicable, but another plan came first"; }

function rest(what, topic) {
  const text = String(what ?? "").replace(topic ?? "", "").replace(/^[:\s]+/, "");
  return topic && text ? `: ${text}` : "";
}

function within(link) {
  const { what = "", artifact } = link;
  return artifact && what.startsWith(artifact) ? what.slice(artifact.length).trim() : what;
}

function of(artifact) { return artifact ? ` of ${shortName(artifact)}` : ""; }

function handled(link, minds) {
  if (link.chosen) return `, handled by ${planName(minds.plan(link.agent, link.chosen))}`;
  return link.chosen === null ? ", for which no plan was applicable" : "";
}

function stepText(link, minds) {
  // A line may have several steps, of which only the record knows the right one.
  const written = minds.lineText(link.file, link.line).split("<-").at(-1).trim(), single = written && !written.includes(";");
  const plan = minds.plan(link.agent, link.plan), what = String(link.what ?? "").replace(`${link.agent} `, "");
  return `${single ? written : what}${plan ? ` of ${planName(plan)}` : ""}`;
}

function outcome({ outcome: end, reason, ended, t: began, call: isCalled }, t) {
  if (!end) return isCalled ? ", still running" : "";
  if (ended > t) return ", still running";
  if (end === "failed") return `, failed${reason ? `: ${reason}` : ""}`;
  return ended - began >= 0.05 ? `, done after ${(ended - began).toFixed(1)} s` : "";
}

function commandText(link) {
  const topic = link.topic ?? String(link.what).split(/[\s:]/)[0], text = rest(link.what, topic);
  const speeds = [...text.matchAll(VELOCITY)];
  if (!speeds.length && !/cmd_vel/.test(topic)) return `message published on ${topic}${text}`;
  const forward = Number(speeds.find((each) => each[1] !== undefined)?.[1] ?? 0);
  const turning = Number(speeds.find((each) => each[2] !== undefined)?.[2] ?? 0);
  const motions = [];
  if (Math.abs(forward) >= 0.005) motions.push(`${forward.toFixed(2)} m/s`);
  if (Math.abs(turning) >= 0.05) motions.push(`turn ${turning > 0 ? "left" : "right"} at ${Math.abs(turning).toFixed(2)} rad/s`);
  return `wheel command${motions.length ? ` ${motions.join(", ")}` : ": stand still"}`;
}
