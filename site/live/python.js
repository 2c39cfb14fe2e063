/**
 * Python in WebAssembly, from a snapshot of its memory with everything imported.
 *
 * The snapshot has pointers into the code of the one C extension, msgspec. So that code is loaded before Python starts, in the
 * builder of the snapshot and here: at this moment its addresses are the same.
 */

const EXTENSION = "/lib/python3.14/site-packages/msgspec/_core.cpython-314-wasm32-emscripten.so";
const FREE_AT_START = 12e6;  // bytes below which Emscripten's heap has room when it starts

/**
 * @param {object} pyodide its modules: `loadPyodide` and `createPyodideModule`, and the address `indexURL` of its files.
 * @param {Uint8Array} extension the code of msgspec.
 * @param {Uint8Array} [snapshot] memory to start from.
 */
export function startPython({ loadPyodide, createPyodideModule, indexURL }, extension, snapshot) {
  const create = (settings) => {
    settings.preRun = [settings.preRun ?? [], (module) => loadExtension(module, extension)].flat();
    settings.postRun = [settings.postRun ?? [], (module) => makeRoom(module, snapshot?.length ?? 0)].flat();
    return createPyodideModule(settings);
  };
  const memory = snapshot ? { _loadSnapshot: snapshot } : { _makeSnapshot: true };
  return loadPyodide({ indexURL, createPyodideModule: create, ...memory });
}

function loadExtension(module, code) {
  const exports = module.loadWebAssemblyModule(code, { global: false, nodelete: true }, EXTENSION, {});
  module.newDSO(EXTENSION, 0, exports).global = false;
}

/** Let the heap grow to the size of the snapshot, which Pyodide does not do. */
function makeRoom(module, size) {
  if (size > module.HEAP8.length) module._malloc(size - FREE_AT_START);
}

/** Write files, texts by path or bytes in base64 by path, into the file system of Python. */
export function writeFiles({ FS }, { texts, bytes }) {
  const write = (path, content) => {
    FS.mkdirTree(path.slice(0, path.lastIndexOf("/")));
    FS.writeFile(path, content);
  };
  for (const [path, text] of Object.entries(texts)) write(path, text);
  for (const [path, coded] of Object.entries(bytes)) write(path, Uint8Array.from(atob(coded), (each) => each.charCodeAt(0)));
}
