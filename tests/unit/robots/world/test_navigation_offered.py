"""The map and the servers of a navigating robot, unless they are disabled."""

import math
from typing import Any

import pytest
from navigation_lab import NAVIGATE, Lab

from jacaros.robots.ros.errors import UnknownInterface
from jacaros.robots.ros.qos import LATCHED
from jacaros.robots.world import SimNode, World


@pytest.mark.world("house")
async def test_the_map_is_available_latched_and_as_a_service(lab: Lab) -> None:
    maps = lab.hear("/map", "nav_msgs/msg/OccupancyGrid", LATCHED)
    await lab.clock.sleep(1.0)
    late = lab.hear("/map", "nav_msgs/msg/OccupancyGrid", LATCHED)
    await lab.clock.sleep(1.0)
    assert (len(maps), len(late)) == (1, 1)
    info, data = maps[0].info, maps[0].data
    assert (info.width, info.height) == (88, 88)
    assert info.resolution == pytest.approx(0.05)
    assert (info.origin.position.x, info.origin.position.y) == pytest.approx((-1.2, -1.2))

    def at(x: float, y: float) -> int:
        return int(data[math.floor((y + 1.2) / 0.05) * 88 + math.floor((x + 1.2) / 0.05)])

    assert at(0, 0) == at(2, 2) == 0
    assert at(3, 3) == at(-1.19, 0) == at(1.01, -0.9) == 100
    answer = await lab.call("/map_server/map", "nav_msgs/srv/GetMap")
    assert list(answer.map.data) == list(data)


@pytest.mark.world("name: w\nrobots: [{name: r, navigation: false}]\n")
async def test_navigation_can_be_switched_off(lab: Lab) -> None:
    assert lab.node.navigation == []
    await lab.clock.sleep(0.2)
    assert not lab.backend.action_client("/navigate_to_pose", NAVIGATE).ready


@pytest.mark.world("robots: [{name: r, navigation: false}]\n")
async def test_unknown_types_are_skipped_with_a_warning(lab: Lab, monkeypatch: pytest.MonkeyPatch) -> None:
    backend, told = lab.backend, []
    offer = backend.action_server

    def some(name: str, type_name: str, *rest: Any) -> Any:
        if "irobot" in type_name:
            raise UnknownInterface("not here")
        return offer(name, type_name, *rest)

    monkeypatch.setattr(backend, "action_server", some)
    monkeypatch.setattr(backend, "rosout", lambda level, text: told.append((level, text)))
    node = SimNode(World.load("empty"), backend, lab.clock)
    node.start()
    assert backend.action_client("/navigate_to_pose", NAVIGATE).ready
    node.close()
    assert told[0] == ("warn", "action /dock is not offered: unknown type irobot_create_msgs/action/Dock")
    assert len(told) == 4
