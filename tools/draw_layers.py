"""Draw the layers of the package, as `.importlinter` declares them: docs/images/architecture.svg.

draw_layers.py [FILE]      another file; a test compares the two
"""

import sys
from collections.abc import Iterator
from configparser import ConfigParser
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
WIDTH, HEIGHT, GAP, EDGE = 720, 38, 8, 12
COLOURS = {
    "agents": "#cfe3f7",
    "artifacts": "#d5efd6",
    "robots": "#fbe3c3",
    "runtime": "#e3e3e8",
    "serving": "#f6d9d6",
    "look": "#efdcf3",
    "fleet": "#efdcf3",
    "testing": "#efdcf3",
}
"""One colour for each package of the root."""


def layers() -> list[list[str]]:
    """Return the boxes of each layer, from above; packages that import each other (``:``) share one."""
    contracts = ConfigParser()
    contracts.read(ROOT / ".importlinter")
    told = contracts["importlinter:contract:layers"]["layers"].split("\n")
    rows = [
        [name.strip().removeprefix("jacaros.") for name in line.split("|")] for line in told if line.strip()
    ]
    return [kept for row in rows if (kept := [name for name in row if name.partition(".")[0] in COLOURS])]


def drawing() -> Iterator[str]:
    """Yield the lines of the drawing: a row for each layer, a box for each package."""
    rows = layers()
    height = len(rows) * (HEIGHT + GAP) - GAP + 2 * EDGE
    yield (
        f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {WIDTH} {height}" width="{WIDTH}" height="{height}" '
        'font-family="sans-serif" font-size="14" text-anchor="middle">'
    )
    yield "<title>The packages of JaCaROS; imports only point down</title>"
    yield f'<rect width="{WIDTH}" height="{height}" fill="#ffffff"/>'
    for number, row in enumerate(rows):
        top = EDGE + number * (HEIGHT + GAP)
        width = (WIDTH - 2 * EDGE - (len(row) - 1) * GAP) / len(row)
        for place, name in enumerate(row):
            left = EDGE + place * (width + GAP)
            yield (
                f'<rect x="{left:.1f}" y="{top}" width="{width:.1f}" height="{HEIGHT}" rx="5" '
                f'fill="{COLOURS[name.partition(".")[0]]}" stroke="#55606b"/>'
            )
            text = name.replace(" : ", ", ").replace("jacaros.", "").replace(".", "/")
            yield f'<text x="{left + width / 2:.1f}" y="{top + HEIGHT / 2 + 5:.0f}" fill="#1c2329">{text}</text>'
    yield "</svg>"


if __name__ == "__main__":
    target = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT / "docs" / "images" / "architecture.svg"
    target.write_text("\n".join(drawing()) + "\n", encoding="utf-8")
