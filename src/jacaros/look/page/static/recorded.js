import { NO_COMMANDS, fragment, startPage } from "./main.js";
import { ROBOT_STATE } from "./schema.js";

/** The records inside the page: lines of JSON, gzipped, in base64. The first line has the frames, as columns. */
async function records() {
  const text = document.getElementById("recording").textContent.trim();
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const lines = (await new Response(stream).text()).split("\n").filter(Boolean).map((line) => JSON.parse(line));
  return merged(frames(lines[0]), lines.slice(1));
}

/** Frames of columns of differences: whole milliseconds, and for each field of a robot's state, `scales` to its unit. */
function frames({ t, scales, robots }) {
  const times = sums(t, 1000), columns = robots.map((robot) => ROBOT_STATE.map((name) => sums(robot[name], scales[name])));
  return times.map((moment, i) => {
    const known = columns.filter(([{ length }]) => times.length - length <= i);
    return { kind: "frame", t: moment, robots: known.map((robot) => robot.map((values) => values[i - times.length + values.length])) };
  });
}

function sums(differences, scale) {
  let sum = 0;
  return differences.map((difference) => (sum += difference) / scale);
}

/** Two sequences of records as one, in the order of time; what has no time comes first. */
function merged(some, others) {
  const all = [];
  let i = 0;
  for (const record of others) {
    for (; i < some.length && some[i].t <= (record.t ?? 0) && record.t !== undefined; i++) all.push(some[i]);
    all.push(record);
  }
  return all.concat(some.slice(i));
}

const page = startPage({ live: false, commands: NO_COMMANDS });
page.setTitle(document.title);
const nothing = document.getElementById("nothing"), words = nothing.textContent;
nothing.textContent = "Loading the recording …";
try {
  page.run.addAll(await records());
  nothing.textContent = words;
  if (fragment().has("t")) page.time.go(Number(fragment().get("t")) || 0);
  page.show();
} catch (error) {
  const old = typeof DecompressionStream === "undefined";
  page.notice(old ? "This browser is too old for this page: it lacks DecompressionStream."
    : `The recording cannot be read: ${error.message}`);
}
