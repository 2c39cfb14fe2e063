// The worker that has Python and the run. Messages to it: {run: source} with a port for the page, {stop: true}.
// Messages from it: {ready: seconds}, {begun: true} with the first record of a run, {posted: text} for its log and its end,
// {failed: text}.
import createPyodideModule from "./pyodide/pyodide.asm.mjs";
import { loadPyodide } from "./pyodide/pyodide.mjs";
import { startPython, writeFiles } from "./python.js";

const TURN = 0.02;  // seconds of the run between two looks at messages
const LONGEST_REST = 1;  // seconds
const DOORS = ["fetch", "XMLHttpRequest", "WebSocket", "WebSocketStream", "WebTransport", "EventSource", "indexedDB", "caches", "BroadcastChannel", "Worker", "importScripts"];

async function unpacked(name) {
  const response = await fetch(new URL(name, import.meta.url));
  if (!response.ok) throw new Error(`${name}: ${response.status} ${response.statusText}`);
  return new Response(response.body.pipeThrough(new DecompressionStream("gzip")));
}

async function start() {
  const began = performance.now();
  const [memory, files, extension] = await Promise.all([
    unpacked("memory.gz").then((each) => each.arrayBuffer()),
    unpacked("files.json.gz").then((each) => each.json()),
    fetch(new URL("msgspec.wasm", import.meta.url)).then((each) => each.arrayBuffer()),
  ]);
  const indexURL = new URL("pyodide/", import.meta.url).href;
  const python = await startPython({ loadPyodide, createPyodideModule, indexURL }, new Uint8Array(extension), new Uint8Array(memory));
  writeFiles(python, files);
  // A program comes from anybody's link. It cannot reach JavaScript; if it could, it would find nothing to send with.
  for (const name of DOORS) Object.defineProperty(globalThis, name, { value: undefined });
  postMessage({ ready: (performance.now() - began) / 1000 });
  return python.pyimport("jacaros.browser.page");
}

/** A run, in turns of the worker's loop, so that messages come through. */
class Turns {
  constructor(page, source, port) {
    this.port = port;
    this.program = page.start(JSON.stringify(source), (text) => this.post(text));
    port.onmessage = ({ data }) => {
      this.program.receive(data);
      this.turn();
    };
    this.soon = new MessageChannel();  // unlike a timer, it does not wait 4 ms
    this.soon.port1.onmessage = () => this.turn();
    this.turn();
  }

  post(text) {
    if (/^\{"kind":"(log|over)"/.test(text)) postMessage({ posted: text });
    else this.port.postMessage(text);
    if (!this.begun && text.startsWith("[")) postMessage({ begun: this.begun = true });
  }

  turn() {
    clearTimeout(this.timer);
    const rest = this.program.pump(TURN);
    if (this.program.over) this.end();
    else if (rest === 0) this.soon.port2.postMessage(null);
    else this.timer = setTimeout(() => this.turn(), 1000 * Math.min(LONGEST_REST, rest ?? LONGEST_REST));
  }

  stop() {
    this.program.stop();
    this.turn();
  }

  end() {
    this.soon.port1.onmessage = this.port.onmessage = null;
    this.port.postMessage(null);
  }
}

const started = start().catch((error) => { throw new Error(`Python does not start in this browser: ${error.message}`); });
let turns = null;

onmessage = async ({ data, ports: [port] }) => {
  try {
    const page = await started;
    if (data.run) turns = new Turns(page, data.run, port);
    else if (data.stop) turns?.stop();
  } catch (error) {
    postMessage({ failed: error.message });
  }
};
addEventListener("error", ({ message }) => postMessage({ failed: message }));
