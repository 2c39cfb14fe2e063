// Measure a run from the stored memory in Node, as fast as possible; print seconds of processor time as JSON:
//
//     node measure.mjs BUILT NAME SECONDS
//
// BUILT is the folder of `make live`, NAME one of its programs, SECONDS those of the run's clock.
import { readFileSync } from "node:fs";
import { gunzipSync } from "node:zlib";
import createPyodideModule from "pyodide/pyodide.asm.mjs";
import { loadPyodide } from "pyodide";
import { startPython, writeFiles } from "./python.js";

const [built, name, seconds] = process.argv.slice(2);
const read = (file) => new Uint8Array(readFileSync(`${built}/${file}`));
const used = () => process.cpuUsage().user / 1e6 + process.cpuUsage().system / 1e6;

const python = await startPython({ loadPyodide, createPyodideModule }, read("msgspec.wasm"), new Uint8Array(gunzipSync(read("memory.gz"))));
writeFiles(python, JSON.parse(gunzipSync(read("files.json.gz"))));
const { title, ...source } = JSON.parse(readFileSync(`${built}/programs.json`))[name];
const figures = { python: used() };
const texts = [];
const program = python.pyimport("jacaros.browser.page").start(JSON.stringify(source), (text) => {
  if (text.startsWith("[")) figures.shown ??= used();
  texts.push(...text.matchAll(/"kind":"text".*?"text":"(.*?)"/g));
}, Infinity);
while (!program.over && program.elapsed < Number(seconds)) program.pump(0.02);
console.log(JSON.stringify({ ...figures, run: used() - figures.shown, elapsed: program.elapsed, texts: texts.map(([, text]) => text) }));
