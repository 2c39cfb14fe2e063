import { themeColor } from "./elements.js";

/** What of a world stands still: floor, rooms with their names, furniture, walls, docks, and a scale. */
export class FloorDrawing {
  constructor() { this.canvas = document.createElement("canvas"); }

  draw(drawing, projection, ratio, box, world) {
    Object.assign(this, { drawing, projection, world });
    const pen = this.pen = this.canvas.getContext("2d");
    pen.setTransform(1, 0, 0, 1, 0, 0);
    pen.clearRect(0, 0, this.canvas.width, this.canvas.height);
    pen.setTransform(ratio, 0, 0, ratio, 0, 0);
    pen.lineJoin = pen.lineCap = "round";
    if (drawing.bounds) {
      this.drawGround();
      this.drawRooms();
      this.drawGrid();
    }
    this.drawFurniture();
    this.drawDocks();
    this.drawWalls();
    this.drawRoomNames();
    this.drawScale(box);
  }

  drawGround() {
    this.pen.fillStyle = themeColor("floor");
    this.pen.beginPath(); this.projection.rectangle(this.pen, this.drawing.bounds); this.pen.fill();
  }

  drawRooms() {
    const tints = themeColor("tints").split(" ");
    this.drawing.rooms.forEach((room, number) => {
      this.pen.fillStyle = tints[number % tints.length];
      this.pen.beginPath(); this.projection.rectangle(this.pen, room.area); this.pen.fill();
    });
  }

  /** A line for each metre; in a large world for each 5 or 25, or so. */
  drawGrid() {
    const { pen, projection: p } = this, [left, bottom, right, top] = this.drawing.bounds;
    const step = 5 ** Math.max(0, Math.ceil(Math.log(CELL / p.scale) / Math.log(5)));
    pen.strokeStyle = themeColor("grid"); pen.lineWidth = 1; pen.beginPath();
    for (let x = Math.ceil(left / step) * step; x <= right; x += step) { pen.moveTo(p.x(x), p.y(bottom)); pen.lineTo(p.x(x), p.y(top)); }
    for (let y = Math.ceil(bottom / step) * step; y <= top; y += step) { pen.moveTo(p.x(left), p.y(y)); pen.lineTo(p.x(right), p.y(y)); }
    pen.stroke();
    pen.strokeStyle = themeColor("line"); pen.beginPath(); p.rectangle(pen, this.drawing.bounds); pen.stroke();
  }

  drawFurniture() {
    const { pen, projection } = this;
    pen.fillStyle = themeColor("box"); pen.beginPath();
    for (const box of this.drawing.boxes) projection.rectangle(pen, box);
    pen.fill();
    pen.globalAlpha = 0.6;
    for (const { color, area } of this.drawing.furniture) {
      if (color) { pen.fillStyle = color; pen.beginPath(); projection.rectangle(pen, area); pen.fill(); }
    }
    pen.globalAlpha = 1;
  }

  drawWalls() {
    const { pen, projection: p } = this;
    pen.strokeStyle = themeColor("wall"); pen.lineWidth = 1; pen.setLineDash([3, 3]); pen.beginPath();
    for (const cliff of this.drawing.cliffs) p.rectangle(pen, cliff);
    pen.stroke(); pen.setLineDash([]);
    pen.lineWidth = Math.min(5, Math.max(1.5, p.scale * 0.035)); pen.beginPath();
    for (const [ax, ay, bx, by] of this.drawing.walls) { pen.moveTo(p.x(ax), p.y(ay)); pen.lineTo(p.x(bx), p.y(by)); }
    pen.stroke();
  }

  drawDocks() {
    const { pen, projection: p } = this;
    for (const dock of this.drawing.docks) {
      const x = p.x(dock.pose[0]), y = p.y(dock.pose[1]), size = Math.max(6, dock.radius * p.scale);
      pen.fillStyle = themeColor("dock");
      pen.globalAlpha = 0.35; pen.beginPath(); pen.arc(x, y, size, 0, 7); pen.fill();
      pen.globalAlpha = 1; pen.beginPath(); pen.arc(x, y, size * 0.62, 0, 7); pen.fill();
      pen.fillStyle = themeColor("dock-ink"); pen.beginPath();
      BOLT.forEach(([dx, dy], k) => pen[k ? "lineTo" : "moveTo"](x + dx * size, y + dy * size));
      pen.closePath(); pen.fill();
    }
  }

  drawRoomNames() {
    const { pen } = this;
    pen.font = "500 13px system-ui, sans-serif"; pen.textAlign = "left"; pen.textBaseline = "top";
    pen.fillStyle = themeColor("room");
    for (const room of this.drawing.rooms) {
      const text = room.name.replaceAll("_", " "), width = pen.measureText(text).width;
      if (width > (room.area[2] - room.area[0]) * this.projection.scale) continue;
      const place = this.placeFor(room.area, width, 14);
      pen.fillText(text, place.left, place.top);
    }
  }

  /** Where in a room a name covers the least of furniture, docks and paths; at an edge, the upper first. */
  placeFor([ax, ay, bx, by], width, height) {
    const { projection: p } = this;
    const left = p.x(ax) + 12, right = p.x(bx) - 12 - width, top = p.y(by) + 12, bottom = p.y(ay) - 12 - height;
    let best = null;
    for (const y of [top, bottom, (top + bottom) / 2]) {
      for (const x of [left, (left + right) / 2, right]) {
        const cost = this.covered({ left: x - 4, top: y - 3, right: x + width + 4, bottom: y + height + 3 });
        if (best === null || cost < best.cost) best = { left: x, top: y, cost };
      }
    }
    return best;
  }

  covered(label) {
    const { projection: p } = this, { boxes, docks, walls } = this.drawing;
    const meets = (ax, ay, bx, by) => p.x(ax) < label.right && p.x(bx) > label.left && p.y(by) < label.bottom && p.y(ay) > label.top;
    let cost = 50 * boxes.filter((box) => meets(...box)).length;
    cost += 50 * docks.filter(({ pose: [x, y], radius }) => meets(x - radius, y - radius, x + radius, y + radius)).length;
    cost += 20 * walls.filter(([ax, ay, bx, by]) => meets(Math.min(ax, bx), Math.min(ay, by), Math.max(ax, bx), Math.max(ay, by))).length;
    for (const { x, y } of this.world.columns) {
      for (let i = 0; i < Math.min(x.length, 6000); i += 5) if (meets(x[i], y[i], x[i], y[i])) cost += 0.1;
    }
    return cost;
  }

  drawScale({ width, height }) {
    const { pen, projection: p } = this, metres = roundLength(Math.min(BAR, width * 0.15) / p.scale);
    const end = width - 16, start = end - metres * p.scale, base = height - 17;
    pen.strokeStyle = pen.fillStyle = themeColor("muted"); pen.lineWidth = 1.5;
    pen.beginPath(); pen.moveTo(start, base - 4); pen.lineTo(start, base); pen.lineTo(end, base); pen.lineTo(end, base - 4); pen.stroke();
    pen.font = "12px system-ui, sans-serif"; pen.textAlign = "right"; pen.textBaseline = "alphabetic";
    pen.fillText(`${metres} m`, start - 8, base + 2);
  }
}

/** The largest length of 1, 2 or 5 metres, or a power of ten times that, that is at most `metres`. */
function roundLength(metres) {
  const power = 10 ** Math.floor(Math.log10(metres));
  return power * ([5, 2, 1].find((each) => each * power <= metres) ?? 1);
}

const CELL = 12, BAR = 120;  // pixels: the least width of a cell of the grid, and the largest of the scale
const BOLT = [[0.1, -0.42], [-0.24, 0.08], [-0.02, 0.08], [-0.1, 0.42], [0.24, -0.08], [0.02, -0.08]];
