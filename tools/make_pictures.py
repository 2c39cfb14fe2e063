"""Draw the pictures of the documentation: runs of the examples, by the project's own recorder and pen."""

import tempfile
from pathlib import Path

from jacaros.cli.main import call
from jacaros.inspector import Recording, write_picture

ROOT = Path(__file__).resolve().parent.parent
IMAGES = ROOT / "docs" / "images"

PICTURES = {
    "patrol.svg": ("examples/04_patrol/patrol.jcm", 75.0, 460),
    "house_cleaning.svg": ("examples/05_house_cleaning/house_cleaning.jcm", None, 560),
}
"""From the picture's name to project, seconds, and width in pixels."""


def main() -> None:
    """Draw them all."""
    IMAGES.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as scratch:
        for name, (project, seconds, width) in PICTURES.items():
            record = str(Path(scratch) / "run.jsonl")
            limit = [] if seconds is None else ["--for", str(seconds)]
            arguments = [
                "run",
                str(ROOT / project),
                "--clock",
                "fast",
                "--seed",
                "1",
                "--record",
                record,
                *limit,
            ]
            if call(arguments) != 0:
                raise SystemExit(f"{project} did not end well")
            write_picture(Recording.read(record), IMAGES / name, width)


if __name__ == "__main__":
    main()
