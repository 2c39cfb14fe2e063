const EVERY = 100;  // milliseconds: text that changes more often cannot be read
const LONGEST_PRESS = 700;  // milliseconds

let pressed = -Infinity;  // when the pointer was pressed in a panel; it is no longer after `pointerup`

document.addEventListener("pointerdown", ({ target }) => { if (target.closest?.(".panel")) pressed = performance.now(); }, true);
for (const end of ["pointerup", "pointercancel"]) {
  document.addEventListener(end, () => setTimeout(() => { pressed = -Infinity; }), true);  // after the click
}

/**
 * Make a function that calls `draw` at most ten times a second, and in the end with the newest arguments.
 *
 * It waits while the pointer is pressed: a button that is drawn anew between press and release gets no click.
 */
export function paced(draw) {
  let last = -Infinity, timer, newest;
  const attempt = () => {
    const now = performance.now(), wait = now - pressed < LONGEST_PRESS ? EVERY : last + EVERY - now;
    timer = wait > 0 ? setTimeout(attempt, wait) : undefined;
    if (timer !== undefined) return;
    last = now;
    draw(...newest);
  };
  return (...given) => {
    newest = given;
    if (timer === undefined) attempt();
  };
}
