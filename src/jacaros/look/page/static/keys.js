const OWN_KEYS = "input:not([type=range]), select, textarea, [contenteditable], .listing";

/** The keys that move through time, wherever the focus is but in a field or a program; `?` shows all keys. */
export function listenToKeys(time) {
  document.getElementById("help").addEventListener("click", showKeys);
  document.addEventListener("keydown", (event) => {
    if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey || event.target.matches(OWN_KEYS)) return;
    const step = event.shiftKey ? 10 : 1;
    const act = {
      " ": () => time.toggle(), ArrowLeft: () => time.go(time.now - step), ArrowRight: () => time.go(time.now + step),
      Home: () => time.go(0), End: () => time.go(time.run.end), "?": showKeys,
    }[event.key];
    // The space key presses the button that has the focus.
    if (!act || (event.key === " " && event.target.matches("button, summary"))) return;
    event.preventDefault();
    act();
  });
}

function showKeys() { document.getElementById("keys").showModal(); }
