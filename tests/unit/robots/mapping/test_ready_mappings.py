"""Every property, signal and operation of the mappings that come with the package."""

import asyncio
from collections.abc import Awaitable, Callable
from typing import Any

import pytest
from mapped_lab import settle
from robot_lab import Lab, Watcher, in_lab

from jacaros.artifacts import ArtifactId, Out
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.mapping.artifact import mapped_type
from jacaros.robots.mapping.encoding import builder, fitting
from jacaros.robots.mapping.file import find_mapping, load_mapping, shipped_mappings
from jacaros.robots.mapping.interfaces import stored_interfaces
from jacaros.robots.mapping.operations import OperationKind
from jacaros.robots.ros.action import ServerGoal
from jacaros.robots.ros.fields import FieldType
from jacaros.runtime.files.yaml import Problem
from played import played

TWIST = "geometry_msgs/msg/Twist"
STAMPED = "geometry_msgs/msg/TwistStamped"
MAPPINGS = (
    "gripper.yaml",
    "move_base.yaml",
    "nav2.yaml",
    "turtlebot2.yaml",
    "turtlebot3.yaml",
    "turtlebot4.yaml",
)
tried: set[tuple[str, str]] = set()
"""File and name of what the tests of this module have looked at."""


def ready(file: str) -> Any:
    path = find_mapping(file)
    assert path is not None
    return load_mapping(path)


class Ready:
    """An artifact of a ready mapping in the laboratory."""

    def __init__(self, lab: Lab, file: str, artifact: ArtifactId, watcher: Watcher) -> None:
        self.lab, self.file, self.artifact, self.watcher = lab, file, artifact, watcher

    async def do(self, operation: str, *arguments: object) -> None:
        tried.add((self.file, operation))
        await self.lab.do(self.artifact, operation, *arguments)

    async def reason(self, operation: str, *arguments: object) -> str:
        return (await self.lab.call(self.artifact, operation, *arguments)).reason

    def value(self, name: str) -> tuple[object, ...]:
        tried.add((self.file, name))
        (values,) = self.watcher.holds(name)
        return values

    def signals(self, name: str) -> list[tuple[object, ...]]:
        tried.add((self.file, name))
        return [values for each, values in self.watcher.signals if each == name]


def with_ready(
    file: str, body: Callable[[Ready], Awaitable[None]], world: str | None = "patrol", *arguments: object
) -> Lab:
    async def in_it(lab: Lab) -> None:
        artifact = await lab.make(mapped_type(ready(file), file.removesuffix(".yaml")), *arguments)
        watcher = lab.watch(artifact)
        await lab.sleep(1.5)
        await body(Ready(lab, file, artifact, watcher))
        silence = ["cannot check the effect"]  # the artifacts of a whole robot are in other tests
        silence += ["waiting", "missing", "no publisher on", "is unknown: no transform"] * (world is None)
        assert [line for line in lab.logged if not any(each in line for each in silence)] == []

    return in_lab(in_it, world)


def poses(*places: tuple[float, float, float]) -> list[Structure]:
    return [Structure("pose", place) for place in places]


def near(lab: Lab, x: float, y: float) -> bool:
    at = lab.pose()
    return abs(at[0] - x) < 0.06 and abs(at[1] - y) < 0.06


def dock_of(robot: Ready) -> object:
    robot.lab.pose()
    return robot.lab.world.robot(None).dock


# ---- in the embedded world


@pytest.mark.parametrize("file", ["nav2.yaml", "move_base.yaml"])
def test_going_to_a_pose(file: str) -> None:
    async def body(robot: Ready) -> None:
        await robot.do("navigate_to", 2, 0, 90)
        assert near(robot.lab, 2, 0)
        assert robot.lab.pose()[2] == pytest.approx(90, abs=4)
        await robot.lab.sleep(1)
        assert robot.value("pose") == pytest.approx(robot.lab.pose(), abs=1.1)
        await robot.do("clear_costmaps")
        assert (await robot.reason("navigate_to", 99, 0, 0)).startswith("aborted(")

    with_ready(file, body)


@pytest.mark.parametrize("file", ["nav2.yaml", "move_base.yaml"])
def test_doubt_about_the_place_ends_by_a_given_pose_or_by_searching(file: str) -> None:
    async def body(robot: Ready) -> None:
        robot.lab.world.place("turtlebot", 2, 2, 0)
        await robot.lab.sleep(3)
        assert robot.value("localised")[0] < 75  # type: ignore[operator]
        assert robot.watcher.holds("lost") == [()]
        await robot.do("set_pose", 2.3, 2, 10)
        await robot.lab.sleep(1)
        assert robot.value("pose") == pytest.approx((2, 2, 0), abs=0.1)
        await robot.do("relocalise")
        await robot.lab.sleep(1)
        assert robot.value("localised") == (0,)
        twist = robot.lab.backend.publisher("/cmd_vel", TWIST)
        for _ in range(80):
            twist.publish({"angular": {"z": 1.0}})
            await robot.lab.sleep(0.1)
        assert robot.value("localised") == (100,)
        assert robot.watcher.holds("lost") == []

    with_ready(file, body)


@played(with_ready, "nav2.yaml")
async def test_turning_and_driving_by_odometry(robot: Ready) -> None:
    await robot.do("spin", -90)
    assert robot.lab.pose()[2] == pytest.approx(-90, abs=4)
    await robot.do("drive_on_heading", 0.3, 0.2)
    assert near(robot.lab, 0, -0.3)
    assert (await robot.reason("drive_on_heading", 2, 0.2)).startswith("aborted(723,")
    assert robot.lab.world.robot(None).touching == frozenset()


@played(with_ready, "nav2.yaml")
async def test_feedback_of_nav2_is_there_while_the_robot_is_on_its_way(robot: Ready) -> None:
    tried.update({("nav2.yaml", "distance_left"), ("nav2.yaml", "recoveries")})
    await robot.do("navigate_to", 2, 0, 0)
    left = [values[0] for values in robot.watcher.values("distance_left")]
    assert left[0] > 1.5
    assert left[-1] < 0.3
    assert robot.watcher.values("recoveries") == [(0,)]
    assert robot.watcher.holds("distance_left") == []


@played(with_ready, "nav2.yaml")
async def test_going_through_poses(robot: Ready) -> None:
    tried.add(("nav2.yaml", "poses_left"))
    await robot.do("navigate_through", poses((1.5, 0, 0), (2, 1, 90), (2, 2, 90)))
    assert near(robot.lab, 2, 2)
    assert {values[0] for values in robot.watcher.values("poses_left")} >= {3, 2, 1}


@played(with_ready, "nav2.yaml")
async def test_following_waypoints_and_those_that_were_missed(robot: Ready) -> None:
    tried.add(("nav2.yaml", "waypoint"))
    missed: Out = Out()
    await robot.do("follow_waypoints", poses((1, 0, 0), (50, 0, 0), (2, 0, 0)), missed)
    assert missed.value == [1]
    assert near(robot.lab, 2, 0)
    assert robot.watcher.values("waypoint") == [(0,), (1,), (2,)]


@played(with_ready, "nav2.yaml")
async def test_docking_by_nav2(robot: Ready) -> None:
    tried.add(("nav2.yaml", "docking"))
    await robot.do("dock_at", "dock")
    assert dock_of(robot) is not None
    assert robot.watcher.values("docking")[0] == (Atom("nav_to_staging_pose"),)
    await robot.do("leave_dock")
    assert dock_of(robot) is None
    assert (await robot.reason("dock_at", "dock_7")).startswith("aborted(901,")


@pytest.mark.parametrize("file", ["turtlebot2.yaml", "turtlebot4.yaml"])
def test_docking_by_the_base(file: str) -> None:
    async def body(robot: Ready) -> None:
        for operation, docked in (("dock", True), ("undock", False)):
            await robot.do(operation)
            await robot.lab.sleep(2)
            assert (dock_of(robot) is not None) == docked
            if file == "turtlebot4.yaml":
                assert robot.value("docked") == (docked,)
            if docked:
                assert robot.value("battery")[1] in (Atom("charging"), Atom("full"))

    with_ready(file, body)


@pytest.mark.parametrize("file", ["turtlebot2.yaml", "turtlebot3.yaml", "turtlebot4.yaml"])
def test_driving_and_seeing(file: str) -> None:
    async def body(robot: Ready) -> None:
        await robot.do("drive", 0.25, 0, 2)
        await robot.lab.sleep(1)
        assert robot.lab.speed() == (0, 0)
        x, _, _ = robot.lab.pose()
        assert x == pytest.approx(0.5, abs=0.1)
        assert robot.value("odom") == pytest.approx(robot.lab.pose(), abs=0.03)
        await robot.do("drive", 0, 45, 2)
        await robot.lab.sleep(1)
        assert robot.lab.pose()[2] == pytest.approx(90, abs=10)
        ranges = robot.value("laserrange")
        assert len(ranges) == 5
        assert all(0.1 < each < 10 for each in ranges)  # type: ignore[operator]
        assert robot.value("battery") == (pytest.approx(99, abs=3), Atom("discharging"))

    with_ready(file, body)


def test_bumping() -> None:
    async def body(robot: Ready) -> None:
        await robot.do("drive", -0.5, 0, 3)  # into the wall behind
        await robot.lab.sleep(0.5)
        if robot.file == "turtlebot3.yaml":
            assert robot.value("bumper") == (Atom("back"),)
        await robot.do("drive", 0, 180, 1)
        await robot.do("drive", 0.5, 0, 2)
        await robot.lab.sleep(0.5)
        if robot.file == "turtlebot3.yaml":
            assert robot.value("bumper") == (Atom("front"),)
        if robot.file == "turtlebot4.yaml":
            assert (Atom("bump"), "bump_front_center") in robot.signals("hazard")
            assert len(robot.signals("hazard")) < 6
        if robot.file == "turtlebot2.yaml":
            assert (Atom("center"), Atom("pressed")) in robot.signals("bumper")

    for file in MAPPINGS[3:]:
        with_ready(file, body)


def test_one_name_moves_a_mapping_to_a_robot_of_several() -> None:
    async def body(robot: Ready) -> None:
        await robot.do("navigate_to", -1, 0, 0)
        assert robot.lab.pose("robot_2")[:2] == pytest.approx((-1, 0), abs=0.06)
        await robot.lab.sleep(1)
        assert robot.value("pose")[:2] == pytest.approx((-1, 0), abs=0.06)
        assert robot.lab.pose("robot_1")[:2] == pytest.approx((-2.4, 2.3))

    with_ready("nav2.yaml", body, "three_robots", "robot_2")


# ---- against peers of the tests' own


@pytest.mark.parametrize("file", ["turtlebot3.yaml", "turtlebot4.yaml"])
@pytest.mark.parametrize("stamped", [False, True], ids=["Twist", "TwistStamped"])
def test_a_base_is_driven_with_its_own_message_type(file: str, stamped: bool) -> None:
    heard: list[Any] = []

    async def body(robot: Ready) -> None:
        assert await robot.reason("drive", 0.2, 0, 1) == 'type_unknown("/cmd_vel")'
        kind = STAMPED if stamped else TWIST
        robot.lab.backend.subscription("/cmd_vel", kind, lambda sample: heard.append(sample.message))
        await robot.do("drive", 0.2, 90, 1)
        await settle()
        twists = [each.twist if stamped else each for each in heard]
        assert (twists[0].linear.x, twists[0].angular.z) == pytest.approx((0.2, 1.5708), abs=1e-3)
        assert (twists[-1].linear.x, twists[-1].angular.z) == (0, 0)
        if stamped:
            assert {each.header.frame_id for each in heard} == {"base_link"}
            assert heard[-1].header.stamp.sec >= heard[0].header.stamp.sec

    with_ready(file, body, None)


@played(with_ready, "turtlebot4.yaml", world=None)
async def test_a_base_that_comes_a_little_later_is_waited_for(robot: Ready) -> None:
    run = await robot.lab.begun(1, robot.artifact, "drive", 0.2, 0, 1)
    robot.lab.record()
    await run.done
    assert run.ok


@played(with_ready, "turtlebot2.yaml", world=None)
async def test_the_battery_and_the_cliffs_of_a_kobuki(robot: Ready) -> None:
    for raw, charger, expected in (
        (165, 0, (100, "discharging")),
        (132, 6, (0, "charging")),
        (148, 2, (48, "full")),
    ):
        robot.lab.say(
            "/mobile_base/sensors/core", "kobuki_msgs/msg/SensorState", battery=raw, charger=charger
        )
        await robot.lab.sleep(2)
        percent, status = robot.value("battery")
        assert (percent, str(status)) == expected
    robot.lab.say("/mobile_base/events/cliff", "kobuki_msgs/msg/CliffEvent", sensor=2, state=1)
    robot.lab.say("/mobile_base/events/wheel_drop", "kobuki_msgs/msg/WheelDropEvent", wheel=1, state=1)
    await robot.lab.sleep(0.1)
    assert robot.signals("cliff") == [(Atom("right"), Atom("cliff"))]
    assert robot.signals("wheel_drop") == [(Atom("right"), Atom("dropped"))]


@played(with_ready, "turtlebot4.yaml")
async def test_the_lights_and_tunes_of_a_create(robot: Ready) -> None:
    red, off = Structure("color", (255, 0, 0)), Structure("color", (0, 0, 0))
    for _ in range(2):
        await robot.do("lights", [red] * 2 + [off] * 4)
    await robot.do("play", [Structure("note", (440, 0.5)), Structure("note", (880, 0.25))])
    await robot.lab.sleep(0.1)
    lights, sound = robot.lab.world.ground_truth.events_of("lights", "sound")
    assert lights.data == {"colors": ["#ff0000"] * 2 + ["#000000"] * 4}
    assert sound.data == {"notes": [[440, 0.5], [880, 0.25]], "append": False}
    robot.lab.say("/cmd_lightring", "irobot_create_msgs/msg/LightringLeds")
    await robot.lab.sleep(0.1)
    assert robot.lab.world.ground_truth.events[-1].data == {"colors": []}, "the robot has its lights back"


GOALS = [
    ("nav2.yaml", "navigate_to", (1, 2, 180), "navigate_to_pose", "nav2_msgs/action/NavigateToPose"),
    ("move_base.yaml", "navigate_to", (1, 2, 180), "move_base", "move_base_msgs/action/MoveBase"),
    (
        "nav2.yaml",
        "navigate_through",
        (poses((1, 2, 180)),),
        "navigate_through_poses",
        "nav2_msgs/action/NavigateThroughPoses",
    ),
]


@pytest.mark.parametrize(("file", "operation", "arguments", "action", "kind"), GOALS)
def test_what_a_navigation_server_is_sent(
    file: str, operation: str, arguments: tuple[object, ...], action: str, kind: str
) -> None:
    """The goal, below the robot's name and with its frames; suspending cancels it and resuming sends it again."""
    goals: list[Any] = []
    ended: list[str] = []

    async def body(robot: Ready) -> None:
        async def execute(goal: ServerGoal) -> dict[str, Any]:
            goals.append(goal.request)
            try:
                await robot.lab.sleep(10)
            except asyncio.CancelledError:
                ended.append("cancelled")
                raise
            ended.append("done")
            return {}

        robot.lab.backend.action_server(f"/r1/{action}", kind, execute)
        run = await robot.lab.begun(1, robot.artifact, operation, *arguments)
        run.execution.pause()
        await robot.lab.sleep(1)
        assert ended == ["cancelled"]
        await run.resumed()
        assert run.ok
        assert ended == ["cancelled", "done"]
        for goal in goals:
            pose = (
                goal.poses[0] if hasattr(goal, "poses") else getattr(goal, "target_pose", None) or goal.pose
            )
            assert pose.header.frame_id == "map"
            assert (pose.pose.position.x, pose.pose.position.y) == (1, 2)
            assert pose.pose.orientation.z == pytest.approx(1)

    with_ready(file, body, None, "r1")


def test_the_poses_of_kilted_are_a_message_of_their_own() -> None:
    kept = stored_interfaces()

    class Kilted:
        """Where ``poses`` of ``NavigateThroughPoses`` is a ``nav_msgs/msg/Goals``."""

        def fields(self, type_name: str) -> Any:
            if type_name == "nav_msgs/msg/Goals":
                return {"goals": FieldType("geometry_msgs/msg/PoseStamped", True)}
            found = kept.fields(type_name)
            if type_name == "nav2_msgs/action/NavigateThroughPoses_Goal":
                return {**found, "poses": FieldType("nav_msgs/msg/Goals")}
            return found

        def __getattr__(self, name: str) -> Any:
            return getattr(kept, name)

    (part,) = ready("nav2.yaml").artifacts.values()
    (operation,) = (each for each in part.operations if each.name == "navigate_through")
    goal_type = "nav2_msgs/action/NavigateThroughPoses_Goal"
    problems: list[Problem] = []
    kilted: Any = Kilted()
    fill = builder(fitting(operation, goal_type, kilted), goal_type, kilted, problems)
    assert problems == []
    assert fill is not None
    (goal,) = fill([poses((1, 2, 90))], 0.0)["poses"]["goals"]
    assert goal["pose"]["position"] == {"x": 1, "y": 2}


def test_a_gripper_fails_if_it_grasps_nothing_or_does_not_open() -> None:
    answers = [(True, False), (False, True), (False, True), (True, False)]
    wanted: list[float] = []

    async def body(robot: Ready) -> None:
        async def move(goal: ServerGoal) -> object:
            wanted.append(goal.request.command.position)
            stalled, reached = answers.pop(0)
            return {"stalled": stalled, "reached_goal": reached}

        robot.lab.backend.action_server(
            "gripper_controller/gripper_cmd", "control_msgs/action/GripperCommand", move
        )
        await robot.do("grasp", 0.01)
        assert await robot.reason("grasp", 0.02) == "nothing_grasped"
        await robot.do("release", 0.1)
        assert await robot.reason("release", 0.08) == "not_open"
        assert wanted == [0.01, 0.02, 0.1, 0.08]

    with_ready("gripper.yaml", body, None)


# ---- all of it


def test_the_mappings_that_come_with_the_package() -> None:
    assert shipped_mappings() == list(MAPPINGS)


@pytest.mark.parametrize("file", MAPPINGS)
def test_everything_has_a_test(file: str) -> None:
    if ("turtlebot2.yaml", "cliff") not in tried:
        pytest.skip("only some tests of this module were run")
    (part,) = ready(file).artifacts.values()
    names = {each.name for each in (*part.topics, *part.frames, *part.operations)}
    names |= {each.name for operation in part.operations for each in operation.feedback}
    assert {name for name in names if (file, name) not in tried} == set()
    assert all(each.description for each in part.operations if each.kind is not OperationKind.REFRESH)
