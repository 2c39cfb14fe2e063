import { isDark } from "./elements.js";

const LIGHT = ["#1f6f8b", "#b4572e", "#6b5aa8", "#3f7d3a", "#a83e6b", "#7a6a1e"];
const DARK = ["#6cc0d8", "#ec9a70", "#aa9be6", "#8bcb85", "#e88db4", "#d3c266"];
const RAMP = [[74, 98, 190], [38, 146, 158], [120, 172, 84], [226, 160, 48], [205, 84, 60]];

/** The colour of robot number `index`. */
export function robotColor(index) { return (isDark() ? DARK : LIGHT)[index % LIGHT.length]; }

/** The colour of a path at `part` (0 to 1) of the run. */
export function rampColor(part) {
  const place = Math.min(0.9999, Math.max(0, part)) * (RAMP.length - 1), i = Math.floor(place), rest = place - i;
  return `rgb(${RAMP[i].map((c, k) => Math.round(c + (RAMP[i + 1][k] - c) * rest)).join(" ")})`;
}
