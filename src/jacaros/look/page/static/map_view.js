import { FloorDrawing } from "./floor_drawing.js";
import { decimals, button, element } from "./elements.js";
import { MapNames } from "./map_names.js";
import { MapPointer } from "./map_pointer.js";
import { Camera, Projection } from "./projection.js";
import { drawBelieved, drawLaser, drawPlan, drawRobot, sizeOf } from "./robot_drawing.js";
import { drawDirt, drawDoors, drawObjects, drawObstacles, drawPeople } from "./thing_drawing.js";
import { TrailDrawing } from "./trail_drawing.js";

const REACH = 8;  // pixels around a robot, a door or a person in which a click selects it
const BUTTONS = { width: 270, height: 36 };  // pixels of the corner below, where names would be on the buttons

/** The world from above. What stands still, and the paths so far, are kept on canvases of their own. */
export class MapView {
  /** @param {object} tools `canMove(robot)`, `move(robot, x, y)`, and `place(x, y)`: whether something was placed there. */
  constructor(root, { selection }, world, links, tools) {
    Object.assign(this, { root, selection, world, links, tools });
    this.camera = new Camera();
    this.dragged = null;  // a robot that the pointer holds, and where
    this.canvas = element("canvas");
    this.canvas.setAttribute("role", "img");
    this.pen = this.canvas.getContext("2d");
    this.floor = new FloorDrawing();
    this.trails = new TrailDrawing(world);
    this.names = new MapNames();
    root.append(this.canvas, this.makeLegend());
    new MapPointer(this.canvas, this);
    this.key = "";
  }

  makeLegend() {
    this.layers = { laser: true, trail: true };
    const legend = element("div", "layers");
    legend.setAttribute("role", "group");
    legend.setAttribute("aria-label", "Layers of the map");
    this.laserButton = this.layerButton("laser", "Laser");
    legend.append(this.layerButton("trail", "Path so far"), this.laserButton,
      this.zoomButton("+", "Zoom in", 1.4), this.zoomButton("−", "Zoom out", 1 / 1.4));
    return legend;
  }

  zoomButton(sign, title, factor) {
    const made = button("plain layer", () => {
      this.camera.enlarge(factor);
      this.redraw();
    }, sign);
    made.setAttribute("aria-label", title);
    return made;
  }

  layerButton(layer, title) {
    const made = button("plain layer", () => {
      this.layers[layer] = !this.layers[layer];
      made.setAttribute("aria-pressed", String(this.layers[layer]));
      this.redraw();
    }, title);
    made.setAttribute("aria-pressed", "true");
    return made;
  }

  /** Draw everything anew next time, for example because the colours have changed. */
  invalidate() { this.key = ""; }

  redraw() { this.show(this.t); }

  show(t) {
    this.t = t;
    const box = this.canvas.getBoundingClientRect();
    if (box.width < 2 || box.height < 2) return;
    this.fit(box, t);
    this.draw(t);
    this.laserButton.hidden = this.world.lasers.size === 0;
    this.describe(t);
  }

  /** Fit the world into the canvas, when one of them has changed. */
  fit(box, t) {
    const ratio = window.devicePixelRatio || 1, drawing = this.world.drawing(t);
    const bounds = this.world.bounds.map((value, side) => (side < 2 ? Math.floor(value * 2) : Math.ceil(value * 2)) / 2);
    const key = [box.width, box.height, ratio, this.world.version, this.world.drawings.since(t), ...bounds,
      ...Object.values(this.camera)].join(" ");
    if (key === this.key) return;
    this.key = key;
    this.projection = new Projection(bounds, box.width, box.height, this.camera);
    const aspect = (bounds[2] - bounds[0]) / Math.max(0.1, bounds[3] - bounds[1]);
    this.root.style.setProperty("--aspect", String(Math.min(2, Math.max(0.8, aspect))));
    this.canvas.classList.toggle("enlarged", this.camera.zoom > 1);
    for (const canvas of [this.canvas, this.floor.canvas, this.trails.canvas]) {
      canvas.width = Math.max(1, Math.round(box.width * ratio));
      canvas.height = Math.max(1, Math.round(box.height * ratio));
    }
    this.ratio = ratio;
    this.floor.draw(drawing, this.projection, ratio, box, this.world);
    this.trails.restart(this.projection, ratio);
  }

  draw(t) {
    const { pen, projection, world, canvas } = this;
    const states = Array.from({ length: world.robotCount }, (_, index) => world.state(index, t));
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, canvas.width, canvas.height);
    pen.drawImage(this.floor.canvas, 0, 0);
    if (this.layers.trail) pen.drawImage(this.trails.extendTo(t), 0, 0);
    pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    pen.lineJoin = pen.lineCap = "round";
    drawDirt(pen, projection, world, t);
    drawDoors(pen, projection, world, t);
    if (this.layers.trail) this.trails.drawRest(pen, t, states);
    drawObstacles(pen, projection, world, t);
    drawObjects(pen, projection, world, t);
    if (this.layers.laser) this.eachRobot(states, (_robot, _state, index) => drawLaser(pen, projection, world.scan(index, t), index));
    this.eachRobot(states, (robot, state, index) => drawPlan(pen, projection, world.path(robot.name, t), index));
    drawPeople(pen, projection, world, t);
    this.eachRobot(states, (robot, state, index) => drawBelieved(pen, projection, robot, world.belief(robot.name, t), state, index));
    this.eachRobot(states, (robot, state, index) => drawRobot(pen, projection, robot, state, {
      index, selected: this.isSelected(robot.name, t),
    }));
    this.drawNames(states, t);
    this.drawDragged(states);
  }

  /** Draw the names of all robots; the only one is named while it is selected. */
  drawNames(states, t) {
    const named = [], { projection } = this;
    this.eachRobot(states, (robot, state) => {
      const matters = robot.name === this.hovered || this.isSelected(robot.name, t);
      const size = sizeOf(robot, projection) + 4;
      if (matters || states.length > 1) named.push({ name: robot.name, x: projection.x(state.x), y: projection.y(state.y), size, matters });
    });
    this.names.draw(this.pen, named, projection, [0, projection.height - BUTTONS.height, BUTTONS.width, projection.height]);
  }

  /** Draw the robot that the pointer holds where it would be put down. */
  drawDragged(states) {
    if (!this.dragged) return;
    this.eachRobot(states, (robot, state, index) => {
      if (robot.name === this.dragged.robot) drawBelieved(this.pen, this.projection, robot, { ...state, ...this.dragged }, state, index);
    });
  }

  eachRobot(states, act) {
    states.forEach((state, index) => { if (state) act(this.world.robot(index), state, index); });
  }

  isSelected(robot, t) {
    const { robot: selected, agent } = this.selection.current;
    return selected === robot || (agent !== undefined && this.links.robots(agent, t).includes(robot));
  }

  /** Say the map in words, for screen readers. */
  describe(t) {
    const robots = [];
    for (let index = 0; index < this.world.robotCount; index++) {
      const state = this.world.state(index, t);
      if (state) robots.push(`${this.world.robot(index).name} at ${decimals(state.x, 1)}, ${decimals(state.y, 1)}`);
    }
    const { name, doors } = this.world.drawing(t);
    const open = doors.map((door) => `door ${door.name} ${this.world.doorOpen(door, t) ? "open" : "closed"}`);
    const text = `Map${name ? ` of ${name}` : ""}: ${[...robots.slice(0, 20), ...open].join("; ") || "no robots"}`;
    if (this.canvas.getAttribute("aria-label") !== text) this.canvas.setAttribute("aria-label", text);
  }

  /** Name the robot below the pointer, even where names have no room. */
  hover(found) {
    if (found?.robot === this.hovered) return;
    this.hovered = found?.robot;
    this.redraw();
  }

  canDrag(found) { return found.robot !== undefined && this.tools.canMove(); }

  dragTo(found, x, y) {
    if (!found) { this.dragged = null; return; }
    const [worldX, worldY] = this.projection.point(x, y);
    this.dragged = { robot: found.robot, x: worldX, y: worldY };
  }

  drop(found, x, y) {
    this.dragged = null;
    this.tools.move(found.robot, ...this.projection.point(x, y));
    this.redraw();
  }

  click(x, y) {
    if (this.tools.place(...this.projection.point(x, y))) return;
    const found = this.find(x, y);
    if (found?.robot) this.selection.choose(this.links.selectionOf(found.robot, this.t));
    else if (found) this.selection.choose(found); else this.selection.clear();
  }

  /** What is at a point of the canvas, as a selection; null for nothing. */
  find(x, y) {
    const { world, projection, t } = this;
    const near = (px, py, size) => Math.hypot(projection.x(px) - x, projection.y(py) - y) <= size + REACH;
    for (let index = world.robotCount - 1; index >= 0; index--) {
      const state = world.state(index, t), robot = world.robot(index);
      if (state && near(state.x, state.y, robot.radius * projection.scale)) return { robot: robot.name };
    }
    const person = world.peopleAt(t).find((each) => near(each.x, each.y, each.radius * projection.scale));
    if (person) return { person: person.name };
    const obstacle = world.obstaclesAt(t).find((each) => near(each.x, each.y, each.radius * projection.scale));
    if (obstacle) return { obstacle: obstacle.name };
    const door = world.drawing(t).doors.find(({ segment: [ax, ay, bx, by] }) => near((ax + bx) / 2, (ay + by) / 2, Math.hypot(bx - ax, by - ay) / 2 * projection.scale));
    return door ? { door: door.name } : null;
  }
}
