import { Changing } from "./changing.js";
import { VERSION } from "./schema.js";

const FAULTS = 1000;

/**
 * The records of a run, dispatched to models.
 *
 * A model is an object with `add(t, event, data)`. The event is that of a record of kind "event"; the other kinds arrive
 * as "world" (the drawing), "frame" (the rows of robots) and "text" ({agent, text}).
 */
export class Run extends Changing {
  constructor(models) {
    super();
    this.models = models;
    this.end = 0;  // seconds: the time of the last record
    this.count = 0;  // records so far
    this.over = false;  // the run has ended
    this.faults = [];  // what models could not take, in words
    this.version = VERSION;  // of the recording
  }

  /** What users should know about the records: that some are not shown, in words; "" when all is well. */
  get warning() {
    if (this.version > VERSION) return `This recording is of a newer version (${this.version}). What this page does not know is not shown.`;
    const { length } = this.faults;
    return length ? `${length} ${length === 1 ? "record is" : "records are"} not shown: ${this.faults[0]}` : "";
  }

  add(record) { this.addAll([record]); }

  /** Take records, oldest first, then notify the listeners once. */
  addAll(records) {
    for (const record of records) this.take(record);
    this.notify();
  }

  take(record) {
    const [event, data] = content(record), t = record.t ?? 0;
    if (event === undefined) return;
    this.count += 1;
    if (t > this.end) this.end = t;
    if (event === "run") this.ros = data.ros;
    if (event === "ended") Object.assign(this, { over: true, code: data.code });
    if (record.kind === "world") this.version = record.version ?? 1;
    for (const model of this.models) {
      try { model.add(t, event, data); } catch (error) { this.reject(event, error); }
    }
  }

  /** One broken record must not hide the others. */
  reject(event, error) {
    if (this.faults.length < FAULTS) this.faults.push(`${event}: ${error.message}`);
  }
}

function content(record) {
  switch (record?.kind) {
    case "world": return ["world", record.world ?? {}];
    case "frame": return ["frame", record.robots ?? []];
    case "text": return ["text", { agent: record.agent, text: record.text }];
    case "story": return ["story", { lines: record.lines ?? [], span: record.span }];
    case "event": return [record.event, record.data ?? {}];
    default: return [];
  }
}
