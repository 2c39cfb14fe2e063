"""Scenes with a debugger and an agent bob, which runs the program of the mark ``program``, or counts."""

import sys
from pathlib import Path

import pytest
from debugged_runs import COUNTER, debugged

sys.path.insert(0, str(Path(__file__).parents[3]))
from fake_real_time import in_fake_time


def pytest_configure(config: pytest.Config) -> None:
    config.addinivalue_line("markers", "program(text): the program of bob in a scene")
    config.addinivalue_line(
        "markers", "real_time: a scene in real time, which is faked, and makes its system itself"
    )


@pytest.fixture
def debugger() -> None:
    """The place of the debugger of the system."""


@pytest.fixture(autouse=True)
def play(lines: list[str], request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch):
    if request.node.get_closest_marker("real_time"):
        return lambda scene: in_fake_time(monkeypatch, lambda loop: scene())
    mark = request.node.get_closest_marker("program")
    program = mark.args[0] if mark else COUNTER
    return lambda scene: debugged(lambda mas: scene(mas=mas, debugger=mas.debugger), program, lines)
