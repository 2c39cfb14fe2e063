"""The map and the servers of a navigating robot, unless they are disabled."""

import math
from typing import Any

import pytest
from navigation_lab import NAVIGATE, Lab, in_world

from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.qos import QoS
from jacaros.robots.world import SimNode, World
from jacaros.runtime.clock import VirtualClock, run
from played import played


@played(in_world, "house")
async def test_the_map_is_available_latched_and_as_a_service(lab: Lab) -> None:
    maps: list[Any] = []
    latched = QoS(durability="transient_local", depth=1)
    for _ in range(2):  # the second one comes late
        lab.backend.subscription(
            "/map", "nav_msgs/msg/OccupancyGrid", lambda sample: maps.append(sample.message), latched
        )
        await lab.clock.sleep(1.0)
    assert len(maps) == 2
    info, data = maps[0].info, maps[0].data
    assert (info.width, info.height) == (88, 88)
    assert info.resolution == pytest.approx(0.05)
    assert (info.origin.position.x, info.origin.position.y) == pytest.approx((-1.2, -1.2))

    def at(x: float, y: float) -> int:
        return int(data[math.floor((y + 1.2) / 0.05) * 88 + math.floor((x + 1.2) / 0.05)])

    assert at(0, 0) == at(2, 2) == 0
    assert at(3, 3) == at(-1.19, 0) == at(1.01, -0.9) == 100
    client = lab.backend.client("/map_server/map", "nav_msgs/srv/GetMap")
    answer = await client.call(timeout=5.0)
    assert list(answer.map.data) == list(data)


@played(in_world, "name: w\nrobots: [{name: r, navigation: false}]\n")
async def test_navigation_can_be_switched_off(lab: Lab) -> None:
    assert lab.node.navigation == []
    await lab.clock.sleep(0.2)
    assert not lab.backend.action_client("/navigate_to_pose", NAVIGATE).ready


def test_unknown_types_are_skipped_with_a_warning(monkeypatch: pytest.MonkeyPatch) -> None:
    clock = VirtualClock()
    told = []

    async def main() -> None:
        backend = open_backend("memory", clock, "world")
        await backend.start()
        offer = backend.action_server

        def some(name: str, type_name: str, *rest: Any) -> Any:
            if "irobot" in type_name:
                raise UnknownInterface("not here")
            return offer(name, type_name, *rest)

        monkeypatch.setattr(backend, "action_server", some)
        monkeypatch.setattr(backend, "rosout", lambda level, text: told.append((level, text)))
        node = SimNode(World.load("empty"), backend, clock)
        node.start()
        assert backend.action_client("/navigate_to_pose", NAVIGATE).ready
        node.close()
        await backend.close()

    run(main, clock)
    assert told[0] == (
        "warn",
        "action /dock is not offered: unknown type irobot_create_msgs/action/Dock",
    )
    assert len(told) == 4
