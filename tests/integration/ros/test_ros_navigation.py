"""The world's actions on a real graph: a client in another process sends goals, the world's file judges."""

import json
import math
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from processes import Program, WorldProcess

GOALS = Path(__file__).parent / "programs" / "goals.py"


@pytest.fixture
def client(kind: str, environment: dict[str, str], world: WorldProcess) -> Iterator[Program]:
    """The client's process; the world is there before."""
    started = Program([sys.executable, str(GOALS), kind], environment)
    yield started
    started.stop()


def test_goals_from_another_process(kind: str, world: WorldProcess, client: Program) -> None:
    assert client.end() == 0, client.errors
    lines: list[dict[str, Any]] = [json.loads(line) for line in client.lines]
    reached, outside, unknown, cancelled = lines[:4]
    assert (reached["status"], reached["code"]) == ("succeeded", 0)
    assert reached["feedback"] > 2
    assert outside["status"] == unknown["status"] == "aborted"
    assert "outside of the map" in outside["text"]
    assert "unknown frame 'moon'" in unknown["text"]
    assert cancelled["status"] == "canceled"
    if kind == "ros2":
        assert (outside["code"], unknown["code"]) == (204, 9002)
    assert [line["status"] for line in lines[4:-1]] == ["succeeded"] * len(lines[4:-1])
    truth = world.close()
    docked = truth.events_of("docked")
    assert docked
    assert truth.events_of("bump") == []
    assert any(math.hypot(s.x - 0.8, s.y - 0.8) < 0.1 for s in truth.path()), "the first goal"
    end = truth.pose()
    assert lines[-1]["tf"][:2] == pytest.approx([end.x, end.y], abs=0.3)
    if kind == "ros2":
        assert math.hypot(end.x - 0.5, end.y - 0.5) > 0.25, "it has left the dock"
