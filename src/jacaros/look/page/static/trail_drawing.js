import { rampColor, robotColor } from "./palette.js";
import { indexAt } from "./track.js";

const PIECE = 16;  // frames of a path that are drawn as one line of one colour

/** The paths of the robots up to a moment: whole pieces are kept on a canvas, going back draws them anew. */
export class TrailDrawing {
  constructor(world) {
    this.world = world;
    this.canvas = document.createElement("canvas");
    this.drawn = 0;
  }

  restart(projection, ratio) {
    this.projection = projection;
    this.ratio = ratio;
    this.clear();
  }

  clear() {
    this.drawn = 0;
    this.pen = this.canvas.getContext("2d");
    this.pen.setTransform(this.ratio, 0, 0, this.ratio, 0, 0);
    this.pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    this.pen.lineJoin = this.pen.lineCap = "round";
  }

  /** The canvas, with all whole pieces before time `t`. */
  extendTo(t) {
    const pieces = Math.floor(Math.max(0, indexAt(this.world.times, t)) / PIECE);
    if (pieces < this.drawn) this.clear();
    for (; this.drawn < pieces; this.drawn++) this.drawPiece(this.pen, this.drawn * PIECE, (this.drawn + 1) * PIECE);
    return this.canvas;
  }

  /** Draw the last, unfinished piece, up to where the robots are. */
  drawRest(pen, t, states) {
    if (this.world.times.length) this.drawPiece(pen, this.drawn * PIECE, Math.max(0, indexAt(this.world.times, t)), states);
  }

  drawPiece(pen, first, last, states) {
    const { world, projection: p } = this;
    pen.lineWidth = Math.min(4, Math.max(1.5, p.scale * 0.028));
    world.columns.forEach((robot, index) => {
      const from = Math.max(first, robot.first);
      if (from > last) return;
      pen.strokeStyle = world.robotCount === 1 ? rampColor(world.times[from] / (world.times[world.times.length - 1] || 1)) : robotColor(index);
      pen.beginPath(); pen.moveTo(p.x(robot.x[from]), p.y(robot.y[from]));
      for (let i = from + 1; i <= last; i++) pen.lineTo(p.x(robot.x[i]), p.y(robot.y[i]));
      if (states?.[index]) pen.lineTo(p.x(states[index].x), p.y(states[index].y));
      pen.stroke();
    });
  }
}
