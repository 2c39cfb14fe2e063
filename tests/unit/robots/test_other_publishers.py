"""Another node that commands the same robot is named: in the log, as a percept, and to `ros check`."""

from robot_lab import TWIST, Lab

from jacaros.artifacts.env.values import Structure
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.mapping.artifact import mapped_type
from jacaros.robots.mapping.file import read_mapping

MAPPING = """operations:
  roll: {parameters: [v], publish: cmd_vel, type: geometry_msgs/msg/Twist, fields: {linear.x: $v}}
"""


async def test_a_node_that_drives_the_same_robot_is_named_until_it_leaves(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtCmdVel, name="wheels"))
    await lab.sleep(5)
    assert watcher.holds("other_publisher") == []
    teleop = await lab.node("teleop")
    teleop.publisher("/cmd_vel", TWIST)
    await lab.sleep(3)
    assert watcher.holds("other_publisher") == [("/cmd_vel", "/teleop")]
    assert "[wheels] warning: /teleop also publishes on /cmd_vel: the robot follows" in lab.logged[-1]
    await teleop.close()
    await lab.sleep(3)
    assert watcher.holds("other_publisher") == []


async def test_a_mapping_that_publishes_velocities_names_it_too(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(mapped_type(read_mapping(MAPPING, "robot.yaml"), "robot")))
    (await lab.node("planner")).publisher("/cmd_vel", "geometry_msgs/msg/TwistStamped")
    await lab.sleep(3)
    assert watcher.holds("other_publisher") == [("/cmd_vel", "/planner")]


async def test_neither_the_guard_nor_other_artifacts_of_the_run_count(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtCmdVel))
    second = await lab.make(ArtCmdVel)
    (await lab.node("lab_guard")).publisher("/cmd_vel", TWIST)
    await lab.sleep(4)
    lab.workspace.dispose_artifact(second)
    await lab.sleep(4)
    assert watcher.holds("other_publisher") == []
    assert not any("also publishes" in line for line in lab.logged)


async def test_one_node_is_logged_once_by_all_artifacts_and_shown_by_each(lab: Lab) -> None:
    watchers = [lab.watch(await lab.make(ArtCmdVel)) for _ in range(2)]
    (await lab.node("teleop")).publisher("/cmd_vel", TWIST)
    await lab.sleep(4)
    assert [each.holds("other_publisher") for each in watchers] == [[("/cmd_vel", "/teleop")]] * 2
    assert sum("teleop" in line for line in lab.logged) == 1


async def test_another_node_of_the_same_name_counts(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtCmdVel))
    (await lab.node("lab")).publisher("/cmd_vel", TWIST)
    await lab.sleep(3)
    assert watcher.holds("other_publisher") == [("/cmd_vel", "/lab")]


async def test_a_topic_of_its_own_silences_the_warning(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtCmdVel, Structure("command_topic", ("agents/cmd_vel",))))
    (await lab.node("twist_mux")).publisher("/cmd_vel", TWIST)
    await lab.sleep(4)
    assert watcher.holds("other_publisher") == []
