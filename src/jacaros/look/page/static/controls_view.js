import { BreakpointsForm } from "./breakpoints_form.js";
import { element, setText } from "./elements.js";
import { placeButton } from "./jumps.js";
import { refill } from "./refill.js";

const STEPS = { step: "plan step", cycle: "reasoning cycle", event: "next event" };
const SPEEDS = [0.1, 0.25, 0.5, 1, 2, 5, 10];

/** Pause, step, speed, breakpoints and reload, of a running system that allows them; and whether it is paused, and why. */
export class ControlsView {
  constructor(root, context, { debugging, minds }) {
    Object.assign(this, { root, context, debugging });
    const { actions, commands } = context;
    this.pause = actions.button("", "", () => commands.send(this.isPaused ? "continue" : "pause"), "plain pause-run");
    this.what = element("select", "", ...Object.entries(STEPS).map(([what, title]) => new Option(title, what)));
    this.what.setAttribute("aria-label", "What a step is");
    this.step = actions.button("Step", "Continue for one step", () => commands.send("step", this.stepArgs()), "plain");
    this.stepping = element("span", "group", this.step, this.what);
    this.speed = element("select", "", ...SPEEDS.map((each) => new Option(`${each}×`, String(each))));
    this.speed.addEventListener("change", () => actions.run(this.speed, () => commands.send("speed", { factor: Number(this.speed.value) })));
    this.speeding = element("label", "group", "Run at ", this.speed);
    this.breakpoints = new BreakpointsForm(context, minds);
    this.reload = actions.button("Reload", "Reload changed programs", () => this.read(), "plain");
    root.append(this.pause, this.stepping, this.speeding, this.breakpoints.root, this.reload);
    this.state = element("div", "debug-state");
    this.state.setAttribute("role", "status");
    this.state.hidden = true;
    root.closest("header")?.after(this.state);
  }

  get showsAlways() { return true; }

  get isPaused() { return this.debugging.now.state === "paused"; }

  stepArgs() {
    const { agent } = this.context.selection.current;
    return { what: this.what.value, ...(agent === undefined ? {} : { agent }) };
  }

  get empty() { return !["pause", "step", "speed", "breakpoint", "reload"].some((each) => this.context.commands.can.has(each)); }

  show(t) {
    const { can } = this.context.commands, { now } = this.debugging;
    this.pause.hidden = !can.has("pause");
    setText(this.pause, this.isPaused ? "▶ Continue" : "❚❚ Pause");
    this.pause.setAttribute("aria-label", this.isPaused ? "Continue the run" : "Pause the run");
    this.pause.title = this.isPaused ? "Continue the run" : "Pause agents, timers and the world";
    this.pause.classList.toggle("paused", this.isPaused);
    this.stepping.hidden = !can.has("step");
    this.speeding.hidden = !can.has("speed");
    this.reload.hidden = !can.has("reload");
    if (now.speed > 0) this.showSpeed(now.speed);
    this.breakpoints.show();
    this.showState(this.context.time.live ? now : this.debugging.at(t));
  }

  showSpeed(speed) {
    if (document.activeElement === this.speed || Number(this.speed.value) === speed) return;
    if (![...this.speed.options].some(({ value }) => Number(value) === speed)) this.speed.append(new Option(`${speed}×`, String(speed)));
    this.speed.value = String(speed);
  }

  showState(state) {
    const stamp = `${state.state} ${state.why} ${state.event} ${state.cannot?.join()}`;
    if (stamp === this.stamp) return;
    this.stamp = stamp;
    this.state.hidden = state.state !== "paused";
    if (this.state.hidden) return;
    const why = state.why && state.why !== "pause" ? ` (${state.why.replace(/\S*\/(?=\S+:\d)/, "")})` : "";
    const words = [element("b", "", "❚❚ Paused"), why];
    if (state.event) words.push(" before the event ", element("code", "", state.event), ` of ${state.agent}`);
    else if (state.agent) words.push(state.file ? ` before a step of ${state.agent} ` : ` after a turn of ${state.agent}`);
    if (state.file) words.push(placeButton(this.context, state, "held"));
    const parts = [element("p", "", ...words)];
    if (state.cannot?.length) parts.push(element("p", "", "Not paused:"), element("ul", "", ...state.cannot.map((each) => element("li", "", each))));
    refill(this.state, parts);
    if (this.context.time.live && state.file) this.context.selection.choose({ agent: state.agent, intention: state.intention || undefined, file: state.file, line: state.line });
  }

  async read() {
    const lines = await this.context.commands.send("reload");
    this.context.actions.report(this.reload, [lines].flat().filter(Boolean).join("\n") || "No program has changed.");
  }
}
