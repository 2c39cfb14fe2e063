const MARGIN = 26, FOOT = 44;  // pixels around the map, and below it, where the layers and the scale are
const LARGEST = 20;  // times that the map is enlarged

/** Which part of the world the map shows: enlarged `zoom` times, and moved by pixels. */
export class Camera {
  constructor() { this.reset(); }

  reset() { Object.assign(this, { zoom: 1, dx: 0, dy: 0 }); }

  move(dx, dy) { this.dx += dx; this.dy += dy; }

  /** Enlarge the map, so that the point of the canvas at `x`, `y` (pixels from its middle) stays where it is. */
  enlarge(factor, x = 0, y = 0) {
    const zoom = Math.min(LARGEST, Math.max(1, this.zoom * factor)), change = zoom / this.zoom;
    if (zoom === 1) { this.reset(); return; }
    Object.assign(this, { zoom, dx: x + (this.dx - x) * change, dy: y + (this.dy - y) * change });
  }
}

/** Metres of the world to pixels of the map. */
export class Projection {
  constructor([left, bottom, right, top], width, height, { zoom, dx, dy } = new Camera()) {
    const fitting = Math.min((width - 2 * MARGIN) / (right - left), (height - MARGIN - FOOT) / (top - bottom));
    this.width = width;
    this.height = height;
    this.scale = (fitting > 0 ? fitting : 1) * zoom;
    this.originX = width / 2 + dx - (left + right) / 2 * this.scale;
    this.originY = (height - FOOT + MARGIN) / 2 + dy + (bottom + top) / 2 * this.scale;
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
