// Fills every <div data-jacaros-live="NAME"> of a page with the program NAME: an editor, the robot, and what it thinks.
import { Editor } from "./editor.js";
import { packed, unpacked } from "./sharing.js";

const HERE = new URL(".", import.meta.url);
const PATIENCE = 1500;  // milliseconds in which a run must end when asked to

const COLLECTED = new Uint8Array([0, 97, 115, 109, 1, 0, 0, 0, 1, 3, 1, 95, 0]);  // a module that declares an empty struct

/** What this browser lacks, in words; "" for nothing. */
function missing() {
  if (typeof WebAssembly === "undefined") return "WebAssembly";
  if (!WebAssembly.validate(COLLECTED)) return "garbage collection in WebAssembly";
  if (typeof DecompressionStream === "undefined") return "DecompressionStream";
  return typeof Worker === "undefined" ? "Web Workers" : "";
}

function element(name, className, ...children) {
  const made = document.createElement(name);
  made.className = className;
  made.append(...children);
  return made;
}

function button(text, act) {
  const made = element("button", "", text);
  made.type = "button";
  made.addEventListener("click", act);
  return made;
}

/** One worker with Python, for all programs of the page: it starts when the first one runs. */
class Python {
  begin() {
    if (this.worker) return;
    this.worker = new Worker(new URL("worker.js", HERE), { type: "module" });
    this.worker.onmessage = ({ data }) => this.owner?.hear(data);
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.owner?.hear({ failed: event.message || "the worker did not start" });
      this.end();
    };
  }

  run(owner, source, port) {
    if (this.owner !== owner) this.owner?.leave();
    this.owner = owner;
    this.begin();
    this.worker.postMessage({ run: source }, [port]);
  }

  stop() { this.worker?.postMessage({ stop: true }); }

  /** End the worker, whatever it does; the next run starts another one. */
  end() {
    this.worker?.terminate();
    this.worker = null;
  }
}

const python = new Python();

class LiveProgram {
  constructor(root, program) {
    this.root = root;
    this.poster = [...root.childNodes];
    this.editor = new Editor("Program");
    this.files = element("div", "jl-files");
    this.files.setAttribute("role", "group");
    this.files.setAttribute("aria-label", "Files");
    this.runs = button("▶ Run", () => this.run());
    this.stops = button("■ Stop", () => this.stop());
    this.status = element("span", "jl-status");
    this.status.setAttribute("role", "status");
    this.bar = element("div", "jl-bar", this.runs, this.stops, button("Reset", () => this.open(this.original)), button("Copy link", () => this.share()), this.status);
    this.log = element("pre", "jl-log");
    this.log.tabIndex = 0;
    this.log.setAttribute("aria-label", "Messages");
    this.stage = element("div", "jl-stage", ...this.poster);
    root.classList.add("jl");
    const left = element("div", "jl-left", this.files, this.editor.root, this.bar, this.log);
    root.replaceChildren(element("div", "jl-both", left, this.stage));
    this.editor.field.addEventListener("focus", () => python.begin(), { once: true });  // Python loads while the user edits
    this.editor.field.addEventListener("keydown", (event) => {
      if (event.key === "Enter" && (event.ctrlKey || event.metaKey)) this.run();
    });
    this.original = program;
    this.open(program);
    this.show("idle", "");
  }

  open(program) {
    this.texts = { ...program.files };
    this.options = program;
    this.files.replaceChildren(...Object.keys(this.texts).map((name) => button(name, () => this.choose(name))));
    this.files.hidden = Object.keys(this.texts).length < 2;
    this.shown = null;
    this.choose(Object.keys(this.texts).find((name) => name.endsWith(".asl")) ?? program.main);
    this.clear();
  }

  choose(name) {
    this.keep();
    this.shown = name;
    this.editor.text = this.texts[name];
    for (const each of this.files.children) each.setAttribute("aria-pressed", String(each.textContent === name));
  }

  keep() { if (this.shown !== null) this.texts[this.shown] = this.editor.text; }

  source() {
    this.keep();
    const { main, world, mappings = [], seed, until_idle } = this.options;
    return JSON.parse(JSON.stringify({ files: this.texts, main, world, mappings, seed, until_idle }));
  }

  show(state, words) {
    this.state = state;
    this.root.dataset.state = state;
    this.stops.disabled = state === "idle";
    this.status.textContent = words;
  }

  clear() {
    this.log.textContent = "";
    this.log.hidden = true;
  }

  say(text) {
    this.log.hidden = false;
    this.log.append(`${text}\n`);
    this.log.scrollTop = this.log.scrollHeight;
  }

  async run() {
    this.clear();
    clearTimeout(this.ending);
    if (this.state !== "idle") python.end();  // its run before has not ended
    const source = this.source();
    this.began = performance.now();
    this.show("starting", python.worker ? "Starting …" : "Loading Python, about 27 MB, once …");
    python.begin();
    const channel = new MessageChannel();
    const inner = await this.frame();
    python.run(this, source, channel.port1);
    inner.postMessage("run", location.origin === "null" ? "*" : location.origin, [channel.port2]);
  }

  /** A new frame with the page of a run, when it is ready for a run. */
  frame() {
    const frame = element("iframe", "jl-page");
    frame.title = "The robot, and what its agent thinks";
    const scheme = document.body.dataset.mdColorScheme ?? document.documentElement.dataset.theme;
    const dark = scheme ? scheme !== "default" && scheme !== "light" : matchMedia("(prefers-color-scheme: dark)").matches;
    frame.src = new URL(`page/inside.html#theme=${dark ? "dark" : "light"}`, HERE);
    const ready = new Promise((resolve) => {
      const hear = ({ source }) => {
        if (source !== frame.contentWindow) return;
        removeEventListener("message", hear);
        resolve(frame.contentWindow);
      };
      addEventListener("message", hear);
    });
    this.stage.replaceChildren(frame);
    return ready;
  }

  /** A message of the worker. */
  hear({ ready, begun, posted, failed }) {
    if (failed !== undefined) return this.fail(failed);
    if (ready !== undefined) return this.show("starting", "Starting …");
    if (begun) return this.started();
    const { kind, text, error } = JSON.parse(posted);
    if (kind === "log") this.say(text);
    else this.over(error);
  }

  /** The first record of the run has come to the frame. */
  started() {
    this.seconds = (performance.now() - this.began) / 1000;
    this.root.dataset.seconds = this.seconds.toFixed(2);
    this.show("running", `Running. Started in ${this.seconds.toFixed(1)} s.`);
  }

  over(error) {
    clearTimeout(this.ending);
    this.show("idle", error ? "The program has errors." : "The run has ended.");
    if (error) {
      this.say(error);
      this.stage.replaceChildren(...this.poster);
    }
  }

  fail(why) {
    python.end();
    this.show("idle", "This does not run.");
    this.say(`error: ${why}`);
    this.stage.replaceChildren(...this.poster);
  }

  stop() {
    if (this.state === "idle") return;
    clearTimeout(this.ending);
    python.stop();
    this.ending = setTimeout(() => {
      python.end();
      this.show("idle", "Stopped in the middle of a step.");
      this.stage.replaceChildren(...this.poster);
    }, PATIENCE);
  }

  /** Another program of the page runs now. */
  leave() {
    if (this.state === "idle") return;
    python.end();
    this.show("idle", "");
    this.stage.replaceChildren(...this.poster);
  }

  async share() {
    try {
      const { world, mappings, main, title } = this.options;
      const address = new URL("live.html", HERE);
      address.hash = `program=${await packed({ files: this.source().files, main, world, mappings, title })}`;
      await navigator.clipboard.writeText(address.href);
      this.status.textContent = "The link is in the clipboard.";
    } catch (error) {
      this.status.textContent = error.message;
    }
  }
}

async function programs() {
  const response = await fetch(new URL("programs.json", HERE));
  if (!response.ok) throw new Error(`programs.json: ${response.status}`);
  return response.json();
}

/** Fill an element; `null` as its name is the program of the page's address. */
async function fill(root, known) {
  const lack = missing();
  if (lack) {
    root.append(element("p", "jl-old", `This browser is too old to run programs here: it lacks ${lack}. Everything runs on your machine with: pip install jacaros`));
    return;
  }
  const name = root.dataset.jacarosLive, coded = new URLSearchParams(location.hash.slice(1)).get("program");
  let program = known[name], error = null;
  if (coded !== null && root.hasAttribute("data-jacaros-shared")) {
    try { program = await unpacked(coded); } catch (failure) { error = failure; }
  }
  if (!program) throw new Error(`unknown program: ${name}`);
  const live = new LiveProgram(root, program);
  root.liveProgram = live;
  if (error) live.say(error.message);
}

/** Load the style sheet, unless the page has it. */
function dress() {
  const { href } = new URL("live.css", HERE);
  if ([...document.styleSheets].some((each) => each.href === href)) return;
  const link = element("link", "");
  Object.assign(link, { rel: "stylesheet", href });
  document.head.append(link);
}

dress();
const known = await programs();
for (const root of document.querySelectorAll("[data-jacaros-live]")) await fill(root, known);
