"""Bundle the modules of the page into one script, for a file without a server.

Browsers refuse to load modules of a page that was opened as a file.  So each module becomes a function that returns what it
exports, in an order in which each comes after those that it imports.  The modules keep to two forms::

    import { one, two } from "./other.js";
    export class One {        (also function, async function, const)
"""

import re
from pathlib import Path

from jacaros.errors import JacarosError

_IMPORT = re.compile(r'^import\s*\{([\w\s,]*)\}\s*from\s*"\./(\w+)\.js";$', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:class|function|const) (\w+))", re.MULTILINE)
_OTHER_FORM = re.compile(r"^(?:import|export)\b.*", re.MULTILINE)


def bundle(folder: Path, entry: str) -> str:
    """Return one script with the module *entry* (without its suffix) and all modules that it imports.

    Raises:
        JacarosError: a module has an unsupported import or export, or the imports are circular.
        OSError: a module cannot be read.
    """
    parts: dict[str, str] = {}
    _add(folder, entry, parts, ())
    return "\n".join(parts.values())


def _add(folder: Path, name: str, parts: dict[str, str], importers: tuple[str, ...]) -> None:
    if name in importers:
        raise JacarosError(f"modules import each other: {' -> '.join((*importers, name))}")
    if name in parts:
        return
    source = (folder / f"{name}.js").read_text(encoding="utf-8")
    for found in _IMPORT.finditer(source):
        _add(folder, found[2], parts, (*importers, name))
    # Only the entry, which no module imports, may await at its top level.
    parts[name] = _as_function(name, source, "" if importers else "async ")


def _as_function(name: str, source: str, prefix: str) -> str:
    exports = _EXPORT.findall(source)
    body = _IMPORT.sub(r"const {\1} = module_\2;", source)
    body = _EXPORT.sub("", body)
    other = _OTHER_FORM.search(body)
    if other is not None:
        raise JacarosError(f"{name}.js: import or export of another form: {other[0]}")
    return f"const module_{name} = ({prefix}() => {{\n{body}\nreturn {{ {', '.join(exports)} }};\n}})();"
