"""Fixtures of runs on real graphs: the world is one process, the agents are another, and the world's file judges.

Folders with such tests import them in their ``conftest.py``. What a graph is made of (master, peers) comes from the
contract suite.
"""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parents[2] / "contracts"))

from graphs import InProcesses, ProcessPeer
from masters import Master
from presence import is_wanted, need, ros2_environment
from processes import JACAROS, Agents, Program, WorldProcess

KINDS = ("ros1", "ros2")
WORLDS = Path(__file__).parent / "worlds"
PROGRAMS = Path(__file__).parent / "programs"
MARKS = {"ros1": [pytest.mark.ros1, pytest.mark.slow], "ros2": [pytest.mark.ros2, pytest.mark.slow]}


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run every test on each kind of graph that is there, or on the kind that it names with `only`."""
    if "kind" in metafunc.fixturenames:
        only = metafunc.definition.get_closest_marker("only")
        asked = only.args if only else KINDS
        kinds = [pytest.param(k, marks=MARKS[k]) for k in asked if is_wanted(k, metafunc.config)]
        if not kinds:
            reason = f"this is a test for {' and '.join(asked)}"
            kinds = [pytest.param(asked[0], marks=pytest.mark.skip(reason=reason))]
        metafunc.parametrize("kind", kinds, scope="session")


@pytest.fixture(scope="session")
def master(
    kind: str, request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory
) -> Iterator[Master | None]:
    """The ROS 1 master of all tests; None on ROS 2."""
    need(kind, request.config)
    if kind != "ros1":
        yield None
        return
    made = Master(tmp_path_factory.mktemp("master"))
    made.start()
    yield made
    made.close()


@pytest.fixture(scope="session")
def environment(kind: str, master: Master | None, tmp_path_factory: pytest.TempPathFactory) -> dict[str, str]:
    """Variables that keep a run in a graph of its own on this machine."""
    if master is not None:
        return master.environment
    return ros2_environment(tmp_path_factory.mktemp("ros2"))


@pytest.fixture
def run_world(
    kind: str, environment: dict[str, str], tmp_path: Path
) -> Iterator[Callable[..., WorldProcess]]:
    """Starts a world, given by its file or name, as a process of its own.

    What follows are further options of ``jacaros sim``.
    """
    started: list[WorldProcess] = []

    def run(world: str | Path, *options: str) -> WorldProcess:
        started.append(WorldProcess(world, kind, environment, tmp_path, *options))
        started[-1].until_open()
        return started[-1]

    yield run
    for each in started:
        each.stop()


@pytest.fixture
def run_agents(kind: str, environment: dict[str, str]) -> Iterator[Callable[..., Agents]]:
    """Starts agents, given by a project file or a program of the folder `programs`, as a process of their own.

    What follows are further options of ``jacaros run``.
    """
    started: list[Agents] = []

    def run(project: str | Path, *options: str) -> Agents:
        started.append(Agents(PROGRAMS / project, kind, environment, *options))
        return started[-1]

    yield run
    for each in started:
        each.stop()


@pytest.fixture
def peer(kind: str, environment: dict[str, str]) -> Iterator[Callable[[str], ProcessPeer]]:
    """Makes further nodes, each a process of its own; they end with the test."""
    graph = InProcesses(kind, environment)

    def make(name: str) -> Any:
        return graph.peer(name)

    yield make
    graph.close()


@pytest.fixture
def world(run_world: Callable[[str | Path], WorldProcess]) -> WorldProcess:
    """The yard: an open floor with one robot at the origin."""
    return run_world(WORLDS / "yard.yaml")


@pytest.fixture
def ask(kind: str, environment: dict[str, str]) -> Iterator[Callable[..., Program]]:
    """Runs ``jacaros ros ...`` to its end."""
    started: list[Program] = []

    def run(*words: str) -> Program:
        started.append(
            Program([JACAROS, "ros", words[0], "--ros", kind, "--timeout", "30", *words[1:]], environment)
        )
        started[-1].code = started[-1].end()
        return started[-1]

    yield run
    for each in started:
        each.stop()
