"""Create one self-contained page of a recording: a file to open, to mail, or to archive with a CI run.

The page loads nothing.  It holds the modules of ``static/`` as one script, and the records, gzipped and base64-coded, which
the browser unpacks with its own ``DecompressionStream``.  Its content security policy names the hashes of these style
sheets and this one script, so nothing else runs, whatever a recording says.
"""

import base64
import gzip
import hashlib
import html
import re
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise
from operator import attrgetter
from pathlib import Path
from typing import Any

from jacaros.look.page.thinning import span_of, thinned
from jacaros.look.records.line_format import encoded
from jacaros.look.records.recording import Recording
from jacaros.look.records.records import VERSION, EventLine, RecordingLine, TextLine, WorldLine
from jacaros.look.why.story import story_of
from jacaros.look.why.tales import StoryLine
from jacaros.runtime.errors import JacarosError

STATIC = Path(__file__).parent / "static"
"""The page and its modules; a server serves this folder unchanged."""
_PLACES = re.compile(
    r'<title>[^<]*</title>|<link rel="stylesheet" href="(\w+)\.css">|<script type="module" src="live\.js"></script>'
)

_SCALES = {"x": 1000, "y": 1000, "yaw": 1000, "battery": 10, "charging": 1, "touching": 1}
"""Integers per unit of each field of `jacaros.robots.world.data.ground_truth.RobotState`."""


def write_replay(recording: Recording, path: str | Path) -> None:
    """Write the page, whole or not at all.

    Raises:
        OSError: the file cannot be written.
    """
    path = Path(path)
    if path.exists() and not path.is_file():  # a device or pipe
        path.write_text(replay_html(recording), encoding="utf-8", newline="\n")
        return
    part = path.with_name(f"{path.name}.part")
    try:
        part.write_text(replay_html(recording), encoding="utf-8", newline="\n")
        part.replace(path)
    except OSError:
        part.unlink(missing_ok=True)
        raise


def replay_html(recording: Recording) -> str:
    """Return the text of the page."""
    shown = html.escape(title_of(recording))
    page, script = (STATIC / "page.html").read_text(encoding="utf-8"), bundle(STATIC, "recorded")
    styles = {
        name: (STATIC / f"{name}.css").read_text(encoding="utf-8") for name in _PLACES.findall(page) if name
    }
    hashes = " ".join(map(_hash, styles.values()))
    policy = f"default-src 'none'; img-src data:; script-src {_hash(script)}; style-src {hashes}"
    parts = {
        "<title": f'<meta http-equiv="Content-Security-Policy" content="{policy}">\n<title>{shown}</title>',
        "<script": f'<script type="text/plain" id="recording">{packed(recording)}</script>\n'
        f'<script type="module">{script}</script>',
    }

    def part(found: re.Match[str]) -> str:
        if found[1]:
            return f"<style>{styles[found[1]]}</style>"
        return parts[found[0].partition(" ")[0].partition(">")[0]]

    # In one pass, because a title may look like a placeholder.
    return _PLACES.sub(part, page)


def title_of(recording: Recording) -> str:
    """Return the name of the project, or otherwise of the world."""
    names = (data.get("name") for _, kind, data in recording.events if kind == "run")
    return str(next(names, None) or recording.world.get("name") or "A run")


def packed(recording: Recording) -> str:
    """Return the records of a recording in the format of the page: a line of frames, then a line for each other record,
    and the story.
    """
    lines = b"\n".join(map(encoded, (frames(recording), *lines_of(recording), story_record(recording))))
    return base64.b64encode(gzip.compress(lines, 9, mtime=0)).decode("ascii")


class StoryRecord(RecordingLine, tag="story"):
    """The story of a run, which pages show first, and the seconds of which they have only extremes, see `thinned`.

    Recordings do not have it.
    """

    lines: Sequence[StoryLine]
    span: float = 0.0


def story_record(recording: Recording) -> StoryRecord:
    """Return the story of a recording as a record for a page."""
    return StoryRecord(story_of(recording.events), span_of(recording.events))


def lines_of(recording: Recording) -> Iterator[RecordingLine]:
    """Yield the records of a recording except frames, in time order, as in its file; of a long one, what a page needs."""
    yield WorldLine(version=VERSION, world=recording.world)
    texts = (TextLine(*text) for text in recording.texts)
    events = (EventLine(*event) for event in thinned(recording.events))
    yield from sorted((*texts, *events), key=attrgetter("t"))


def frames(recording: Recording) -> dict[str, Any]:
    """Return the frames as columns of differences of integers (ms, mm, mrad, tenths of a percent).

    Compressed, they are a tenth of the size of a record per frame. A robot discovered late has shorter columns.
    """
    rows = [frame.robots for frame in recording.frames]
    robots = []
    for index in range(max(map(len, rows), default=0)):
        states = [row[index] for row in rows if len(row) > index]
        robots.append(
            {
                name: _differences((getattr(state, name) for state in states), scale)
                for name, scale in _SCALES.items()
            }
        )
    return {
        "kind": "frames",
        "t": _differences((frame.t for frame in recording.frames), 1000),
        "scales": _SCALES,
        "robots": robots,
    }


def _differences(values: Iterable[float], scale: int) -> list[int]:
    whole = [round(value * scale) for value in values]
    return [after - before for before, after in pairwise([0, *whole])]


def _hash(text: str) -> str:
    return f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"


# ---- modules

_IMPORT = re.compile(r'^import\s*\{([\w\s,]*)\}\s*from\s*"\./(\w+)\.js";$', re.MULTILINE)
_EXPORT = re.compile(r"^export (?=(?:async )?(?:class|function|const) (\w+))", re.MULTILINE)
_OTHER_FORM = re.compile(r"^(?:import|export)\b.*", re.MULTILINE)


def bundle(folder: Path, entry: str) -> str:
    """Return one script with the module *entry* (without its suffix) and all modules that it imports.

    Browsers refuse to load modules of a page that was opened as a file.  So each module becomes a function that returns
    what it exports, in an order in which each comes after those that it imports.  The modules keep to two forms::

        import { one, two } from "./other.js";
        export class One {        (also function, async function, const)

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
