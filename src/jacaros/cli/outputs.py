"""What a watched run is written to, apart from what the agents print."""

from dataclasses import dataclass
from pathlib import Path

OUTPUT_GONE = 141
"""Exit code when the reader of the output is gone, as in ``| head``: 128 and the number of SIGPIPE."""


@dataclass(frozen=True, slots=True)
class Outputs:
    """What the command line asks for.

    Attributes:
        record: file for the recording, or None.
        replay: file for the page, or None.
        ground_truth: file for what truly happens in the world, or None.
        view: show the world in the terminal.
    """

    record: Path | None = None
    replay: Path | None = None
    ground_truth: Path | None = None
    view: bool = False
