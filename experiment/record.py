"""The record of the experiment: all runs, one JSON line each, compressed, and the same bytes for the same runs."""

import gzip
import json
from collections.abc import Iterable
from pathlib import Path
from typing import NamedTuple

from outcomes import Damage

DOCS = Path(__file__).parents[1] / "docs"
VIRTUAL = DOCS / "experiment.jsonl.gz"
"""The runs on the virtual clock."""
BEFORE, ROS2 = DOCS / "experiment_before.jsonl.gz", DOCS / "experiment_ros2.jsonl.gz"
"""The runs of an earlier version of the agents, and those on real ROS 2."""


class Outcome(NamedTuple):
    """How a run ended.

    Attributes:
        scenario: name of the scenario.
        side: name of the side.
        seed: of the world and of the disturbance.
        draw: number of the draw that took effect, from 0.
        kind: of the disturbance.
        dose: of the disturbance, in the unit of its kind.
        share: of the whole way at which it strikes; 0 from the beginning.
        end: ``done``, ``told`` or ``silent``.
        hung: whether a silent program still ran at the limit.
        seconds: of the virtual clock until the program ended.
        effect: seconds at which the disturbance first had an effect; None if it had none on this side.
        told: seconds from the effect until the program said that it failed; None unless it ended so.
        metres: driven.
        damage: after the effect.
        complaint: the first complaint of the checker, or "".
    """

    scenario: str
    side: str
    seed: int
    draw: int
    kind: str
    dose: float
    share: float
    end: str
    hung: bool
    seconds: float
    effect: float | None
    told: float | None
    metres: float
    damage: Damage
    complaint: str


def as_line(outcome: Outcome) -> str:
    """Return a run as a line of JSON."""
    return json.dumps({**outcome._asdict(), "damage": outcome.damage._asdict()})


def from_line(line: str) -> Outcome:
    """Return the run of a line."""
    values = json.loads(line)
    return Outcome(**{**values, "damage": Damage(**values["damage"])})


def write(outcomes: Iterable[Outcome], path: Path) -> None:
    """Write a record: sorted, and without the time in the file that gzip adds."""
    text = "".join(f"{as_line(each)}\n" for each in sorted(outcomes, key=lambda each: each[:3]))
    path.write_bytes(gzip.compress(text.encode(), mtime=0))


def read(path: Path) -> list[Outcome]:
    """Return the runs of a record; none if the file does not exist."""
    if not path.exists():
        return []
    return [from_line(line) for line in gzip.decompress(path.read_bytes()).decode().splitlines()]
