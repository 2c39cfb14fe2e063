import { NO_COMMANDS, fragment, startPage } from "./main.js";

/** The records inside the page: lines of JSON, gzipped, in base64. The first line has the frames, as columns. */
async function records() {
  const text = document.getElementById("recording").textContent.trim();
  const bytes = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("gzip"));
  const lines = (await new Response(stream).text()).split("\n").filter(Boolean).map((line) => JSON.parse(line));
  return merged(frames(lines[0]), lines.slice(1));
}

/** Frames of columns of differences, in milliseconds, millimetres, milliradians and tenths of a percent. */
function frames({ t, robots }) {
  const times = sums(t, 0.001);
  const columns = robots.map(({ x, y, yaw, battery, flags }) => ({
    first: times.length - x.length, x: sums(x, 0.001), y: sums(y, 0.001), yaw: sums(yaw, 0.001), battery: sums(battery, 0.1), flags,
  }));
  return times.map((moment, i) => ({ kind: "frame", t: moment, robots: columns.filter(({ first }) => first <= i).map((c) => row(c, i - c.first)) }));
}

function row({ x, y, yaw, battery, flags }, i) { return [x[i], y[i], yaw[i], battery[i], flags[i] & 1, flags[i] & 2]; }

function sums(differences, unit) {
  let sum = 0;
  return differences.map((difference) => (sum += difference) * unit);
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
try {
  page.run.addAll(await records());
  page.time.go(Number(fragment().get("t")) || 0);
  page.show();
} catch (error) {
  const old = typeof DecompressionStream === "undefined";
  page.notice(old ? "This browser is too old for this page: it lacks DecompressionStream."
    : `The recording cannot be read: ${error.message}`);
}
