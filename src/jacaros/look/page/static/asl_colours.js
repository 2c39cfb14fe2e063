import { element } from "./elements.js";

const TOKEN = /(\/\/.*|#.*)|("(?:[^"\\]|\\.)*")|(@\w+)|(<-|:-|[-+]?!!?|\?|[-+](?=[a-z!?@]))|\b([A-Z_]\w*)|\b(\d+(?:\.\d+)?)|(\.[a-z]\w*(?:\.\w+)*)|\b(true|false|not|if|else|elif|while|for|import)\b/g;
const CLASSES = ["comment", "quoted", "label", "arrow", "variable", "number", "internal", "word"];

/** A line of AgentSpeak as coloured spans; `inComment` says whether it begins inside a comment of several lines. */
export function coloured(line, inComment) {
  if (inComment) return [element("span", "comment", line)];
  const parts = [];
  let end = 0;
  const [code, comment] = splitComment(line);
  for (const found of code.matchAll(TOKEN)) {
    if (found.index > end) parts.push(code.slice(end, found.index));
    parts.push(element("span", CLASSES[found.slice(1).findIndex((group) => group !== undefined)], found[0]));
    end = found.index + found[0].length;
  }
  parts.push(code.slice(end));
  if (comment) parts.push(element("span", "comment", comment));
  return parts;
}

/** Whether each line of a program begins inside a comment of several lines. */
export function commented(lines) {
  let inside = false;
  return lines.map((line) => {
    const began = inside, open = line.lastIndexOf("/*"), close = line.lastIndexOf("*/");
    if (open > close) inside = true;
    else if (close >= 0) inside = false;
    return began;
  });
}

function splitComment(line) {
  const at = line.indexOf("/*");
  return at < 0 ? [line, ""] : [line.slice(0, at), line.slice(at)];
}
