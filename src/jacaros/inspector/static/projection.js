const MARGIN = 26, FOOT = 44;  // pixels around the map, and below it, where the layers and the scale are

/** Metres of the world to pixels of the map. */
export class Projection {
  constructor([left, bottom, right, top], width, height) {
    this.width = width;
    this.height = height;
    this.scale = Math.max(2, Math.min((width - 2 * MARGIN) / (right - left), (height - MARGIN - FOOT) / (top - bottom)));
    this.originX = width / 2 - (left + right) / 2 * this.scale;
    this.originY = (height - FOOT + MARGIN) / 2 + (bottom + top) / 2 * this.scale;
  }

  x(x) { return this.originX + x * this.scale; }
  y(y) { return this.originY - y * this.scale; }

  /** The point of the world at a pixel. */
  point(x, y) { return [(x - this.originX) / this.scale, (this.originY - y) / this.scale]; }

  /** Add a rectangle to the path of a pen. */
  rectangle(pen, [ax, ay, bx, by]) { pen.rect(this.x(ax), this.y(by), (bx - ax) * this.scale, (by - ay) * this.scale); }

  /** Add a line through points to the path of a pen. */
  line(pen, points) { points.forEach(([x, y], k) => pen[k ? "lineTo" : "moveTo"](this.x(x), this.y(y))); }
}
