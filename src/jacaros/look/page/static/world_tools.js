import { button, element, setText } from "./elements.js";

const CHANGES = ["move_robot", "battery", "door", "obstacle", "person", "fault"];
const DOORS = 6;  // doors with buttons of their own; of more, those that are selected have them

/** What you can change in the embedded world: robots, doors, obstacles, people, batteries. Hidden where nothing can be. */
export class WorldTools {
  constructor(root, { commands, selection, time }, world) {
    Object.assign(this, { root, commands, selection, time, world });
    this.placing = null;  // what the next click on the map places: "obstacle" or "person"
    this.key = "";
    this.row = element("div", "offers");
    this.status = element("p", "status");
    this.status.setAttribute("role", "status");
    root.append(this.row, this.status);
  }

  can(command) { return this.commands.can.has(command); }

  /** Only what is now can be changed, not the past. */
  get empty() {
    return !this.time.live || !CHANGES.some((each) => this.can(each));
  }

  canMove() { return !this.empty && this.can("move_robot"); }

  move(robot, x, y) { this.send("move_robot", { robot, x, y }); }

  /** Place what was chosen at a point of the world; false when nothing was chosen. */
  place(x, y) {
    if (!this.placing || this.empty) return false;
    this.send(this.placing, { x, y });
    this.choose(null);
    return true;
  }

  choose(what) {
    this.placing = this.placing === what ? null : what;
    this.show(this.time.now);
  }

  async send(command, args) {
    try {
      await this.commands.send(command, args);
      setText(this.status, "");
    } catch (error) { setText(this.status, error.message); }
  }

  show(t) {
    const doors = this.doors(t), { robot, person, obstacle } = this.selection.current;
    const key = JSON.stringify([[...this.commands.can], this.placing, doors, robot, person, obstacle]);
    if (key === this.key) return;
    this.key = key;
    const focused = document.activeElement?.dataset?.tool;
    this.row.replaceChildren(...this.placers(), ...doors.map((door) => this.doorButton(door)), ...this.forRobot(robot, t),
      ...this.remover("person", person), ...this.remover("obstacle", obstacle), ...this.faultForm());
    if (focused) this.row.querySelector(`[data-tool="${CSS.escape(focused)}"]`)?.focus();
  }

  tool(name, act, ...children) {
    const made = button("plain tool", act, ...children);
    made.dataset.tool = name;
    return made;
  }

  placers() {
    const titles = { obstacle: "Place an obstacle", person: "Place a person" };
    const made = Object.keys(titles).filter((each) => this.can(each)).map((each) => {
      const placer = this.tool(each, () => this.choose(each), titles[each]);
      placer.setAttribute("aria-pressed", String(this.placing === each));
      return placer;
    });
    return this.placing ? [...made, this.placeForm()] : made;
  }

  /** Where to place it, for those who do not click on the map. */
  placeForm() {
    const what = this.placing;
    return this.form("Place", { x: 0, y: 0 }, ({ x, y }) => { this.placing = what; this.place(x, y); }, "Click on the map, or ");
  }

  doors(t) {
    if (!this.can("door")) return [];
    const all = this.world.drawing(t).doors, { door: selected } = this.selection.current;
    return all.filter(({ name }) => all.length <= DOORS || name === selected)
      .map((door) => ({ name: door.name, open: this.world.doorOpen(door, t) }));
  }

  doorButton({ name, open }) {
    return this.tool(`door ${name}`, () => this.send("door", { name, open: !open }), `${open ? "Close" : "Open"} ${name}`);
  }

  forRobot(robot, t) {
    const index = this.world.indexOf(robot), state = robot === undefined || index < 0 ? null : this.world.state(index, t);
    if (!state) return [];
    const forms = [];
    if (this.can("move_robot")) {
      const place = { x: Number(state.x.toFixed(2)), y: Number(state.y.toFixed(2)) };
      forms.push(this.form("Move", place, (to) => this.send("move_robot", { robot, ...to }), `${robot}: `));
    }
    if (this.can("battery") && state.battery >= 0) {
      const level = { "battery %": Math.round(state.battery) };
      forms.push(this.form("Set", level, (given) => this.send("battery", { robot, level: given["battery %"] })));
    }
    return forms;
  }

  remover(what, name) {
    if (name === undefined || !this.can(what)) return [];
    return [this.tool(`remove ${name}`, () => {
      this.send(what, { remove: name });
      this.selection.clear();
    }, `Remove ${name.replaceAll("_", " ")}`)];
  }

  /** A fault of the fault file, to begin or to end. */
  faultForm() {
    if (!this.can("fault")) return [];
    const name = element("input");
    Object.assign(name, { name: "fault", required: true, autocomplete: "off" });
    const begin = element("button", "plain tool", "Begin"), end = element("button", "plain tool", "End");
    const made = element("form", "numbers", element("label", "", "fault ", name), begin, end);
    made.addEventListener("submit", (event) => {
      event.preventDefault();
      this.send("fault", { name: name.value, on: event.submitter !== end });
    });
    return [made];
  }

  /** A line of fields for numbers, with a button. */
  form(title, fields, act, before = "") {
    const inputs = Object.entries(fields).map(([name, value]) => {
      const input = element("input");
      Object.assign(input, { type: "number", step: "any", value: String(value), name, required: true });
      return input;
    });
    const labels = inputs.map((input) => element("label", "", `${input.name} `, input));
    const submit = element("button", "plain tool", title);
    const made = element("form", "numbers", before, ...labels, submit);
    made.addEventListener("submit", (event) => {
      event.preventDefault();
      act(Object.fromEntries(inputs.map((input) => [input.name, input.valueAsNumber])));
    });
    return made;
  }
}
