import { EMPTY, ROBOT_STATE } from "./schema.js";
import { Track, indexAt } from "./track.js";

// A live page may be open for days: what is older is forgotten.
const SCANS = 20000;  // of all robots
const ROWS = 2000000;  // of frames: one for each robot

/** The world and its robots over time. */
export class World {
  constructor() {
    this.drawings = new Track();
    this.times = [];  // of frames
    this.columns = [];  // by robot: the values of each field of its state, and `first`, the frame in which it appeared
    this.names = [];
    this.version = 0;  // grows when the drawing changes
    this.lasers = new Map();
    this.paths = new Map();
    this.believed = new Map();
    this.doors = new Map();
    this.objects = new Map();
    this.people = new Map();
    this.obstacles = new Map();
    this.dirt = new Map();
    this.visited = null;  // bounds of where robots were
  }

  add(t, event, data) { TAKE[event]?.(this, t, data); }

  /** Whether there is anything to draw. */
  get empty() { return !this.bounds; }

  /** Bounds of the newest drawing, and of where robots were. */
  get bounds() { return joined(this.drawings.values.at(-1)?.bounds, this.visited); }

  /** The drawing at time `t`; before the first one, that one: on a real graph it comes late. */
  drawing(t) { return this.drawings.at(t) ?? this.drawings.values[0] ?? EMPTY; }

  /** Description of robot number `index`: name, radius. */
  robot(index) {
    const drawings = this.drawings.values, known = drawings[drawings.length - 1]?.robots[index];
    return { radius: 0.17, ...known, name: known?.name ?? this.names[index] ?? `robot ${index + 1}` };
  }

  /** Number of a robot, -1 for an unknown name. */
  indexOf(name) { return this.columns.findIndex((_, index) => this.robot(index).name === name); }

  get robotCount() { return this.columns.length; }

  /** State of robot number `index` at time `t`, between two frames; null before it was known. */
  state(index, t) {
    const robot = this.columns[index], i = Math.max(indexAt(this.times, t), 0), j = Math.min(i + 1, this.times.length - 1);
    if (!robot || i < robot.first) return null;
    const span = this.times[j] - this.times[i];
    const part = span > 0 ? Math.min(1, Math.max(0, (t - this.times[i]) / span)) : 0;
    const mix = (values) => values[i] + (values[j] - values[i]) * part;
    return {
      frame: i, x: mix(robot.x), y: mix(robot.y), yaw: robot.yaw[i] + turn(robot.yaw[i], robot.yaw[j]) * part,
      battery: mix(robot.battery), charging: Boolean(robot.charging[i]), touching: Boolean(robot.touching[i]),
    };
  }

  doorOpen(door, t) { return this.doors.get(door.name)?.at(t) ?? door.open; }

  /** The objects that lie somewhere at time `t`; a robot holds the others. */
  objectsAt(t) {
    const lie = [];
    for (const object of this.drawing(t).objects) {
      const place = this.objects.has(object.name) ? this.objects.get(object.name).at(t) : undefined;
      if (place !== null) lie.push({ ...object, place: place ?? object.place });
    }
    return lie;
  }

  /** The people who are there at time `t`: where the last event of each says, straight on since then. */
  peopleAt(t) {
    const found = [];
    for (const person of this.drawing(t).people) {
      if (!this.people.get(person.name)?.at(t)) found.push({ ...person, x: person.path[0][0], y: person.path[0][1] });
    }
    for (const [name, track] of this.people) {
      const walk = track.at(t), passed = t - track.since(t);
      if (walk && !walk.gone) found.push({ ...walk, name, x: walk.x + walk.vx * passed, y: walk.y + walk.vy * passed });
    }
    return found;
  }

  /** The obstacles that were put on the floor and are there at time `t`. */
  obstaclesAt(t) { return [...this.obstacles.values()].map((track) => track.at(t)).filter(Boolean); }

  /** Grams of dirt that are left at time `t`. */
  dirtLeft(room, dirt, t) { return this.dirt.get(`${room.name}/${dirt.kind}`)?.at(t) ?? dirt.grams; }

  /** The last scan of robot number `index`, with the state that the robot had then: it may have turned since. */
  scan(index, t) {
    const scans = this.lasers.get(this.robot(index).name), scan = scans?.at(t), state = scan && this.state(index, scans.since(t));
    return state ? { ...scan, state } : null;
  }
  path(robot, t) { return this.paths.get(robot)?.at(t) ?? []; }
  belief(robot, t) { return this.believed.get(robot)?.at(t); }
}

function joined(a, b) {
  if (!a || !b) return a ?? b ?? null;
  return [Math.min(a[0], b[0]), Math.min(a[1], b[1]), Math.max(a[2], b[2]), Math.max(a[3], b[3])];
}

const TAKE = {
  world(world, t, drawing) {
    if (!drawing.bounds) return;
    world.drawings.add(t, { ...EMPTY, ...drawing });
    world.version += 1;
  },
  frame(world, t, rows) {
    if (!rows.length) return;
    world.times.push(t);
    rows.forEach((row, index) => addRow(world, index, row));
    if (world.times.length * rows.length > ROWS) forget(world, world.times.length >> 2);
  },
  laser(world, t, data) { track(world.lasers, data.robot, SCANS / Math.max(1, world.lasers.size)).add(t, data); },
  path(world, t, data) { track(world.paths, data.robot).add(t, data.points); },
  believed(world, t, data) { track(world.believed, data.robot).add(t, data); },
  door_opened(world, t, data) { track(world.doors, data.door).add(t, true); },
  door_closed(world, t, data) { track(world.doors, data.door).add(t, false); },
  picked(world, t, data) { track(world.objects, data.object).add(t, null); },
  placed(world, t, data) { track(world.objects, data.object).add(t, [data.x, data.y]); },
  person_comes(world, t, data) { walk(world, t, data, data); },
  person_walks(world, t, data) { walk(world, t, data); },
  person_stands(world, t, data) { walk(world, t, data); },
  person_goes(world, t, data) { track(world.people, data.person).add(t, { gone: true }); },
  obstacle_placed(world, t, data) { track(world.obstacles, data.obstacle).add(t, { ...data, name: data.obstacle }); },
  obstacle_removed(world, t, data) { track(world.obstacles, data.obstacle).add(t, null); },
  cleaned(world, t, data) { track(world.dirt, `${data.room}/${data.dirt}`).add(t, data.grams); },
};

function track(tracks, key, limit) {
  if (!tracks.has(key)) tracks.set(key, new Track(limit));
  return tracks.get(key);
}

function addRow(world, index, row) {
  const last = world.times.length - 1;
  // A robot that is found late is where it was found until then, so that every column has one value for each frame.
  const robot = world.columns[index] ??= { first: last, ...Object.fromEntries(ROBOT_STATE.map((name, i) => [name, new Array(last).fill(row[i])])) };
  ROBOT_STATE.forEach((name, i) => { robot[name][last] = row[i]; });
  const x = robot.x[last], y = robot.y[last];
  world.visited = joined([x, y, x, y], world.visited);
}

/** Forget the oldest frames. */
function forget(world, count) {
  world.times.splice(0, count);
  for (const robot of world.columns) {
    for (const name of ROBOT_STATE) robot[name].splice(0, count);
    robot.first = Math.max(0, robot.first - count);
  }
  world.version += 1;
}

function walk(world, t, data, known) {
  const tracks = track(world.people, data.person);
  const person = known ?? tracks.at(t) ?? world.drawing(t).people.find((each) => each.name === data.person);
  if (!person) return;
  const { radius, color, path, loop } = person;
  tracks.add(t, { radius, color, path, loop, x: data.x, y: data.y, vx: data.vx ?? 0, vy: data.vy ?? 0 });
}

/** The shorter way from one angle to another. */
function turn(from, to) {
  const way = (to - from) % (2 * Math.PI);
  return way > Math.PI ? way - 2 * Math.PI : way < -Math.PI ? way + 2 * Math.PI : way;
}
