import { drawName } from "./robot_drawing.js";

const HIGH = 15, GAP = 5;  // pixels of a line of text, and between a robot and its name
const SIDES = [[0, -1], [0, 1], [1, 0], [-1, 0]];  // above, below, right, left

/** The names of robots on the map: beside one another, not on top; in a crowd, the number of the robot. */
export class MapNames {
  constructor() {
    this.widths = new Map();
    this.sides = new Map();  // where each name was last, so that it does not jump without need
  }

  /**
   * @param {Array<object>} robots `name`, `x`, `y`, `size` in pixels; a robot that `matters` has its name in any case.
   * @param {number[]} corner the sides of a box without names.
   */
  draw(pen, robots, room, corner) {
    const taken = [corner, ...robots.map(({ x, y, size }) => [x - size, y - size, x + size, y + size])];
    for (const robot of [...robots].sort((a, b) => Boolean(b.matters) - Boolean(a.matters))) {
      const number = /\d+$/.exec(robot.name)?.[0], texts = number ? [robot.name, number] : [robot.name];
      const found = texts.map((text) => this.find(pen, robot, text, taken, room)).find(Boolean)
        ?? (robot.matters ? this.at(pen, robot, robot.name, SIDES[0]) : undefined);
      if (!found) continue;
      taken.push(found.box);
      drawName(pen, found.text, (found.box[0] + found.box[2]) / 2, found.box[3]);
    }
  }

  /** A free place for a text beside a robot. */
  find(pen, robot, text, taken, { width, height }) {
    const last = this.sides.get(robot.name), sides = last ? [last, ...SIDES] : SIDES;
    for (const side of sides) {
      const found = this.at(pen, robot, text, side), [left, top, right, bottom] = found.box;
      const isFree = left >= 0 && top >= 0 && right <= width && bottom <= height
        && !taken.some(([l, t, r, b]) => left < r && right > l && top < b && bottom > t);
      if (isFree) {
        this.sides.set(robot.name, side);
        return found;
      }
    }
    return undefined;
  }

  at(pen, { x, y, size }, text, [across, down]) {
    const width = this.width(pen, text), cx = x + across * (size + GAP + width / 2), cy = y + down * (size + GAP + HIGH / 2);
    return { text, box: [cx - width / 2, cy - HIGH / 2, cx + width / 2, cy + HIGH / 2] };
  }

  width(pen, text) {
    if (!this.widths.has(text)) {
      pen.font = "600 12px system-ui, sans-serif";
      this.widths.set(text, pen.measureText(text).width + 4);
    }
    return this.widths.get(text);
  }
}
