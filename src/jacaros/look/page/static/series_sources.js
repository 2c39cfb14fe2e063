import { Track } from "./track.js";

const LIMIT = 1000000;  // values of one source that are kept
const IN_ALL = 5000000;
const MOST = 12;  // arguments
const NUMBER = /^-?\d/;

/**
 * The numbers that records contain, each over time: arguments of beliefs, values of properties, states of robots, and what
 * messages say.
 *
 * A source has `key`, `title`, `name` and `argument` (of the belief or property), `agent` (for beliefs), `unit`, `isStep`
 * and `track`.
 */
export class SeriesSources {
  constructor(world) {
    Object.assign(this, { world, sources: new Map(), held: new Map(), robots: [], count: 0 });
    this.version = 0;  // grows with each source
  }

  add(t, event, data) { TAKE[event]?.(this, t, data); }

  get(key) { return this.sources.get(key); }

  /** The keys of `keys` that can be drawn. */
  known(keys) { return keys.filter((key) => this.sources.has(key) && !this.sources.get(key).isMany); }

  /** All sources that can be drawn. */
  shown() { return [...this.sources.values()].filter(({ isMany }) => !isMany); }

  /** The source with a key, created when it is new. */
  source(key, describe) {
    let source = this.sources.get(key);
    if (!source) {
      source = { key, isStep: true, unit: "", track: new Track(LIMIT), ...describe() };
      this.sources.set(key, source);
      this.version += 1;
    }
    return source;
  }

  put(t, value, key, describe) {
    const { track } = this.source(key, describe), last = track.times.length - 1;
    if (Number.isNaN(value) && !(track.values[last] === track.values[last])) return;
    // A new value at the moment at which the old one went replaces the gap.
    if (track.times[last] === t && Number.isNaN(track.values[last])) track.values[last] = value;
    else {
      track.add(t, value);
      if (++this.count > IN_ALL) this.forget();
    }
  }

  /** Drop the older half of everything. */
  forget() {
    for (const { track } of this.sources.values()) {
      if (track instanceof Track) for (const list of [track.times, track.values]) list.splice(0, list.length >> 1);
    }
    this.count >>= 1;
  }

  /** Take the numbers of a literal or property; `prefix` tells whose they are. */
  putAll(t, prefix, { name, values }, more) {
    values.forEach((value, argument) => {
      if (Number.isNaN(value)) return;
      const place = values.length > 1 ? `${name}(${values.map((_, i) => (i === argument ? "#" : "_")).join(",")})` : name;
      this.put(t, value, `${prefix} ${name} ${argument}`, () => ({ name, argument, unit: UNITS[name] ?? "", ...more, title: `${more.of} ${place}` }));
    });
  }

  /**
   * Take a belief or property that comes or goes; `id` tells it from others with its name.
   *
   * A name with several values at one time, such as the places of a map, is not one number over time.
   */
  change(t, prefix, literal, id, isHeld, more) {
    const whose = `${prefix} ${literal.name}`, held = this.held.get(whose) ?? new Set();
    this.held.set(whose, held);
    if (isHeld) held.add(id); else held.delete(id);
    if (isHeld) this.putAll(t, prefix, literal, more);
    for (let i = 0; i < MOST && held.size !== 1; i++) {
      const source = this.sources.get(`${whose} ${i}`);
      if (source && !held.size) this.put(t, NaN, source.key);
      else if (source) source.isMany = true;
    }
  }
}

/** The keys of the numbers in a belief. */
export function beliefKeys(agent, text) {
  const literal = parsed(text);
  return literal ? keysOf(`belief ${agent}${ofArtifact(text)}`, literal) : [];
}

/** The keys of the numbers in a property of an artifact. */
export function propertyKeys(artifact, { name, values }) { return keysOf(`property ${artifact}`, { name, values: values.map(asNumber) }); }

/** The keys of a robot's battery and place. */
export function robotKeys(robot) { return ["battery", "x", "y"].map((name) => `robot ${robot} ${name}`); }

/** The keys of the numbers in a message. */
export function messageKeys({ from, to, content }) {
  const literal = parsed(String(content));
  return literal ? keysOf(`message ${from} ${to}`, literal) : [];
}

function keysOf(prefix, { name, values }) {
  return values.flatMap((value, i) => (Number.isNaN(value) ? [] : [`${prefix} ${name} ${i}`]));
}

const UNITS = { battery: "%" };
const ROBOT = [["battery", "%"], ["x", "m"], ["y", "m"], ["yaw", "°", 180 / Math.PI]];

const TAKE = {
  frame(all, t, rows) {
    rows.forEach(([x, y], index) => {
      const robot = all.robots[index] ??= robotSources(all, index);
      if (t > robot.t) all.put(t, Math.hypot(x - robot.x, y - robot.y) / (t - robot.t), robot.speed);
      Object.assign(robot, { t, x, y });
    });
  },
  laser(all, t, { robot, ranges }) {
    let nearest = Infinity;
    for (const range of ranges) if (range > 0 && range < nearest) nearest = range;
    if (nearest < Infinity) all.put(t, nearest / 100, `robot ${robot} laser`, () => ({ name: "laser", argument: 0, unit: "m", of: robot, title: `${robot} nearest echo` }));
  },
  property(all, t, { artifact, name, key, values }) {
    const property = { name, values: (values ?? []).map(asNumber) };
    all.change(t, `property ${artifact}`, property, key, Boolean(values), { of: artifact.split("/").at(-1) });
  },
  belief(all, t, { agent, op, belief }) {
    const text = String(belief), literal = parsed(text);
    if (!literal || literal.values.every(Number.isNaN)) return;
    all.change(t, `belief ${agent}${ofArtifact(text)}`, literal, text.slice(0, text.lastIndexOf(")[") + 1) || text, op !== "-", { of: agent, agent });
  },
  message(all, t, { from, to, content, state }) {
    const literal = state === "read" ? null : parsed(String(content));
    if (literal) all.putAll(t, `message ${from} ${to}`, literal, { of: `${from} → ${to}` });
  },
};

/** Make the sources of a robot's state. The world keeps its pose and battery. */
function robotSources(all, index) {
  const { world } = all, robot = world.robot(index).name;
  const describe = (name, unit) => ({ name, unit, argument: 0, of: robot, title: `${robot} ${name}`, isStep: false });
  for (const [name, unit, scale] of ROBOT) {
    if (name === "battery" && world.columns[index].battery.at(-1) < 0) continue;
    const track = { get times() { return world.times; }, get values() { return world.columns[index][name]; } };
    all.source(`robot ${robot} ${name}`, () => ({ ...describe(name, unit), scale, track }));
  }
  const speed = `robot ${robot} speed`;
  all.source(speed, () => describe("speed", "m/s"));
  return { speed, t: Infinity };
}

function ofArtifact(text) {
  const name = /artifact_name\(([^)]*)\)/.exec(text)?.[1];
  return name ? ` ${name}` : "";
}

function asNumber(value) { return typeof value === "number" ? value : NaN; }

/** Functor and arguments of a literal, NaN for those that are not numbers; null without arguments. */
function parsed(text) {
  const open = text.indexOf("("), bracket = text.indexOf("[");
  if (open < 1 || (bracket >= 0 && bracket < open)) return null;
  const values = [];
  let depth = 0, isQuoted = false, start = open + 1;
  for (let i = open; i < text.length; i++) {
    const sign = text[i];
    if (isQuoted) {
      if (sign === "\\") i += 1; else isQuoted = sign !== '"';
    } else if (sign === '"') isQuoted = true;
    else if (sign === "(" || sign === "[") depth += 1;
    else if (sign === "," && depth === 1) start = take(values, text, start, i);
    else if (sign === ")" || sign === "]") {
      depth -= 1;
      if (depth === 0) {
        take(values, text, start, i);
        break;
      }
    }
  }
  return { name: text.slice(0, open), values };
}

function take(values, text, start, end) {
  const written = text.slice(start, end).trim();
  values.push(NUMBER.test(written) ? Number(written) : NaN);
  return end + 1;
}
