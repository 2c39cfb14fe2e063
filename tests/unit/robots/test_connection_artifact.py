"""ArtRos: the connection itself, parameters, the graph, frames."""

import asyncio
import math
from typing import Any

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, Environment, Out, Structure
from jacaros.robots.artifacts.connection_artifact import ArtRos
from jacaros.robots.registry import find_type
from jacaros.robots.ros.errors import (
    CallTimedOut,
    ParameterRefused,
    RosError,
    ServiceError,
    ServiceUnavailable,
    TransformUnavailable,
)
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.parameter import DeclaredParameter
from jacaros.robots.ros.ros_clock import RosClock
from jacaros.runtime.clock import VirtualClock


def test_it_is_found_under_its_names() -> None:
    assert find_type("ArtRos") is find_type("jacaros.ArtRos") is ArtRos


@made(ArtRos)
async def test_it_shows_the_connection(lab: Lab, watcher: Watcher) -> None:
    assert watcher.holds("middleware") == [("memory",)]
    assert watcher.holds("node") == [("/lab",)]
    assert watcher.holds("connected") == [()]
    backend: Any = lab.backend
    backend.set_connected(False)
    await lab.sleep(0.1)
    assert watcher.holds("connected") == []
    backend.set_connected(True)
    await lab.sleep(0.1)
    assert watcher.holds("connected") == [()]


async def given(lab: Lab, artifact: ArtifactId, operation: str, *arguments: object) -> Any:
    """What an operation with one output gives."""
    out = Out()
    await lab.do(artifact, operation, *arguments, out)
    return out.value


@made(ArtRos)
async def test_parameters_of_nodes_are_read_and_written(lab: Lab, artifact: ArtifactId) -> None:
    own = (await lab.node("controller")).parameters()
    own.declare("speed", DeclaredParameter(0.5, maximum=1.0))
    own.declare("name", DeclaredParameter("bob"))
    own.declare("places", DeclaredParameter([1.0, 2.0]))
    assert await given(lab, artifact, "get_parameter", "controller", "speed") == 0.5
    names = await given(lab, artifact, "list_parameters", "/controller")
    assert [each for each in names if each in ("name", "places", "speed")] == ["name", "places", "speed"]
    assert await given(lab, artifact, "get_parameter", "controller", "places") == [1.0, 2.0]
    refused = await lab.call(artifact, "set_parameter", "controller", "speed", 7.5)
    assert refused.reason == 'parameter_refused("speed")'
    unknown = await lab.call(artifact, "get_parameter", "controller", "sped", Out())
    assert unknown.reason == 'parameter_unknown("sped")'


@made(ArtRos, Structure("timeout", (2,)))
async def test_a_node_that_is_not_there_fails_in_time(lab: Lab, artifact: ArtifactId) -> None:
    before = lab.clock.elapsed
    absent = await lab.call(artifact, "get_parameter", "nobody", "speed", Out())
    assert absent.reason == 'service_unavailable("nobody")'
    assert math.isclose(lab.clock.elapsed - before, 2.0, abs_tol=0.2)


@pytest.mark.world("empty")
@made(ArtRos)
async def test_the_graph_is_listed(lab: Lab, artifact: ArtifactId) -> None:
    await lab.node("helper")
    assert Structure("topic", ("/odom", "nav_msgs/msg/Odometry")) in await given(lab, artifact, "list_topics")
    assert "/helper" in await given(lab, artifact, "list_nodes")


@made(ArtRos, Structure("timeout", (1,)))
async def test_frames_are_looked_up_in_metres_and_degrees(lab: Lab, artifact: ArtifactId) -> None:
    half = math.sin(math.pi / 4)
    transform = {"translation": {"x": 1.0, "y": -2.0, "z": 0.0}, "rotation": {"z": half, "w": half}}
    header = {"frame_id": "map", "stamp": lab.clock.now()}
    shelf = {"header": header, "child_frame_id": "shelf", "transform": transform}
    (await lab.node("frames")).tf_broadcast(shelf, static=True)
    x, y, yaw = Out(), Out(), Out()
    await lab.do(artifact, "lookup_transform", "map", "shelf", x, y, yaw)
    assert (x.value, y.value) == (1.0, -2.0)
    assert math.isclose(yaw.value, 90.0)
    missing = await lab.call(artifact, "lookup_transform", "map", "shelv", Out(), Out(), Out())
    assert missing.reason == "transform_unavailable(unknown_frame)"


@made(ArtRos)
async def test_lines_go_to_the_graphs_log(lab: Lab, artifact: ArtifactId) -> None:
    heard = lab.hear("/rosout", "rcl_interfaces/msg/Log")
    for level in ("debug", "info", "warn", "error", "fatal"):
        await lab.do(artifact, "rosout", level, "the shelf is empty")
    await lab.sleep(0.1)
    assert {(each.name.strip("/"), each.msg) for each in heard} == {("lab", "the shelf is empty")}
    assert [each.level for each in heard] == [10, 20, 30, 40, 50]
    wrong = await lab.call(artifact, "rosout", "loud", "hello")
    assert wrong.reason == 'unknown_level("loud")'


async def test_a_jump_of_the_simulators_time_is_a_signal() -> None:
    clock = RosClock(lambda text: None)
    clock.move_to(100.0)
    backend = open_backend("memory", clock, "lab", log=lambda text: None)
    await backend.start()
    environment = Environment(clock, {"ros": backend})
    workspace = environment.workspace("/main")
    watcher = Watcher(VirtualClock())
    workspace.focus(await workspace.make_artifact("ros", ArtRos, ()), watcher)
    signals = [("clock_jumped", (40.0,)), ("clock_jumped_ahead", (30.0,))]
    for number, time in enumerate((60.0, 90.0), 1):
        clock.move_to(time)
        for _ in range(20):
            await asyncio.sleep(0)
        assert watcher.signals == signals[:number]
    await environment.close()
    await backend.close()


@pytest.mark.parametrize(
    ("before", "written", "after"),
    [
        (1.5, 2, 2.0),
        (1.5, 2.5, 2.5),
        (1, 2, 2),
        (False, True, True),
        ("a", "b", "b"),
        ([1, 2], [3, 4, 5], [3, 4, 5]),
        ([0.5], [3, 4.5], [3.0, 4.5]),
        (["a"], ["b", "c"], ["b", "c"]),
        ([True], [False, True], [False, True]),
        (["a"], [], []),
    ],
)
async def test_a_value_keeps_the_parameters_type(lab: Lab, before: Any, written: Any, after: Any) -> None:
    node = await lab.node("n")
    node.parameters().declare("p", DeclaredParameter(before))
    artifact = await lab.make(ArtRos)
    await lab.do(artifact, "set_parameter", "n", "p", written)
    found = await node.parameters().get("p")
    assert list(found) == after if isinstance(after, list) else found == after
    assert type(found) is type(after) or isinstance(after, list)


@pytest.mark.parametrize(
    "value", [[1, "a"], [True, 2], [[1], [2]], Structure("f", (1,)), ["a", Structure("f", (1,))]]
)
async def test_a_value_that_no_parameter_has_is_refused_before_a_node_is_asked(lab: Lab, value: Any) -> None:
    artifact = await lab.make(ArtRos)
    refused = await lab.call(artifact, "set_parameter", "nobody", "p", value)
    assert refused.reason == 'parameter_refused("p")'
    assert lab.clock.elapsed == 0


async def test_names_of_nodes_are_below_the_robots_name_unless_they_are_absolute(lab: Lab) -> None:
    asked: list[str] = []

    class Answers:
        async def get(self, name: str, timeout: float) -> Any:
            return timeout

    def parameters(node: str) -> Answers:
        asked.append(node)
        return Answers()

    backend: Any = lab.backend
    backend.parameters = parameters
    artifact = await lab.make(ArtRos, "bot", Structure("timeout", (2.5,)))
    for name in ("n", "/bot/n", "/n", "~n"):
        out = Out()
        await lab.do(artifact, "get_parameter", name, "p", out)
        assert out.value == 2.5
    assert [asked[0].lstrip("/"), *asked[1:]] == ["bot/n", "/bot/n", "/n", "~n"]


@pytest.mark.parametrize(
    ("error", "reason"),
    [
        (ParameterRefused("no"), 'parameter_refused("p")'),
        (TransformUnavailable("old", "too_old"), "transform_unavailable(too_old)"),
        (ServiceUnavailable("gone"), 'service_unavailable("n")'),
        (CallTimedOut("late"), "service_timeout(5)"),
        (ServiceError("broken"), 'service_failed("n")'),
        (RosError("other"), 'ros_error("RosError")'),
    ],
)
async def test_each_error_of_the_graph_has_its_reason(lab: Lab, error: RosError, reason: str) -> None:
    class Broken:
        async def get(self, name: str, timeout: float) -> Any:
            raise error

    backend: Any = lab.backend
    backend.parameters = lambda node: Broken()
    artifact = await lab.make(ArtRos)
    failed = await lab.call(artifact, "get_parameter", "n", "p", Out())
    assert failed.reason == reason
