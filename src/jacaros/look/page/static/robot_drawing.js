import { themeColor } from "./elements.js";
import { robotColor } from "./palette.js";

const FULL = 2 * Math.PI;

/** Pixels from the middle of a robot to its outline. */
export function sizeOf(robot, projection) { return Math.max(7, robot.radius * projection.scale); }

/** A robot: body with its heading, the ring of its battery while it charges, a halo when it is selected. */
export function drawRobot(pen, projection, robot, state, { index, selected }) {
  const size = sizeOf(robot, projection), colour = robotColor(index);
  pen.save();
  pen.translate(projection.x(state.x), projection.y(state.y));
  if (selected) drawHalo(pen, size + 7, colour);
  if (state.charging) drawCharge(pen, size + 6, state.battery);
  if (state.touching) drawTouch(pen, size + 4);
  pen.rotate(-state.yaw);
  pen.fillStyle = themeColor("surface"); pen.strokeStyle = colour; pen.lineWidth = 2.5;
  outline(pen, robot, size);
  pen.fill(); pen.stroke();
  drawHeading(pen, size, colour);
  pen.restore();
}

/** Where localisation believes the robot to be, as a dashed outline; nothing where it is right. */
export function drawBelieved(pen, projection, robot, believed, state, index) {
  if (!believed || Math.hypot(believed.x - state.x, believed.y - state.y) * projection.scale < 2) return;
  const size = sizeOf(robot, projection);
  pen.save();
  pen.translate(projection.x(believed.x), projection.y(believed.y));
  pen.rotate(-believed.yaw);
  pen.strokeStyle = robotColor(index); pen.lineWidth = 1.5; pen.setLineDash([4, 3]);
  outline(pen, robot, size);
  pen.stroke();
  pen.beginPath(); pen.moveTo(0, 0); pen.lineTo(size, 0); pen.stroke();
  pen.restore();
}

/** The echoes of a laser scan, as the area that it has seen and a dot for each echo. */
export function drawLaser(pen, projection, scan, index) {
  if (!scan) return;
  const { state } = scan, x = projection.x(state.x), y = projection.y(state.y), colour = robotColor(index), echoes = [];
  scan.ranges.forEach((range, beam) => {
    if (!range) return;
    const angle = state.yaw + scan.from + scan.step * beam, length = range / 100 * projection.scale;
    echoes.push([x + Math.cos(angle) * length, y - Math.sin(angle) * length]);
  });
  pen.fillStyle = colour;
  pen.globalAlpha = 0.07; pen.beginPath(); pen.moveTo(x, y);
  for (const [ex, ey] of echoes) pen.lineTo(ex, ey);
  pen.closePath(); pen.fill();
  pen.globalAlpha = 0.75;
  for (const [ex, ey] of echoes) pen.fillRect(ex - 1, ey - 1, 2, 2);
  pen.globalAlpha = 1;
}

/** The planned path: a dashed line to a ring at its goal. */
export function drawPlan(pen, projection, points, index) {
  if (!points.length) return;
  const [gx, gy] = points[points.length - 1];
  pen.strokeStyle = robotColor(index); pen.lineWidth = 2; pen.setLineDash([7, 5]);
  pen.beginPath(); projection.line(pen, points); pen.stroke();
  pen.setLineDash([]);
  pen.beginPath(); pen.arc(projection.x(gx), projection.y(gy), 5, 0, FULL); pen.stroke();
}

function outline(pen, robot, size) {
  pen.beginPath();
  pen.arc(0, 0, size, 0, FULL);
}

function drawHeading(pen, size, colour) {
  pen.fillStyle = colour;
  pen.beginPath(); pen.moveTo(size * 0.72, 0); pen.lineTo(-size * 0.38, size * 0.5);
  pen.lineTo(-size * 0.12, 0); pen.lineTo(-size * 0.38, -size * 0.5); pen.closePath(); pen.fill();
}

function drawHalo(pen, size, colour) {
  pen.fillStyle = colour; pen.globalAlpha = 0.22;
  pen.beginPath(); pen.arc(0, 0, size, 0, FULL); pen.fill();
  pen.globalAlpha = 1;
}

function drawCharge(pen, size, battery) {
  pen.strokeStyle = themeColor("good"); pen.lineWidth = 3;
  pen.beginPath(); pen.arc(0, 0, size, -Math.PI / 2, -Math.PI / 2 + FULL * battery / 100); pen.stroke();
}

/** Rays around a robot that touches something: a shape, for who cannot tell red. */
function drawTouch(pen, size) {
  pen.strokeStyle = themeColor("bad"); pen.lineWidth = 2.5; pen.beginPath();
  for (let ray = 0; ray < 8; ray++) {
    const angle = ray * FULL / 8;
    pen.moveTo(Math.cos(angle) * size, Math.sin(angle) * size);
    pen.lineTo(Math.cos(angle) * (size + 6), Math.sin(angle) * (size + 6));
  }
  pen.stroke();
}

/** A name over something, readable on anything. */
export function drawName(pen, name, x, y, size = "600 12px") {
  pen.font = `${size} system-ui, sans-serif`; pen.textAlign = "center"; pen.textBaseline = "bottom";
  pen.strokeStyle = themeColor("floor"); pen.lineWidth = 3; pen.strokeText(name, x, y);
  pen.fillStyle = themeColor("ink"); pen.fillText(name, x, y);
}
