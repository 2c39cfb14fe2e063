"""ArtRos: what agents write to parameters of nodes, and the reason of each failure."""

from typing import Any

import pytest
from robot_lab import Lab

from jacaros.artifacts import Out, Structure
from jacaros.robots.artifacts.connection_artifact import ArtRos
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


async def node_with(lab: Lab, name: str, value: Any) -> Any:
    shared: Any = lab.backend
    node = open_backend("memory", lab.clock, name, log=lambda text: None, graph=shared.graph)
    await node.start()
    node.parameters().declare("p", DeclaredParameter(value))
    return node


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
    node = await node_with(lab, "n", before)
    artifact = await lab.make(ArtRos)
    await lab.do(artifact, "set_parameter", "n", "p", written)
    found = await node.parameters().get("p")
    assert list(found) == after if isinstance(after, list) else found == after
    assert type(found) is type(after) or isinstance(after, list)
    await node.close()


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


@pytest.mark.parametrize("level", ["debug", "info", "warn", "error", "fatal"])
async def test_a_line_of_the_log_has_its_level(lab: Lab, level: str) -> None:
    heard: list[tuple[str, str]] = []
    backend: Any = lab.backend
    backend.rosout = lambda *line: heard.append(line)
    artifact = await lab.make(ArtRos)
    await lab.do(artifact, "rosout", level, "text")
    assert heard == [(level, "text")]
