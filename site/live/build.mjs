// Start Python in Node, run a program once, and write what a browser needs to start from there:
//
//     node build.mjs OUT WHEEL...
//
// OUT gets memory.gz, the memory of Python after the run, files.json.gz, the files of its packages that are not modules in
// this memory, and msgspec.wasm.
import { copyFileSync, readFileSync, writeFileSync } from "node:fs";
import { gzipSync } from "node:zlib";
import createPyodideModule from "pyodide/pyodide.asm.mjs";
import { loadPyodide } from "pyodide";
import { startPython } from "./python.js";

const [out, extension, ...wheels] = process.argv.slice(2);
const PACKAGES = "/lib/python3.14/site-packages";

const python = await startPython({ loadPyodide, createPyodideModule }, new Uint8Array(readFileSync(extension)));
for (const wheel of wheels) python.unpackArchive(new Uint8Array(readFileSync(wheel)), "wheel", { extractDir: PACKAGES });
python.runPython(readFileSync(new URL("warm_up.py", import.meta.url), "utf8"));

const inMemory = new Set(JSON.parse(python.runPython("import json, sys; json.dumps([getattr(each, '__file__', None) for each in sys.modules.values()])")));
const files = { texts: {}, bytes: {} };
function collect(folder) {
  for (const name of python.FS.readdir(folder)) {
    const path = `${folder}/${name}`;
    if (name === "." || name === ".." || name === "__pycache__" || name.endsWith(".pyi")) continue;
    if (python.FS.isDir(python.FS.stat(path).mode)) collect(path);
    else if (inMemory.has(path)) continue;
    else if (/\.(so|pgm|png|gz)$/.test(name)) files.bytes[path] = Buffer.from(python.FS.readFile(path)).toString("base64");
    else files.texts[path] = python.FS.readFile(path, { encoding: "utf8" });
  }
}
for (const name of JSON.parse(python.runPython("json.dumps(PACKAGES)"))) collect(`${PACKAGES}/${name}`);
writeFileSync(`${out}/files.json.gz`, gzipSync(JSON.stringify(files), { level: 9 }));

python.runPython("import gc; gc.collect()");
writeFileSync(`${out}/memory.gz`, gzipSync(python.makeMemorySnapshot(), { level: 9 }));
copyFileSync(extension, `${out}/msgspec.wasm`);
