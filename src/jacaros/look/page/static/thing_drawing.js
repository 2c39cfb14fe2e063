import { themeColor } from "./elements.js";
import { drawName } from "./robot_drawing.js";

const SWUNG = Math.PI * 0.44;  // radians that an open door is turned out of its wall

const LARGEST = 5000;  // pixels
const NAMED = 12;  // objects that have their names on the map

/** Doors: a leaf across the gap when closed, swung out of it when open, so that the gap is free. */
export function drawDoors(pen, projection, world, t) {
  pen.strokeStyle = themeColor("warn"); pen.lineCap = "butt";
  for (const door of world.drawing(t).doors) {
    const [ax, ay, bx, by] = door.segment, isOpen = world.doorOpen(door, t), turn = isOpen ? SWUNG : 0;
    const cx = ax + (bx - ax) * Math.cos(turn) - (by - ay) * Math.sin(turn);
    const cy = ay + (bx - ax) * Math.sin(turn) + (by - ay) * Math.cos(turn);
    pen.lineWidth = Math.min(6, Math.max(3, projection.scale * 0.05)) * (isOpen ? 0.6 : 1);
    pen.beginPath(); projection.line(pen, [[ax, ay], [cx, cy]]); pen.stroke();
  }
  pen.lineCap = "round";
}

/** People, each with its name and the way that it walks. */
export function drawPeople(pen, projection, world, t) {
  for (const person of world.peopleAt(t)) {
    const x = projection.x(person.x), y = projection.y(person.y), size = Math.max(5, person.radius * projection.scale);
    pen.strokeStyle = pen.fillStyle = person.color || themeColor("person"); pen.lineWidth = 1.5; pen.setLineDash([1, 6]);
    pen.beginPath(); projection.line(pen, person.path);
    if (person.loop) pen.closePath();
    pen.stroke(); pen.setLineDash([]);
    pen.globalAlpha = 0.8; pen.beginPath(); pen.arc(x, y, size, 0, 7); pen.fill(); pen.globalAlpha = 1;
    drawName(pen, person.name, x, y - size - 4);
  }
}

/** Obstacles that were put on the floor: hatched, so that they are not taken for furniture. */
export function drawObstacles(pen, projection, world, t) {
  for (const obstacle of world.obstaclesAt(t)) {
    const x = projection.x(obstacle.x), y = projection.y(obstacle.y), size = Math.min(LARGEST, Math.max(4, obstacle.radius * projection.scale));
    pen.save();
    pen.beginPath(); pen.arc(x, y, size, 0, 7);
    pen.fillStyle = themeColor("box"); pen.fill();
    pen.strokeStyle = themeColor("wall"); pen.lineWidth = 2; pen.stroke();
    pen.clip();
    pen.lineWidth = 1; pen.beginPath();
    for (let d = -2 * size; d <= 2 * size; d += 6) { pen.moveTo(x + d - size, y + size); pen.lineTo(x + d + size, y - size); }
    pen.stroke();
    pen.restore();
  }
}

/** The objects that lie on the floor; a robot has the others. */
export function drawObjects(pen, projection, world, t) {
  const objects = world.objectsAt(t), isNamed = objects.length <= NAMED;
  for (const { name, radius, color, place } of objects) {
    const x = projection.x(place[0]), y = projection.y(place[1]), size = Math.max(4, radius * projection.scale);
    pen.fillStyle = color || themeColor("object"); pen.strokeStyle = themeColor("ink"); pen.lineWidth = 1;
    pen.beginPath(); pen.arc(x, y, size, 0, 7); pen.fill(); pen.stroke();
    if (isNamed) drawName(pen, name, x, y - size - 3, "11px");
  }
}

/** The dirt that is left, the darker the more. */
export function drawDirt(pen, projection, world, t) {
  pen.fillStyle = themeColor("dirt");
  for (const room of world.drawing(t).rooms) {
    for (const dirt of room.dirt ?? []) {
      pen.globalAlpha = dirt.grams ? 0.24 * world.dirtLeft(room, dirt, t) / dirt.grams : 0;
      pen.beginPath(); projection.rectangle(pen, dirt.area); pen.fill();
    }
  }
  pen.globalAlpha = 1;
}
