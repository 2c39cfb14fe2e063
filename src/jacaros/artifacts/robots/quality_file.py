"""What was measured of a robot, kept in a file for the next run."""

import json
import math
import os
from dataclasses import asdict
from pathlib import Path

from jacaros.artifacts.robots.drive_model import DriveQuality


def read_quality(path: Path) -> DriveQuality | None:
    """Read a file of `write_quality`; None if it does not exist.

    Raises:
        ValueError: it is not such a file.
        OSError: it cannot be read.
    """
    if not path.exists():
        return None
    try:
        quality = DriveQuality(
            **{name: float(value) for name, value in json.loads(path.read_text("utf-8")).items()}
        )
    except (ValueError, TypeError, AttributeError) as error:
        raise ValueError(
            f"expected what an earlier run has measured, found something else: {error}"
        ) from None
    if not all(math.isfinite(value) and value >= 0.0 for value in asdict(quality).values()):
        raise ValueError("expected finite numbers from 0 on")
    return quality


def write_quality(path: Path, quality: DriveQuality) -> None:
    """Replace the file.

    Raises:
        OSError: it cannot be written.
    """
    part = path.with_name(f"{path.name}.part")
    part.write_text(json.dumps(asdict(quality), indent=2) + "\n", "utf-8")
    os.replace(part, path)
