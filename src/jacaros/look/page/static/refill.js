/**
 * Replace the children of `root`, and keep the focus and what was unfolded.
 *
 * Elements are recognised by `data-key`: unique below `root`, and the same for the same thing in the next picture.
 */
export function refill(root, nodes) {
  const focused = root.contains(document.activeElement) ? document.activeElement.dataset.key : undefined;
  const states = new Map([...root.querySelectorAll("details[data-key]")].map((each) => [each.dataset.key, each.open]));
  root.replaceChildren(...nodes);
  for (const each of root.querySelectorAll("details[data-key]")) each.open = states.get(each.dataset.key) ?? each.open;
  if (focused !== undefined) byKey(root, focused)?.focus({ preventScroll: true });
}

function byKey(root, key) { return [...root.querySelectorAll("[data-key]")].find((each) => each.dataset.key === key); }

/** Give an element the key by which `refill` recognises it. */
export function keyed(key, node) {
  node.dataset.key = String(key);
  return node;
}

/** Let two arrow keys, Home and End move the focus among the elements below `root` that `selector` finds. */
export function moveByArrows(root, selector, next = "ArrowDown", before = "ArrowUp") {
  root.addEventListener("keydown", (event) => {
    const all = [...root.querySelectorAll(selector)].filter((each) => each.checkVisibility()), at = all.indexOf(document.activeElement);
    const to = { [next]: at + 1, [before]: at - 1, Home: 0, End: all.length - 1 }[event.key];
    if (at < 0 || to === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    event.stopPropagation();
    all[Math.min(all.length - 1, Math.max(0, to))].focus();
  });
}
