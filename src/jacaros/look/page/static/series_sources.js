import { Track } from "./track.js";

const LIMIT = 1000000;  // values of one source that are kept
const IN_ALL = 5000000;
const NUMBER = /^\s*-?\d/, QUOTED = /"(?:[^"\\]|\\.)*"/g, NESTED = /\([^()[\]]*\)|\[[^()[\]]*\]/;

/**
 * The numbers that records contain, each over time: arguments of beliefs, values of properties, states of robots, and what
 * messages say.
 *
 * A source has `key`, `title`, `name` and `argument` (of the belief or property), `agent` (for beliefs), `unit`, `isStep`
 * and `track`.
 */
export class SeriesSources {
  constructor(world) {
    Object.assign(this, { world, sources: new Map(), groups: new Map(), robots: [], count: 0 });
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

  put({ track }, t, value) {
    const last = track.times.length - 1, before = track.values[last];
    // A new value at the moment at which the old one went replaces the gap.
    if (track.times[last] === t && before !== before) track.values[last] = value;
    else if (value === value || before === before) {
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

  /** What is known of a belief, a property or what messages say: `held`, and by argument the `sources` of numbers. */
  group(key, describe) {
    let group = this.groups.get(key);
    if (!group) this.groups.set(key, group = { ...describe(), held: new Set(), sources: [] });
    return group;
  }

  /**
   * Take values that come or go; `id` tells them from others of their group.
   *
   * A name with several values at one time, such as the places of a map, is not one number over time.
   */
  change(t, group, values, id, isHeld) {
    const { held, sources } = group;
    if (isHeld) held.add(id); else held.delete(id);
    if (isHeld) for (let i = 0; i < values.length; i++) if (values[i] === values[i]) this.put(sources[i] ??= this.numbered(group, values, i), t, values[i]);
    if (held.size === 1) return;
    for (const source of sources) {
      if (source && held.size) source.isMany = true;
      else if (source) this.put(source, t, NaN);
    }
  }

  /** The source of a numeric argument of a group. */
  numbered({ prefix, name, of, agent }, values, argument) {
    const place = values.length > 1 ? `${name}.${argument + 1}` : name;  // a name that `jacaros plot` knows
    return this.source(`${prefix} ${name} ${argument}`, () => ({ name, argument, agent, of, unit: UNITS[name] ?? "", title: `${of}:${place}` }));
  }
}

/** The keys of the numbers in a belief. */
export function beliefKeys(agent, text) {
  const [name, literal, annotations] = divided(text);
  return name ? keysOf(`belief ${agent}${ofArtifact(annotations)}`, name, numbersIn(literal, name)) : [];
}

/** The keys of the numbers in a property of an artifact. */
export function propertyKeys(artifact, { name, values }) { return keysOf(`property ${artifact}`, name, values.map(asNumber)); }

/** The keys of a robot's battery and place. */
export function robotKeys(robot) { return ["battery", "x", "y"].map((name) => `robot ${robot} ${name}`); }

/** The keys of the numbers in a message. */
export function messageKeys({ from, to, content }) {
  const [name, literal] = divided(String(content));
  return name ? keysOf(`message ${from} ${to}`, name, numbersIn(literal, name)) : [];
}

function keysOf(prefix, name, values) { return values.flatMap((value, i) => (value === value ? [`${prefix} ${name} ${i}`] : [])); }

const UNITS = { battery: "%" };
const ROBOT = [["battery", "%"], ["x", "m"], ["y", "m"], ["yaw", "°", 180 / Math.PI]];

const TAKE = {
  frame(all, t, rows) {
    rows.forEach(([x, y], index) => {
      const robot = all.robots[index] ??= robotSources(all, index);
      if (t > robot.t) all.put(robot.speed, t, Math.hypot(x - robot.x, y - robot.y) / (t - robot.t));
      Object.assign(robot, { t, x, y });
    });
  },
  laser(all, t, { robot, ranges }) {
    let nearest = Infinity;
    for (const range of ranges) if (range > 0 && range < nearest) nearest = range;
    if (nearest < Infinity) all.put(all.source(`robot ${robot} laser`, () => ({ ...STATE, name: "laser", unit: "m", of: robot, title: `${robot}.laser` })), t, nearest / 100);
  },
  property(all, t, { artifact, name, key, values }) {
    const group = all.group(`${artifact} ${name}`, () => ({ prefix: `property ${artifact}`, name, of: artifact.split("/").at(-1) }));
    all.change(t, group, (values ?? []).map(asNumber), key, Boolean(values));
  },
  belief(all, t, { agent, op, belief }) {
    const [name, literal, annotations] = divided(String(belief));
    if (!name) return;
    const group = all.group(`${agent} ${name}${annotations}`, () => ({ prefix: `belief ${agent}${ofArtifact(annotations)}`, name, of: agent, agent }));
    all.change(t, group, op === "-" ? [] : numbersIn(literal, name), literal, op !== "-");
  },
  message(all, t, { from, to, content, state }) {
    const [name, literal] = state === "read" ? [] : divided(String(content));
    if (!name) return;
    const group = all.group(`${from} ${to} ${name}`, () => ({ prefix: `message ${from} ${to}`, name, of: `${from} → ${to}` }));
    all.change(t, group, numbersIn(literal, name), "", true);
  },
};

const STATE = { argument: 0, isStep: false };

/** Make the sources of a robot's state. The world keeps its pose and battery. */
function robotSources(all, index) {
  const { world } = all, robot = world.robot(index).name;
  const source = (name, unit, more) => all.source(`robot ${robot} ${name}`, () => ({ ...STATE, name, unit, of: robot, title: `${robot}.${name}`, ...more }));
  for (const [name, unit, scale] of ROBOT) {
    const track = { get times() { return world.times; }, get values() { return world.columns[index][name]; } };
    if (name !== "battery" || track.values.at(-1) >= 0) source(name, unit, { scale, track });
  }
  return { speed: source("speed", "m/s"), t: Infinity };
}

function ofArtifact(text) {
  const name = /artifact_name\(([^)]*)\)/.exec(text)?.[1];
  return name ? ` ${name}` : "";
}

function asNumber(value) { return typeof value === "number" ? value : NaN; }

/** Functor of a literal, the literal without its annotations, and these; empty without arguments. */
function divided(text) {
  const open = text.indexOf("("), end = text.indexOf(")[") + 1 || text.length;
  return open < 1 || text.lastIndexOf("[", open) > 0 ? [] : [text.slice(0, open), text.slice(0, end), text.slice(end)];
}

/** The arguments of a literal, NaN for those that are not numbers. */
function numbersIn(literal, { length }) {
  let written = literal.slice(length + 1, -1).replace(QUOTED, "_");
  while (NESTED.test(written)) written = written.replace(NESTED, "_");  // commas in strings, lists and structures do not count
  return written.split(",").map((part) => (NUMBER.test(part) ? Number(part) : NaN));
}
