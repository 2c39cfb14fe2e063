"""The graphs that the one contract suite runs on."""

import sys
from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

sys.path.insert(0, str(Path(__file__).parent))  # the peers' files are programs, not a package

from bridges import BRIDGED, BehindBridge, BridgeServer, behind_bridge
from expected import BEYOND
from graphs import InMemory, InProcesses
from masters import Broker, Master
from presence import is_wanted, need, ros2_environment

KINDS = ("memory", "ros1", "ros2", *BRIDGED, "mqtt")


def pytest_generate_tests(metafunc: pytest.Metafunc) -> None:
    """Run every test that wants a graph on each kind of it, or on those that it names with `only`."""
    if "graph" in metafunc.fixturenames:
        only = metafunc.definition.get_closest_marker("only")
        kinds = [kind for kind in (only.args if only else KINDS) if is_wanted(kind, metafunc.config)]
        marks = {kind: [getattr(pytest.mark, kind)] for kind in ("ros1", "ros2", "mqtt")}
        marks |= {kind: [pytest.mark.rosbridge] for kind in BRIDGED}
        metafunc.parametrize(
            "graph", [pytest.param(k, marks=marks.get(k, [])) for k in kinds], indirect=True, scope="session"
        )


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker `only` known."""
    config.addinivalue_line("markers", "only(kinds): run a contract test on these kinds of graph alone")
    config.addinivalue_line(
        "markers", "needs(words): skip where these cannot be shown (BEYOND in expected.py)"
    )


@pytest.fixture(autouse=True)
def _has_what_is_needed(request: pytest.FixtureRequest) -> None:
    """Skip what cannot be shown on a kind of graph."""
    if "graph" in request.fixturenames:
        kind = request.getfixturevalue("graph").kind
        needed = {word for marker in request.node.iter_markers("needs") for word in marker.args}
        if needed & BEYOND.get(kind, set()):
            pytest.skip(f"cannot be shown on {kind}: {', '.join(sorted(needed & BEYOND[kind]))}")


@pytest.fixture(scope="session")
def graph(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Any]:
    """A graph that tests share; they use names of their own in it."""
    kind = request.param
    need(kind, request.config)
    if kind == "memory":
        made: Any = InMemory()
        yield made
        made.close()
        return
    if kind in BRIDGED:
        made = behind_bridge(kind)
        yield made
        made.close()
        return
    folder = tmp_path_factory.mktemp(kind)
    if kind == "ros2":
        made = InProcesses(kind, ros2_environment(folder))
        yield made
        made.close()
        return
    server = Broker(folder) if kind == "mqtt" else Master(folder)
    server.start()
    made = InProcesses(kind, server.environment)
    yield made
    try:
        made.close()
    finally:
        server.close()


@pytest.fixture(scope="session")
def _pairs() -> dict[int, tuple[Any, Any]]:
    return {}


@pytest.fixture
def pair(graph: Any, _pairs: dict[int, tuple[Any, Any]]) -> tuple[Any, Any]:
    """Two nodes of the graph that tests share."""
    if id(graph) not in _pairs:
        _pairs[id(graph)] = (graph.peer("left"), graph.peer("right"))
    return _pairs[id(graph)]


@pytest.fixture
def left(pair: tuple[Any, Any]) -> Any:
    return pair[0]


@pytest.fixture
def right(pair: tuple[Any, Any]) -> Any:
    return pair[1]


@pytest.fixture(scope="session")
def _uses() -> Counter[str]:
    return Counter()


@pytest.fixture
def own_name(request: pytest.FixtureRequest, _uses: Counter[str]) -> str:
    """A word that belongs to this test with its parameters, and to this attempt at it.

    Peers remember what they did for the one before, and those that a test starts live on until the last test is over.
    """
    name = str(request.node.originalname)
    _uses[name] += 1
    return name if _uses[name] == 1 else f"{name}_{_uses[name]}"


@pytest.fixture
def topic(own_name: str) -> str:
    """A name that belongs to this test."""
    return "/" + own_name


@pytest.fixture
def master(tmp_path: Path, request: pytest.FixtureRequest) -> Iterator[Master]:
    """A ROS master of this test, not started yet."""
    if not is_wanted("ros1", request.config):
        pytest.skip("no ROS 1 here; see test_contract_presence")
    made = Master(tmp_path)
    yield made
    made.close()


@pytest.fixture
def domain(tmp_path: Path, request: pytest.FixtureRequest) -> dict[str, str]:
    """The environment of a ROS 2 domain of this test."""
    if not is_wanted("ros2", request.config):
        pytest.skip("no ROS 2 here; see test_contract_presence")
    return ros2_environment(tmp_path)


@pytest.fixture(params=("ros1", "ros2"))
def bridged(request: pytest.FixtureRequest) -> Iterator[BehindBridge]:
    """A bridge of this test's own; the peers ``robot`` and ``other_robot`` are nodes behind it, the others are clients."""
    yield from own_bridge(request, request.param)


@pytest.fixture
def robot_of_ros2(request: pytest.FixtureRequest) -> Iterator[BehindBridge]:
    """The same for ROS 2 alone; the parameter is an option of the server."""
    yield from own_bridge(request, "ros2", *([request.param] if hasattr(request, "param") else ()))


def own_bridge(request: pytest.FixtureRequest, *server: str) -> Iterator[BehindBridge]:
    need("rosbridge", request.config)
    made = BehindBridge(f"rosbridge-{server[0]}", BridgeServer(*server), native=("robot", "other_robot"))
    yield made
    made.close()
