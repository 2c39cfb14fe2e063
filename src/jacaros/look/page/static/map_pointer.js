const STILL = 4;  // pixels that a pointer may move in a click
const WHEEL = 0.0015;  // how much a turn of the wheel enlarges

/**
 * The pointer on the map: a click chooses, a drag moves the map, or a robot that may be moved; the wheel enlarges.
 *
 * The owner has `find(x, y)`, `hover(found)`, `canDrag(found)`, `click(x, y)`, `dragTo(found, x, y)`, `drop(found, x, y)`, `camera`
 * and `redraw()`.
 */
export class MapPointer {
  constructor(canvas, owner) {
    Object.assign(this, { canvas, owner, start: null });
    canvas.addEventListener("pointerdown", (event) => this.press(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.release(event));
    canvas.addEventListener("pointercancel", () => this.cancel());
    canvas.addEventListener("pointerleave", () => owner.hover(null));
    canvas.addEventListener("wheel", (event) => this.wheel(event), { passive: false });
  }

  press(event) {
    if (event.button !== 0) return;
    const { offsetX: x, offsetY: y } = event, found = this.owner.find(x, y);
    this.start = { x, y, lastX: x, lastY: y, moved: false, dragged: found && this.owner.canDrag(found) ? found : null };
    this.canvas.setPointerCapture(event.pointerId);
  }

  move({ offsetX: x, offsetY: y }) {
    const { start, owner } = this;
    if (!start) { owner.hover(owner.find(x, y)); return; }
    start.moved ||= Math.hypot(x - start.x, y - start.y) > STILL;
    if (!start.moved) return;
    if (start.dragged) owner.dragTo(start.dragged, x, y);
    else if (owner.camera.zoom > 1) owner.camera.move(x - start.lastX, y - start.lastY);
    Object.assign(start, { lastX: x, lastY: y });
    owner.redraw();
  }

  release({ offsetX: x, offsetY: y }) {
    const { start, owner } = this;
    this.start = null;
    if (!start) return;
    if (!start.moved) owner.click(x, y);
    else if (start.dragged) owner.drop(start.dragged, x, y);
  }

  cancel() {
    const dragged = this.start?.dragged;
    this.start = null;
    if (dragged) this.owner.dragTo(null);
  }

  wheel(event) {
    event.preventDefault();
    const box = this.canvas.getBoundingClientRect();
    this.owner.camera.enlarge(Math.exp(-event.deltaY * WHEEL), event.offsetX - box.width / 2, event.offsetY - box.height / 2);
    this.owner.redraw();
  }
}
