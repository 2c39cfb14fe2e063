import { button, element } from "./elements.js";

const SHOWN = 6000;  // milliseconds for which an error stays at its control

/** Controls that send commands: what goes wrong appears next to the control. */
export class Actions {
  constructor() { this.bubble = null; }

  /** Make a small button; `act` returns the promise of a reply. */
  button(text, label, act, className = "act") {
    const made = button(className, () => this.run(made, act), text);
    made.setAttribute("aria-label", label);
    made.title = label;
    return made;
  }

  /** Execute `act`; an error is shown at `control`.  The promise has the result, undefined after an error. */
  async run(control, act) {
    this.clear();
    control.setAttribute("aria-busy", "true");
    try {
      return await act() ?? null;
    } catch (error) {
      this.report(control, error.message);
      return undefined;
    } finally { control.removeAttribute("aria-busy"); }
  }

  report(control, text) {
    this.clear();
    const box = control.getBoundingClientRect(), bubble = element("p", "bubble", text);
    bubble.setAttribute("role", "alert");
    document.body.append(bubble);
    bubble.style.left = `${Math.max(8, Math.min(box.left, innerWidth - bubble.offsetWidth - 8))}px`;
    const below = box.bottom + 6, fits = below + bubble.offsetHeight < innerHeight;
    bubble.style.top = `${fits ? below : Math.max(8, box.top - bubble.offsetHeight - 6)}px`;
    this.bubble = bubble;
    setTimeout(() => bubble.remove(), SHOWN);
  }

  clear() { this.bubble?.remove(); }
}
