const STILL = 4;  // pixels that a pointer may move in a click
const WHEEL = 0.0015;  // how much a turn of the wheel zooms

/**
 * The pointer on lanes and curves: a drag pans, the wheel zooms at the pointer, a double click shows the whole run.
 *
 * The owner has `click(x, y)`, which may return true when it has used the click, and `hover(x, y)`, with null when the pointer
 * has left; both get pixels of `element`. A click that the owner did not use goes to its moment. Over the labels, and with
 * `scrolls`, what does not fit scrolls.
 */
export class TimePointer {
  constructor(element, axis, owner) {
    Object.assign(this, { element, axis, owner, start: null });
    const on = (name, act, options) => element.addEventListener(name, act, options);
    on("pointerdown", (event) => this.press(event));
    on("pointermove", (event) => this.move(event));
    on("pointerup", (event) => this.release(event));
    on("pointercancel", () => { this.start = null; });
    on("pointerleave", () => owner.hover(null, null));
    on("wheel", (event) => this.wheel(event), { passive: false });
    on("dblclick", (event) => { if (this.place(event)[0] >= axis.left) axis.all(); });
  }

  place({ clientX, clientY }) {
    const box = this.element.getBoundingClientRect();
    return [clientX - box.left, clientY - box.top];
  }

  press(event) {
    if (event.button !== 0) return;
    const [x, y] = this.place(event);
    this.start = { x, y, last: x, lastY: y, moved: false };
    this.element.setPointerCapture(event.pointerId);
  }

  move(event) {
    const [x, y] = this.place(event), { start, axis, element } = this;
    if (!start) { this.owner.hover(x, y); return; }
    start.moved ||= Math.hypot(x - start.x, y - start.y) > STILL;
    if (!start.moved) return;
    if (x !== start.last) axis.pan((start.last - x) * axis.grain);
    element.scrollTop += start.lastY - y;
    Object.assign(start, { last: x, lastY: y });
  }

  release(event) {
    const { start } = this, [x, y] = this.place(event);
    this.start = null;
    if (!start || start.moved || this.owner.click(x, y)) return;
    if (x >= this.axis.left) this.axis.time.go(this.axis.t(x));
  }

  wheel(event) {
    const [x] = this.place(event), { axis } = this;
    if (x < axis.left || event.shiftKey) return;
    event.preventDefault();
    if (Math.abs(event.deltaX) > Math.abs(event.deltaY)) axis.pan(event.deltaX * axis.grain);
    else axis.zoom(Math.exp(-event.deltaY * WHEEL), axis.t(x));
  }
}
