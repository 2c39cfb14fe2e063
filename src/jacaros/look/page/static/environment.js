import { Fold } from "./fold.js";
import { Track } from "./track.js";

const RECENT = 2;  // seconds during which a new value is a recent one
const LIMIT = 5000;  // operations of one artifact that are kept

/** The artifacts of a run, by path, and the ROS graph around its node. */
export class Environment {
  constructor() {
    this.artifacts = new Map();
    this.graphs = new Track();
    this.version = 0;  // grows with each artifact
  }

  add(t, event, data) {
    if (event === "graph") this.graphs.add(t, data);
    else if (OF_ARTIFACTS.has(event) && data.artifact) {
      this.artifact(data.artifact).add(t, event, data);
    }
  }

  artifact(path) {
    if (!this.artifacts.has(path)) {
      this.artifacts.set(path, new Artifact(path));
      this.version += 1;
    }
    return this.artifacts.get(path);
  }

  graph(t) { return this.graphs.at(t); }
}

/** One artifact over time: properties, signals, operations and observers. */
export class Artifact {
  constructor(path) {
    this.path = path;
    this.name = path.split("/").at(-1);
    this.type = "";
    this.robot = null;
    this.states = new Track();
    this.properties = new Fold(changeProperty);
    this.observers = new Fold(changeObserver);
    this.running = new Fold(changeOperation);
    this.signals = new Fold(() => {});
    this.operations = new Track(LIMIT);  // in the order in which they began
    this.open = new Map();  // operations that run, by id
  }

  add(t, event, data) { TAKE[event](this, t, data); }

  /** Whether the artifact is there at time `t`. */
  isThere(t) { return (this.states.at(t) ?? this.states.values[0] ?? "made") === "made"; }

  /** The properties at time `t`: name, values, since, cause. */
  propertiesAt(t) { return [...this.properties.at(t).values()]; }

  isRecent(property, t) { return property.since > t - RECENT && property.since > 0; }

  /** The operations that run at time `t`. */
  runningAt(t) { return [...this.running.at(t).values()]; }

  /** The last `count` operations that began up to time `t`, the newest first, with their outcome at `t`. */
  lastOperations(t, count) {
    const end = this.operations.countAt(t);
    return this.operations.values.slice(Math.max(0, end - count), end).reverse().map((each) => outcomeAt(each, t));
  }

  lastSignals(t, count) {
    const end = this.signals.countAt(t);
    return this.signals.changes.slice(Math.max(0, end - count), end).reverse();
  }

  observersAt(t) { return [...this.observers.at(t).keys()]; }

  /** The same as long as nothing about the artifact has changed. */
  stamp(t) {
    return [this.properties, this.observers, this.running, this.signals].map((each) => each.countAt(t)).join(" ")
      + ` ${this.isThere(t)}`;
  }
}

const OF_ARTIFACTS = new Set(["artifact", "focus", "property", "signal", "operation"]);

const TAKE = {
  artifact(artifact, t, { type, state, robot }) {
    artifact.type = type ?? artifact.type;
    artifact.robot = robot ?? artifact.robot;
    artifact.states.add(t, state);
  },
  focus(artifact, t, data) { artifact.observers.add(t, data); },
  property(artifact, t, data) { artifact.properties.add(t, { ...data, t }); },
  signal(artifact, t, data) { artifact.signals.add(t, { ...data, t }); },
  operation(artifact, t, data) {
    if (data.state === "began") {
      const made = { ...data, began: t, ended: Infinity, outcome: "runs" };
      artifact.operations.add(t, made);
      artifact.open.set(data.id, made);
    } else if (artifact.open.has(data.id)) {
      Object.assign(artifact.open.get(data.id), { ended: t, outcome: data.state, reason: data.reason });
      artifact.open.delete(data.id);
    }
    artifact.running.add(t, { ...data, t });
  },
};

function changeProperty(properties, { name, key, values, cause, t }) {
  const id = key ?? name;
  if (values === null || values === undefined) properties.delete(id);
  else properties.set(id, { id, name, values, cause, since: t });
}

function changeObserver(observers, { agent, on }) {
  if (on) observers.set(agent, true); else observers.delete(agent);
}

function changeOperation(running, { id, state, t, ...data }) {
  if (state === "began") running.set(id, { id, ...data, since: t }); else running.delete(id);
}

function outcomeAt(operation, t) {
  return operation.ended <= t ? operation : { ...operation, outcome: "runs", reason: "" };
}

/** A property as text: `battery(12)`. */
export function propertyText({ name, values }) {
  return values.length ? `${name}(${values.map(valueText).join(", ")})` : name;
}

/** A value of a property as text. */
export function valueText(value) {
  if (Array.isArray(value)) return `[${value.map(valueText).join(", ")}]`;
  if (typeof value === "number" && !Number.isInteger(value)) return String(Number(value.toFixed(3)));
  return typeof value === "object" && value !== null ? JSON.stringify(value) : String(value);
}
