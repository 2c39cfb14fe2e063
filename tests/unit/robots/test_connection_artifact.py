"""ArtRos: the connection itself, parameters, the graph, frames."""

import asyncio
import math
from typing import Any

import pytest
from robot_lab import Lab

from jacaros.artifacts import Environment, Out, Structure
from jacaros.robots.artifacts.connection_artifact import ArtRos
from jacaros.robots.registry import find_type
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.parameter import DeclaredParameter
from jacaros.robots.ros.ros_clock import RosClock
from jacaros.runtime.clock import VirtualClock, run


async def other_node(lab: Lab, name: str) -> Any:
    shared: Any = lab.backend
    node = open_backend("memory", lab.clock, name, log=lambda text: None, graph=shared.graph)
    await node.start()
    return node


def test_it_is_found_under_its_names() -> None:
    assert find_type("ArtRos") is find_type("jacaros.ArtRos") is ArtRos


async def test_it_shows_the_connection(lab: Lab) -> None:
    artifact = await lab.make(ArtRos)
    watcher = lab.watch(artifact)
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


async def test_parameters_of_nodes_are_read_and_written(lab: Lab) -> None:
    node = await other_node(lab, "controller")
    own = node.parameters()
    own.declare("speed", DeclaredParameter(0.5, maximum=1.0))
    own.declare("name", DeclaredParameter("bob"))
    own.declare("places", DeclaredParameter([1.0, 2.0]))
    artifact = await lab.make(ArtRos)
    speed, names, places = Out(), Out(), Out()
    await lab.do(artifact, "get_parameter", "controller", "speed", speed)
    await lab.do(artifact, "list_parameters", "/controller", names)
    assert speed.value == 0.5
    assert [each for each in names.value if each in ("name", "places", "speed")] == [
        "name",
        "places",
        "speed",
    ]
    await lab.do(artifact, "set_parameter", "controller", "speed", 1)
    assert await own.get("speed") == 1.0
    assert isinstance(await own.get("speed"), float)
    await lab.do(artifact, "set_parameter", "controller", "places", [3, 4.5])
    await lab.do(artifact, "get_parameter", "controller", "places", places)
    assert places.value == [3.0, 4.5]
    refused = await lab.call(artifact, "set_parameter", "controller", "speed", 7.5)
    assert refused.reason == 'parameter_refused("speed")'
    strange = await lab.call(artifact, "set_parameter", "controller", "speed", [[1], "a"])
    assert strange.reason == 'parameter_refused("speed")'
    unknown = await lab.call(artifact, "get_parameter", "controller", "sped", Out())
    assert unknown.reason == 'parameter_unknown("sped")'
    await node.close()


async def test_a_node_that_is_not_there_fails_in_time(lab: Lab) -> None:
    artifact = await lab.make(ArtRos, Structure("timeout", (2,)))
    before = lab.clock.elapsed
    absent = await lab.call(artifact, "get_parameter", "nobody", "speed", Out())
    assert absent.reason == 'service_unavailable("nobody")'
    assert math.isclose(lab.clock.elapsed - before, 2.0, abs_tol=0.2)


@pytest.mark.world("empty")
async def test_the_graph_is_listed(lab: Lab) -> None:
    node = await other_node(lab, "helper")
    node.service("/reset", "std_srvs/srv/Trigger", lambda request: {"success": True})
    artifact = await lab.make(ArtRos)
    topics, services, actions, nodes = Out(), Out(), Out(), Out()
    await lab.do(artifact, "list_topics", topics)
    await lab.do(artifact, "list_services", services)
    await lab.do(artifact, "list_actions", actions)
    await lab.do(artifact, "list_nodes", nodes)
    assert Structure("topic", ("/odom", "nav_msgs/msg/Odometry")) in topics.value
    assert Structure("service", ("/reset", "std_srvs/srv/Trigger")) in services.value
    assert isinstance(actions.value, list)
    assert "/helper" in nodes.value
    await node.close()


async def test_frames_are_looked_up_in_metres_and_degrees(lab: Lab) -> None:
    node = await other_node(lab, "frames")
    half = math.sin(math.pi / 4)
    node.tf_broadcast(
        {
            "header": {"frame_id": "map", "stamp": lab.clock.now()},
            "child_frame_id": "shelf",
            "transform": {
                "translation": {"x": 1.0, "y": -2.0, "z": 0.0},
                "rotation": {"z": half, "w": half},
            },
        },
        static=True,
    )
    artifact = await lab.make(ArtRos, Structure("timeout", (1,)))
    x, y, yaw = Out(), Out(), Out()
    await lab.do(artifact, "lookup_transform", "map", "shelf", x, y, yaw)
    assert (x.value, y.value) == (1.0, -2.0)
    assert math.isclose(yaw.value, 90.0)
    missing = await lab.call(artifact, "lookup_transform", "map", "shelv", Out(), Out(), Out())
    assert missing.reason == "transform_unavailable(unknown_frame)"
    await node.close()


async def test_lines_go_to_the_graphs_log(lab: Lab) -> None:
    heard: list[Any] = []
    node = await other_node(lab, "monitor")
    node.subscription("/rosout", "rcl_interfaces/msg/Log", lambda sample: heard.append(sample.message))
    artifact = await lab.make(ArtRos)
    await lab.do(artifact, "rosout", "warn", "the shelf is empty")
    await lab.sleep(0.1)
    assert [(each.name.strip("/"), each.msg) for each in heard] == [("lab", "the shelf is empty")]
    wrong = await lab.call(artifact, "rosout", "loud", "hello")
    assert wrong.reason == 'unknown_level("loud")'
    await node.close()


def test_a_jump_of_the_simulators_time_is_a_signal() -> None:
    signals: list[tuple[str, tuple[object, ...]]] = []

    class Listener:
        agent = "watcher"

        def observe(self, observation: Any) -> None:
            signals.extend((each.name, each.arguments) for each in observation.signals)

    async def main() -> None:
        clock = RosClock(lambda text: None)
        clock.move_to(100.0)
        backend = open_backend("memory", clock, "lab", log=lambda text: None)
        await backend.start()
        environment = Environment(clock, {"ros": backend})
        workspace = environment.workspace("/main")
        made = await workspace.make_artifact("ros", ArtRos, ())
        workspace.focus(made, Listener())
        clock.move_to(60.0)
        for _ in range(20):
            await asyncio.sleep(0)
        assert signals == [("clock_jumped", (40.0,))]
        clock.move_to(90.0)
        for _ in range(20):
            await asyncio.sleep(0)
        assert signals[1:] == [("clock_jumped_ahead", (30.0,))]
        await environment.close()
        await backend.close()

    run(main, VirtualClock())
