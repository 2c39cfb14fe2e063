"""Makes one self-contained page of a recording: a file to double-click, to mail, to keep with a CI run.

The page loads nothing from anywhere.  The recording is inside it, gzipped and base64-coded; the browser
unpacks it with its own ``DecompressionStream``.
"""

import base64
import gzip
import html
import json
import re
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from jacaros.inspector.recording import Recording

TEMPLATE = Path(__file__).parent / "static" / "replay.html"


def write_replay(recording: Recording, path: str | Path, title: str | None = None) -> None:
    """Write the page; *title* is the world's name when not given.

    Raises:
        OSError: the file cannot be written.
    """
    Path(path).write_text(replay_html(recording, title), encoding="utf-8")


def replay_html(recording: Recording, title: str | None = None) -> str:
    """The text of the page."""
    shown = title or str(recording.world.get("name") or "A run")
    packed = gzip.compress(json.dumps(payload(recording), separators=(",", ":")).encode(), 9, mtime=0)
    page = TEMPLATE.read_text(encoding="utf-8")
    parts = {"TITLE": html.escape(shown), "RECORDING": base64.b64encode(packed).decode("ascii")}
    # In one pass: a world may have a name such as {{RECORDING}}.
    return re.sub(r"{{(TITLE|RECORDING)}}", lambda found: parts[found[1]], page)


def payload(recording: Recording) -> dict[str, Any]:
    """What the page is given: whole numbers (ms, mm, mrad, tenths of a percent) as differences."""
    radii = {robot["name"]: robot.get("radius", 0.17) for robot in recording.world.get("robots", [])}
    footprints = {robot["name"]: robot.get("footprint") for robot in recording.world.get("robots", [])}
    columns = [list(zip(*rows, strict=True)) for rows in recording.rows()]
    return {
        "world": recording.drawing,
        "duration": round(recording.duration, 3),
        "t": _differences((frame.t for frame in recording.frames), 1000),
        "robots": [
            {
                "name": name,
                "radius": radii[name],
                "footprint": footprints[name],
                "x": _differences(x, 1000),
                "y": _differences(y, 1000),
                "yaw": _differences(yaw, 1000),
                "battery": _differences(battery, 10),
                "flags": [int(c) + 2 * int(b) for c, b in zip(charging, touching, strict=True)],
            }
            for name, (x, y, yaw, battery, charging, touching) in zip(recording.robots, columns, strict=False)
        ],
        "texts": [[round(t, 3), agent, text] for t, agent, text in recording.texts],
        "events": [[round(t, 3), kind, data] for t, kind, data in recording.events if kind != "cause"],
    }


def _differences(values: Iterable[float], scale: int) -> list[int]:
    whole = [round(value * scale) for value in values]
    return [after - before for before, after in zip([0, *whole], whole, strict=False)]
