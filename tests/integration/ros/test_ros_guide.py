"""The guide from a robot to an agent, followed literally on a real graph; the robot is a world in another process."""

import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from masters import Master

sys.path.insert(0, str(Path(__file__).parents[2] / "docs"))

from following import Reader
from pages import ROOT

GUIDE = ROOT / "docs" / "how-to" / "from_your_robot_to_an_agent.md"


@pytest.fixture
def fresh_graph(kind: str, environment: dict[str, str], tmp_path: Path) -> Iterator[dict[str, str]]:
    """A graph without what other tests left: a ROS 1 master keeps the entries of nodes that were killed."""
    if kind != "ros1":
        yield environment
        return
    master = Master(tmp_path)
    master.start()
    yield environment | master.environment
    master.close()


def test_the_guide_can_be_followed(kind: str, fresh_graph: dict[str, str], tmp_path: Path) -> None:
    with Reader(tmp_path, kind, fresh_graph) as reader:
        reader.follow(GUIDE)
