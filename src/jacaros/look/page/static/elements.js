/** Make an element; `children` are elements or texts. The text of a `code` may wrap after its separators. */
export function element(tag, className = "", ...children) {
  const made = document.createElement(tag);
  if (className) made.className = className;
  made.append(...(tag === "code" ? children.flatMap(breakable) : children));
  return made;
}

const SHORT = 16;  // characters of a text that stays on one line

/** A text with a place to wrap after each `/`, `_`, `,` or `(`, so that no word is cut; other things as they are. */
export function breakable(text) {
  if (typeof text !== "string" || text.length < SHORT) return [text];
  return text.split(/(?<=[/_,(](?=\w|"))/).flatMap((part, n) => (n ? [document.createElement("wbr"), part] : [part]));
}

/** Make a button that calls `act` when it is pressed. */
export function button(className, act, ...children) {
  const made = element("button", className, ...children);
  made.type = "button";
  made.addEventListener("click", act);
  return made;
}

/** Give `node` the text, only when it has another: writing the same text again costs a layout. */
export function setText(node, text) {
  if (node.textContent !== text) node.textContent = text;
}

/** Seconds as minutes and seconds, 1:05.3, after an hour with hours: 1:01:05.3. */
export function clock(t) {
  const tenths = Math.round(t * 10), minutes = Math.floor(tenths / 600), seconds = ((tenths - minutes * 600) / 10).toFixed(1).padStart(4, "0");
  return minutes < 60 ? `${minutes}:${seconds}` : `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, "0")}:${seconds}`;
}

/** A number with `digits` decimals, without a minus before 0. */
export function decimals(value, digits) { return (Number(value.toFixed(digits)) + 0).toFixed(digits); }

/** A text with its long numbers rounded to five digits: lists are for reading, and hovering shows the full text. */
export function rounded(text) { return text.replace(/-?\d+\.\d{5,}(?:e[+-]?\d+)?/gi, (number) => String(Number(Number(number).toPrecision(5)))); }

const colours = new Map();  // by theme and name: asking the document for a style may cost a layout

/** A colour of the theme, such as `themeColor("wall")`. */
export function themeColor(name) {
  const key = `${document.documentElement.dataset.theme} ${name}`;
  if (!colours.has(key)) {
    colours.set(key, getComputedStyle(document.documentElement).getPropertyValue(`--${name}`).trim());
  }
  return colours.get(key);
}

/** Whether the page is dark. */
export function isDark() { return document.documentElement.dataset.theme === "dark"; }
