"""Doors in the world, in the graph, and on the path of a robot."""

import math
from typing import Any

import pytest
from navigation_lab import NAVIGATE, Lab, bumps, near, pose

from jacaros.robots.plane.pose import Placement
from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.qos import LATCHED
from jacaros.robots.world import World, WorldError, read_world
from jacaros.robots.world.physics.perception import LaserPerception
from jacaros.runtime.errors import UsageError

TWO_ROOMS = """
name: two rooms
bounds: {from: [-2, -1], to: [2, 1]}
border: walls
walls:
  - segment: [[0, -1], [0, -0.5]]
  - segment: [[0, 0.5], [0, 1]]
doors:
  - {name: kitchen, segment: [[0, -0.5], [0, 0.5]]}
docks:
  - {name: dock, x: 1.2, y: 0}
robots:
  - {name: robot, pose: {x: -1, y: 0}}
"""


async def move(lab: Lab, opened: bool) -> Any:
    return await lab.call("/doors/kitchen/open", "std_srvs/srv/SetBool", data=opened)


def drive(world: World, tenths: int, speed: float) -> None:
    for _ in range(tenths):
        world.command("robot", speed, 0.0)
        world.run(0.1)


def test_a_closed_door_is_a_wall() -> None:
    world = World.load(TWO_ROOMS)
    robot = world.robot()
    assert world.scan("robot")[180] == pytest.approx(1.0)
    assert world.move_door("kitchen", True) is None
    assert world.move_door("kitchen", True) is None
    assert world.scan("robot")[180] == pytest.approx(3.0)
    drive(world, 20, 0.5)
    assert -0.25 < robot.x < 0.25
    assert world.move_door("kitchen", False) == "robot is in the way"
    drive(world, 16, 0.5)
    assert world.move_door("kitchen", False) is None
    drive(world, 40, -0.5)
    assert robot.x == pytest.approx(0.17, abs=0.01), "it is shut in"
    told = [(event.kind, event.data, event.robot) for event in world.log if event.kind.startswith("door")]
    assert told == [("door_opened", {"door": "kitchen"}, ""), ("door_closed", {"door": "kitchen"}, "")]
    with pytest.raises(UsageError, match="unknown door 'cellar'"):
        world.move_door("cellar", True)


pytestmark = pytest.mark.world(TWO_ROOMS)


async def test_a_door_is_moved_and_published_in_the_graph(lab: Lab) -> None:
    heard = lab.hear("/doors/kitchen/is_open", "std_msgs/msg/Bool", LATCHED)
    await lab.clock.sleep(1.0)
    for opened in (True, True, False):
        answer = await move(lab, opened)
        assert (answer.success, answer.message) == (True, "")
        await lab.clock.sleep(0.1)
    lab.world.robot().x = 0.1
    await move(lab, True)
    refused = await move(lab, False)
    assert (refused.success, refused.message) == (False, "robot is in the way")
    assert [message.data for message in heard] == [False, True, False, True]


async def test_a_goal_fails_at_a_closed_door_and_succeeds_when_it_is_open(lab: Lab) -> None:
    failed = await lab.go(1, 0)
    assert (failed.status, failed.result.error_code) == (GoalStatus.ABORTED, 208)
    assert failed.result.error_msg == "the door 'kitchen' is closed, and there is no other path"
    assert 15.0 < lab.clock.elapsed < 45.0
    await lab.stands()
    docking = await lab.do("/dock_robot", "nav2_msgs/action/DockRobot", dock_id="dock")
    assert (docking.status, docking.result.error_code) == (GoalStatus.ABORTED, 903)
    await move(lab, True)
    assert (await lab.go(1, 0)).status == GoalStatus.SUCCEEDED
    near(lab.world, 1, 0, 0)
    assert bumps(lab.world) == []


async def test_a_goal_just_behind_a_closed_door_fails_because_of_the_door(lab: Lab) -> None:
    assert (await lab.go(-0.3, 0)).status == GoalStatus.SUCCEEDED
    failed = await lab.go(0.02, 0)
    assert (failed.result.error_code, "'kitchen' is closed" in failed.result.error_msg) == (208, True)
    assert bumps(lab.world) == []


async def test_the_robot_waits_for_a_door_that_opens_in_time(lab: Lab) -> None:
    handle = await lab.send("/navigate_to_pose", NAVIGATE, pose=pose(1, 0))
    await lab.clock.sleep(8.0)
    assert -0.35 < lab.world.robot().x < -0.15, "it waits before the door"
    await move(lab, True)
    assert (await handle.outcome()).status == GoalStatus.SUCCEEDED
    assert bumps(lab.world) == []


WAY_ROUND = """
name: way round
bounds: {from: [-2, -1], to: [2, 3]}
border: walls
walls:
  - segment: [[0, -1], [0, -0.5]]
  - segment: [[0, 0.5], [0, 2]]
  - segment: [[-2, 1.6], [-1, 1.6]]
doors:
  - {name: kitchen, segment: [[0, -0.5], [0, 0.5]], open: true}
robots:
  - {name: robot, pose: {x: -1.5, y: 0}}
"""


@pytest.mark.world(WAY_ROUND)
async def test_the_robot_avoids_a_closed_door_until_it_is_forgotten_or_seen_open(lab: Lab) -> None:
    async def there(x: float, y: float) -> float:
        begin = lab.world.robot().odometer
        assert (await lab.go(x, y)).status == GoalStatus.SUCCEEDED
        return lab.world.robot().odometer - begin

    assert await there(1.5, 0) < 3.2
    await move(lab, False)
    assert await there(-1.5, 0) > 5.0, "it sees the door, and goes round"
    await there(-1.5, 2.6)
    await move(lab, True)
    assert await there(1.5, 2.6) < 3.5
    clear = "/global_costmap/clear_entirely_global_costmap"
    await lab.call(clear, "nav2_msgs/srv/ClearEntireCostmap")
    assert lab.node.navigation
    assert await there(1.5, 0) < 3.5
    assert await there(-1.5, 0) < 3.2
    assert bumps(lab.world) == []


def test_a_closed_door_blocks_the_view() -> None:
    text = TWO_ROOMS.replace("docks:", "  - {name: pantry, segment: [[1, -1], [1, 1]], open: true}\ndocks:")
    world = World.load(text)
    world.move_door("pantry", False)
    robot = world.robot()
    here = Placement.at(robot.x, robot.y, robot.yaw)
    sight = LaserPerception(world, robot)
    assert list(sight.closed_doors(here)) == ["kitchen"]
    world.move_door("kitchen", True)
    assert list(sight.closed_doors(here)) == ["pantry"]


async def test_the_map_shows_doors_as_free(lab: Lab) -> None:
    found = (await lab.call("/map_server/map", "nav_msgs/srv/GetMap")).map
    column = math.floor(2.0 / found.info.resolution)
    middle = math.floor(1.0 / found.info.resolution) * found.info.width + column
    assert found.data[middle] == 0
    assert found.data[math.floor(0.2 / found.info.resolution) * found.info.width + column] == 100


WRONG = """
name: wrong
doors:
  - {name: back door, segment: [[0, 0], [1, 0]]}
  - {name: a, segment: [[0, 0], [1, 0], [2, 0]]}
  - {name: b, segment: [[0, 0], [0, 0]]}
  - {name: c}
  - {name: d, segment: [[0, 0], [1, 0]], open: ajar}
  - {name: d, segment: [[0, 1], [1, 1]]}
robots: [{}]
"""


def test_all_mistakes_of_doors_are_reported_in_one_pass() -> None:
    with pytest.raises(WorldError) as wrong:
        read_world(WRONG, "wrong.yaml")
    told = ("'back door' cannot be part", "has 3 points", "twice in a row", "'segment'", "ajar", "door 'd'")
    assert [part for part in told if part not in str(wrong.value)] == []
