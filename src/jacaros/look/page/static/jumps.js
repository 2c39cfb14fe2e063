import { button, clock, element } from "./elements.js";
import { placeName } from "./link_words.js";
import { keyed } from "./refill.js";

/** A button that shows a line of a program; nothing for an unknown place. */
export function placeButton(context, place, key) {
  if (!place?.file || !place.line) return "";
  const made = button("jump place", () => {
    context.selection.choose({ ...context.selection.current, file: place.file, line: place.line });
    context.open("program");
  }, placeName(place));
  made.title = `Show line ${place.line} of ${place.file}`;
  return keyed(`${key} place`, made);
}

/** Show why something happened: `what` is a selection with the id of a link as `cause`. */
export function showWhy(context, what) {
  context.selection.choose(what);
  context.open("causes");
}

/** A button that shows why something happened. */
export function whyButton(context, what, key, text = "Why?") {
  return keyed(`${key} why`, button("jump ask", () => showWhy(context, what), text));
}

/** A moment that can be clicked to go there. */
export function momentButton(context, t, key) {
  const made = button("jump moment", () => context.time.go(t), clock(t));
  made.title = "Go to this moment";
  return keyed(`${key} moment`, made);
}
