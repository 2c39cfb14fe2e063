"""The names of a robot on the graph: those of its kind, renamed in the world file."""

from pathlib import Path

import pytest
from navigation_lab import Lab, pose

from jacaros.robots.ros.action import GoalStatus
from jacaros.robots.ros.backend import GraphContents
from jacaros.robots.world import World, WorldError
from jacaros.robots.world.data.robot import ACTIONS, SERVICES, TOPICS
from jacaros.runtime.cli.main import call

FULL = "robots: [{gripper: true, tools: {mop: {removes: [dust]}}}]\n"
ROVER = """
robots:
  - name: rover
    kind: turtlebot3
    namespace: rover
    topics:
      scan: front/scan
      odom: /odometry
      cmd_vel: base/cmd
      mobile_base/events/bumper: bumper
    actions:
      navigate_to_pose: go_to
"""


async def contents(lab: Lab) -> GraphContents:
    found: GraphContents = await lab.backend.contents()
    return found


@pytest.mark.world(FULL)
async def test_a_robot_without_a_kind_has_all_that_can_be_named_in_a_world_file(lab: Lab) -> None:
    found = await contents(lab)
    assert set(found.topics) - {"/map", "/tf", "/tf_static"} == {f"/{name}" for name in TOPICS}
    assert set(found.actions) == {f"/{name}" for name in ACTIONS}
    assert set(found.services) - {"/map_server/map"} == {f"/{name}" for name in SERVICES}


@pytest.mark.parametrize("kind", ["turtlebot2", "turtlebot3", "turtlebot4"])
def test_only_the_mapping_of_a_robot_fits_the_robot(
    kind: str, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    world = tmp_path / "world.yaml"
    world.write_text(f"robots: [{{kind: {kind}}}]\n", encoding="utf-8")
    fits = {
        each: call(["ros", "check", f"{each}.yaml", "--world", str(world)]) == 0
        for each in ("turtlebot2", "turtlebot3", "turtlebot4", "nav2", "move_base")
    }
    assert fits == {each: each in (kind, "nav2", "move_base") for each in fits}
    assert "Traceback" not in capsys.readouterr().err


@pytest.mark.world(ROVER)
async def test_names_are_replaced_and_added(lab: Lab) -> None:
    found = await contents(lab)
    for name in ("/rover/front/scan", "/odometry", "/rover/base/cmd", "/rover/bumper"):
        assert name in found.topics
    for name in ("/rover/scan", "/rover/odom", "/rover/cmd_vel", "/rover/mobile_base/events/cliff"):
        assert name not in found.topics
    assert "/rover/go_to" in found.actions
    assert "/rover/navigate_to_pose" not in found.actions


@pytest.mark.world(ROVER)
async def test_a_renamed_robot_obeys_its_own_topic_and_its_navigation_uses_it(lab: Lab) -> None:
    seen = lab.hear("/odometry", "nav_msgs/msg/Odometry")
    lab.say("/rover/base/cmd", "geometry_msgs/msg/Twist", linear={"x": 0.2})
    await lab.clock.sleep(0.5)
    assert seen[-1].pose.pose.position.x > 0.0
    goal = pose(0.5, 0, frame="rover/map")
    done = await lab.do("/rover/go_to", "nav2_msgs/action/NavigateToPose", pose=goal)
    assert done.status is GoalStatus.SUCCEEDED
    assert lab.world.robot("rover").x == pytest.approx(0.5, abs=0.06)


@pytest.mark.world("robots: [{topics: {odom: scan, scan: odom}}]\n")
async def test_names_may_be_exchanged(lab: Lab) -> None:
    found = await contents(lab)
    assert found.topics["/scan"].types == ("nav_msgs/msg/Odometry",)
    assert found.topics["/odom"].types == ("sensor_msgs/msg/LaserScan",)


@pytest.mark.parametrize(
    ("entry", "problem", "help"),
    [
        ("topics: {scn: x}", "2:15: error: unknown name in 'topics': `scn`", "did you mean `scan`?"),
        ("topics: {horn: x}", "2:15: error: unknown name in 'topics': `horn`", "known names: amcl_pose, "),
        ("actions: {dok: x}", "2:16: error: unknown name in 'actions': `dok`", "did you mean `dock`?"),
        ("actions: {fly: {type: a}}", "2:16: error: unknown name in 'actions': `fly`", "known names: dock, "),
        (
            "topics: {scan: odom}",
            "2:21: error: `odom` is also the name of `odom`",
            "give one of them another name",
        ),
        ("topics: {scan: a b}", "2:21: error: 'a b' is not a ROS name", "front/scan"),
        ("topics: {scan: 3}", "2:21: error: 'scan' must be a text, not 3", "put it in quotes"),
    ],
)
def test_mistakes_are_reported_with_their_place(entry: str, problem: str, help: str) -> None:
    with pytest.raises(WorldError) as wrong:
        World.load(f"robots:\n  - {{{entry}}}\n")
    assert f"world:{problem}" in str(wrong.value)
    assert help in str(wrong.value)
