const EVERY = 100;  // milliseconds: text that changes more often cannot be read

/** Make a function that calls `draw` at most ten times a second, and in the end with the newest arguments. */
export function paced(draw) {
  let last = -Infinity, timer, newest;
  const now = () => {
    timer = undefined;
    last = performance.now();
    draw(...newest);
  };
  return (...given) => {
    newest = given;
    if (timer !== undefined) return;
    const wait = last + EVERY - performance.now();
    if (wait <= 0) now(); else timer = setTimeout(now, wait);
  };
}
