"""The guide from a robot to an agent, followed literally on a real graph; the robot is a world in another process."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))

from following import Reader
from pages import ROOT

GUIDE = ROOT / "docs" / "how-to" / "from_your_robot_to_an_agent.md"


def test_the_guide_can_be_followed(kind: str, environment: dict[str, str], tmp_path: Path) -> None:
    with Reader(tmp_path, kind, environment) as reader:
        reader.follow(GUIDE)
