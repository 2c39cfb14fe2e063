"""Robots among people: they drive around them or wait."""

import pytest
from navigation_lab import NAVIGATE, Lab, bumps, near, pose

from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.world import PersonDescription

HALL = """
name: hall
size: [6, 3]
border: walls
robots: [{pose: {x: -2, y: 0}}]
people: [{name: ann, path: [[0, 1.2], [0, -1.2]], speed: 0.6, pause: 1, loop: true}]
"""

CORRIDOR = """
name: corridor
bounds: {from: [-3, -0.4], to: [3, 0.4]}
border: walls
robots: [{pose: {x: -2, y: 0}}]
people: [{name: ann, path: [[0.5, 0]]}]
"""


@pytest.mark.world(HALL)
async def test_a_robot_crosses_the_path_of_a_person_without_a_touch(lab: Lab) -> None:
    for x in (2.0, -2.0) * 4:
        outcome = await lab.go(x, 0)
        assert outcome.status == GoalStatus.SUCCEEDED
        near(lab.world, x, 0.0, 0.0)
    assert bumps(lab.world) == []


@pytest.mark.world(CORRIDOR)
async def test_a_person_in_a_corridor_blocks_the_way(lab: Lab) -> None:
    outcome = await lab.go(2, 0)
    assert outcome.result.error_code == 208
    assert "another robot or a person blocks the path" in outcome.result.error_msg
    assert bumps(lab.world) == []


@pytest.mark.world(CORRIDOR)
async def test_a_robot_continues_when_the_person_has_gone(lab: Lab) -> None:
    handle = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(2, 0))
    await lab.clock.sleep(10.0)
    assert lab.world.robot().x < 0.1
    lab.world.remove_person("ann")
    assert (await handle.outcome(timeout=60.0)).status == GoalStatus.SUCCEEDED
    lab.world.add_person(PersonDescription("bob", ((0.0, 0.0),)))
    assert (await lab.go(-2, 0)).result.error_code == 208
