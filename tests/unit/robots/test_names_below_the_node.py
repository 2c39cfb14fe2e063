"""The node's namespace (`jacaros run --namespace`) moves the names of every artifact, and missing ones are suggested."""

import math
from collections.abc import Awaitable, Callable
from typing import Any

import pytest
from robot_lab import Lab

from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.artifacts.odometry import ArtOdometry
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.registry import BUILT_IN
from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import SimNode, World
from jacaros.runtime.clock import VirtualClock, run
from played import played


async def used_by_agents(lab: Lab) -> set[str]:
    """The topics of the agents' node, according to the graph."""
    contents = await lab.backend.contents()
    return {
        name
        for name, info in contents.topics.items()
        if lab.backend.node_name in {each.node for each in (*info.publishers, *info.subscriptions)}
    }


def below(namespace: str, body: Callable[[Lab], Awaitable[None]]) -> Lab:
    """Run *body* with artifacts of a node in a namespace; the node of the world is in none."""
    clock, labs = VirtualClock(), []

    async def main() -> None:
        base = open_backend("memory", clock, "base", log=lambda text: None)
        await base.start()
        graph: Any = base
        backend = open_backend("memory", clock, "agents", namespace, log=lambda text: None, graph=graph.graph)
        await backend.start()
        text = "name: one\nbounds: {from: [-3, -3], to: [3, 3]}\nrobots:\n  - {name: robot_1, namespace: robot_1}\n"
        sim = SimNode(World.load(text), base, clock)
        sim.start()
        lab = Lab(clock, backend, None)
        lab.sim, lab.world = sim, sim.world
        labs.append(lab)
        await body(lab)
        await lab.environment.close()
        sim.close()
        await backend.close()
        await base.close()

    run(main, clock)
    return labs[0]


@played(below, "robot_1")
async def test_a_built_in_artifact_drives_the_robot_of_the_node(lab: Lab) -> None:
    await lab.do(await lab.make(ArtCmdVel), "moveForward", 1)
    assert math.hypot(*lab.pose("robot_1")[:2]) == pytest.approx(1.0, abs=0.02)


@pytest.mark.parametrize("name", sorted(BUILT_IN))
@played(below, "robot_1")
async def test_every_topic_of_a_built_in_artifact_is_below_the_namespace_of_the_node(
    lab: Lab, name: str
) -> None:
    options = [Structure("source", (Atom("robot"),))] if name == "ArtSimBattery" else []
    await lab.make(BUILT_IN[name], *options)
    assert all(each.startswith("/robot_1/") for each in await used_by_agents(lab))


@played(below, "fleet")
async def test_the_name_of_a_robot_is_below_the_namespace_of_the_node(lab: Lab) -> None:
    await lab.make(ArtOdometry, "r2")
    assert await used_by_agents(lab) == {"/fleet/r2/odom"}
    await lab.make(ArtOdometry, "r2", Structure("topic", ("/odom",)))
    assert await used_by_agents(lab) == {"/fleet/r2/odom", "/odom"}


def test_a_missing_topic_suggests_the_one_of_the_same_type() -> None:
    async def body(lab: Lab) -> None:
        await lab.make(ArtOdometry, name="odo")
        await lab.sleep(4)

    lab = below("", body)
    assert lab.logged[0].startswith(
        "[odo] no publisher on topic /odom (nav_msgs/msg/Odometry); still listening\n"
    )
    assert "help: did you mean `/robot_1/odom`? `--namespace NAME`" in lab.logged[0]
