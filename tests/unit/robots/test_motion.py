"""Motions end where they should, and every end of a motion stops the robot."""

import math
from itertools import pairwise

import pytest
from robot_lab import STANDSTILL, Lab, Run, Watcher, apart, assert_at, made

from jacaros.artifacts import ArtifactId, OperationFailed, Out, Structure
from jacaros.robots.artifacts.velocity import (
    ArtCmdVel,
    ArtCmdVelAndOdometry,
    ArtCmdVelMux,
    ArtCmdVelMuxAndOdometry,
    ArtVelocity,
)
from jacaros.robots.ros.node import Sample

pytestmark = [pytest.mark.world("empty"), made(ArtCmdVel, recorded=True)]

# Accuracy.


async def test_four_rounds_of_a_square_stay_on_the_square(lab: Lab) -> None:
    """Defect 2 of the original: its loop counted the difference in x, and never ended beside +x."""
    artifact = await lab.make(ArtCmdVelMuxAndOdometry)
    corners = [(1, 0, 90), (1, 1, 180), (0, 1, -90), (0, 0, 0)]
    for round_ in range(1, 5):
        for corner in corners:
            await lab.do(artifact, "moveForward", 1)
            await lab.do(artifact, "rotate", 90)
            assert_at(lab, *corner, metres=0.01 * round_, degrees=0.3 * round_)


async def test_out_and_back_by_time_comes_back(lab: Lab, artifact: ArtifactId) -> None:
    """The thesis's scenario 8.2.1: two times ``move(25); rotate(180)``."""
    farthest = 0.0
    for _ in range(2):
        await lab.do(artifact, "move", 25)
        farthest = max(farthest, lab.pose()[0])
        await lab.do(artifact, "rotate", 180)
    assert 1.0 < farthest < 2.5
    assert_at(lab, 0, 0, 0, metres=0.05, degrees=3)


@pytest.mark.parametrize("degrees", [5, 45, 90, 180, 270, 360, 720, -5, -90, -180, -360])
async def test_a_turn_is_signed_and_may_be_more_than_half_a_circle(lab: Lab, degrees: float) -> None:
    """Defect 3: open-loop turns, and a negative angle that reversed all later motions."""
    lab.record("/cmd_vel")
    artifact = await lab.make(ArtCmdVel)
    await lab.do(artifact, "rotate", degrees)
    assert_at(lab, 0, 0, degrees)
    sides = {math.copysign(1, angular) for _, _, angular in lab.commands if abs(angular) > 0.1}
    assert sides == {math.copysign(1, degrees)}
    turned = sum(angular * 0.05 for _, _, angular in lab.commands)
    assert math.degrees(turned) == pytest.approx(degrees, rel=0.15, abs=2)
    await lab.do(artifact, "rotate", -degrees)
    await lab.do(artifact, "moveForward", 0.3)
    assert_at(lab, 0.3, 0, 0)


async def test_left_and_right_and_reverse_have_operations_of_their_own(lab: Lab) -> None:
    artifact = await lab.make(ArtCmdVel)
    await lab.do(artifact, "rotateLeft", 60)
    assert_at(lab, 0, 0, 60)
    await lab.do(artifact, "rotateRight", 60)
    await lab.do(artifact, "moveReverse", 0.5)
    assert_at(lab, -0.5, 0, 0)
    await lab.do(artifact, "moveForward", -0.5)
    assert_at(lab, -1, 0, 0)
    await lab.do(artifact, "rotateLeft")
    await lab.do(artifact, "rotateRight")
    await lab.do(artifact, "moveForward")
    await lab.do(artifact, "moveReverse")
    await lab.do(artifact, "rotate", 0)
    assert_at(lab, -1, 0, 0, metres=0.05)


async def test_driving_to_poses_ends_at_the_poses(lab: Lab) -> None:
    artifact = await lab.make(ArtCmdVelMuxAndOdometry)
    poses = [(2, 0, 90), (2, 2, 180), (1, 1, 0), (1.02, 1, -30), (-2, 1.5, 179), (0, 0, -179)]
    for x, y, heading in poses:
        await lab.do(artifact, "goTo", x, y, heading)
        assert_at(lab, x, y, heading, metres=0.02, degrees=0.5)
    await lab.do(artifact, "driveTo", 0.5, 0.5)
    assert apart(lab.pose(), (0.5, 0.5, lab.pose()[2]))[0] < 0.02
    await lab.do(artifact, "turnTo", -90)
    assert apart(lab.pose(), (0.5, 0.5, -90))[1] < 0.5
    await lab.do(artifact, "driveToPose", 0, 0, 0)
    assert_at(lab, 0, 0, 0, metres=0.02)


async def test_a_disturbed_heading_is_corrected_while_driving(lab: Lab) -> None:
    artifact = await lab.make(ArtCmdVel, Structure("speed", (0.3,)))
    driving = await lab.begun(2, artifact, "moveForward", 2)
    robot = lab.world.robot()
    robot.yaw += 0.2
    robot.odometry.yaw += 0.2
    await driving.done
    assert_at(lab, 2, 0, 0, metres=0.01, degrees=2)


NOISY = """
bounds: {from: [-5, -5], to: [5, 5]}
robots: [{name: r, odometry: {noise_per_metre: 0.02, noise_degrees_per_turn: 2, noise_degrees_per_metre: 1}}]
"""


@pytest.mark.world(NOISY)
async def test_noise_of_odometry_does_not_keep_a_motion_from_ending(lab: Lab, artifact: ArtifactId) -> None:
    for _ in range(4):
        await lab.do(artifact, "moveForward", 1)
        await lab.do(artifact, "rotate", 90)
    assert_at(lab, 0, 0, 0, metres=0.2, degrees=15)


# Commands.


@pytest.mark.parametrize(
    ("kind", "topic"),
    [
        (ArtCmdVel, "/cmd_vel"),
        (ArtCmdVelAndOdometry, "/cmd_vel"),
        (ArtCmdVelMux, "/cmd_vel_mux/input/navi"),
        (ArtCmdVelMuxAndOdometry, "/cmd_vel_mux/input/navi"),
        (ArtVelocity, "/mobile_base/commands/velocity"),
    ],
)
async def test_each_artifact_drives_on_its_topic(lab: Lab, kind: type[ArtCmdVel], topic: str) -> None:
    lab.record(topic)
    artifact = await lab.make(kind)
    assert lab.commands == []
    await lab.do(artifact, "moveForward", 0.3)
    assert lab.commands
    assert lab.last_command == STANDSTILL


@pytest.mark.world("two_robots")
async def test_a_number_among_the_arguments_is_the_speed(lab: Lab) -> None:
    """``makeArtifact("Velocity", "ArtVelocity", [1], Id)``, and ``[robot_0, 0.3]`` as the original's agents write it."""
    lab.record("/robot_0/cmd_vel_mux/input/navi")
    artifact = await lab.make(ArtCmdVelMux, "robot_0", 0.3)
    await lab.do(artifact, "move", 5)
    assert max(linear for _, linear, _ in lab.commands) == pytest.approx(0.3)
    with pytest.raises(OperationFailed, match="a number above zero"):
        await lab.make(ArtVelocity, -1)


@pytest.mark.parametrize("count", [6, -6])
async def test_rotate_d_turns_by_time_for_half_seconds(lab: Lab, count: int) -> None:
    lab.record("/cmd_vel_mux/input/navi")
    artifact = await lab.make(ArtCmdVelMuxAndOdometry)
    await lab.do(artifact, "rotateD", count)
    turning = [angular for _, linear, angular in lab.commands if angular]
    assert turning == [math.copysign(0.5, count)] * 30
    assert lab.last_command == STANDSTILL
    await lab.sleep(1)
    assert_at(lab, 0, 0, math.degrees(0.25 * count), degrees=4)


async def test_move_commands_n_plus_one_times_ten_a_second_and_then_stops(lab: Lab) -> None:
    lab.record()
    artifact = await lab.make(ArtCmdVel)
    await lab.do(artifact, "move", 25)
    driving = [time for time, linear, _ in lab.commands if linear]
    assert len(driving) == 26
    assert {round(b - a, 6) for a, b in pairwise(driving)} == {0.1}
    assert lab.commands[26][0] - driving[0] == pytest.approx(2.6)
    assert {command[1:] for command in lab.commands[26:]} == {STANDSTILL}


async def test_commands_obey_the_limits_and_never_pause_longer_than_the_base_allows(lab: Lab) -> None:
    lab.record()
    artifact = await lab.make(ArtCmdVel, Structure("speed", (5,)), Structure("turn_speed", (999,)))
    await lab.do(artifact, "moveForward", 2)
    await lab.do(artifact, "rotate", 360)
    assert max(linear for _, linear, _ in lab.commands) == pytest.approx(0.65)
    assert max(angular for _, _, angular in lab.commands) <= math.pi
    times = [time for time, _, _ in lab.commands]
    assert max(b - a for a, b in pairwise(times)) <= 0.2
    assert [event.kind for event in lab.world.log] == []


@made(ArtCmdVel, Structure("speed", (0.25,)), {"turn_speed": 30}, recorded=True)
async def test_the_cruise_speed_is_an_option(lab: Lab, artifact: ArtifactId) -> None:
    await lab.do(artifact, "moveForward", 1)
    await lab.do(artifact, "rotate", 90)
    assert max(linear for _, linear, _ in lab.commands) == pytest.approx(0.25)
    assert max(angular for _, _, angular in lab.commands) == pytest.approx(math.radians(30))


# Ends.


@made(ArtCmdVelMuxAndOdometry)
async def test_abort_interrupts_immediately_and_reports_the_covered_distance(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    """Defect 1: abortMoving waited until the motion was over; defect 5: so did every other operation."""
    lab.record("/cmd_vel_mux/input/navi")
    moving = await lab.begun(2, artifact, "moveForward", 2)
    before, begin = lab.pose()[0], lab.clock.elapsed
    await lab.do(artifact, "getCurrentOdom")
    await lab.do(artifact, "abortMoving")
    await moving.done
    assert lab.clock.elapsed == begin
    assert float(moving.reason[8:-1]) == pytest.approx(before, abs=0.05)
    await lab.sleep(1)
    assert lab.last_command == STANDSTILL
    assert lab.commands[-1][0] - begin < 0.001
    assert watcher.holds("moving") == [("stopped",)]
    assert lab.pose()[0] < before + 0.3


def amount(run: Run, functor: str) -> object:
    """The argument of a failure reason."""
    assert run.outcome is not None
    reason = run.outcome.reason
    assert isinstance(reason, Structure)
    assert reason.functor == functor
    return reason.arguments[0]


async def test_abort_reports_degrees_of_a_turn_and_is_harmless_without_a_motion(
    lab: Lab, artifact: ArtifactId
) -> None:
    await lab.do(artifact, "abortMoving")
    turning = await lab.begun(1.5, artifact, "rotate", -180)
    heading = lab.pose()[2]
    await lab.do(artifact, "abortMoving")
    await turning.done
    assert amount(turning, "aborted") == pytest.approx(-heading, abs=5)
    await lab.do(artifact, "moveForward", 0.2)


async def test_dropping_a_motion_stops_the_robot_without_an_outcome(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    moving = await lab.begun(1.5, artifact, "moveForward", 2)
    begin = lab.clock.elapsed
    await moving.drop(2)
    assert not moving.done.done()
    assert lab.last_command == STANDSTILL
    assert lab.commands[-1][0] == pytest.approx(begin)
    assert lab.speed() == (0, 0)
    assert watcher.holds("moving") == [("stopped",)]
    await lab.do(artifact, "rotate", 10)


async def test_disposing_the_artifact_stops_the_robot(lab: Lab, artifact: ArtifactId) -> None:
    moving = await lab.begun(1.5, artifact, "moveForward", 2)
    lab.workspace.dispose_artifact(artifact)
    await moving.done
    assert not moving.ok
    await lab.sleep(1)
    assert lab.last_command == STANDSTILL
    await lab.do(await lab.make(ArtCmdVel), "rotate", 10)


@pytest.mark.parametrize("drives", [True, False])
async def test_the_end_of_the_process_stops_the_robot_unless_it_stands(
    lab: Lab, artifact: ArtifactId, drives: bool
) -> None:
    """The backend runs its exit hooks at signals and at the end; closing it does the same."""
    if drives:
        await lab.begun(1.5, artifact, "moveForward", 2)
        assert lab.last_command != STANDSTILL
    lab.backend.lifetime.stop()  # type: ignore[attr-defined]  # of the memory backend
    await lab.sleep(0.01)
    assert lab.last_command == STANDSTILL if drives else lab.commands == []


WALL = "bounds: {from: [-1, -1], to: [1, 1]}\nborder: walls\nrobots: [{name: turtlebot}]\n"


@pytest.mark.world(WALL)
async def test_a_motion_against_a_wall_fails_as_blocked(lab: Lab, artifact: ArtifactId) -> None:
    blocked = await lab.call(artifact, "moveForward", 2)
    assert amount(blocked, "blocked") == pytest.approx(lab.pose()[0], abs=0.02)
    assert lab.clock.elapsed < 8
    await lab.sleep(0.1)
    assert lab.last_command == STANDSTILL
    await lab.do(artifact, "moveReverse", 0.5)


@pytest.mark.world(None)
@made(ArtCmdVel, Structure("odometry_timeout", (3,)), recorded=True)
async def test_without_odometry_a_motion_fails_and_never_drives(lab: Lab, artifact: ArtifactId) -> None:
    failed = await lab.call(artifact, "moveForward", 1)
    assert failed.reason == "no_odometry(3)"
    assert lab.clock.elapsed == pytest.approx(3, abs=0.2)
    assert {command[1:] for command in lab.commands} == {STANDSTILL}


class Relay:
    """Passes odometry on, while it is on."""

    def __init__(self, lab: Lab) -> None:
        self.on = True
        self.publisher = lab.backend.publisher("/relayed", "nav_msgs/msg/Odometry")
        lab.backend.subscription("/odom", "nav_msgs/msg/Odometry", self.take)

    def take(self, sample: Sample) -> None:
        if self.on:
            self.publisher.publish(sample.message)


async def test_the_robot_stands_while_odometry_is_lost_and_then_continues(lab: Lab) -> None:
    lab.record()
    relay = Relay(lab)
    artifact = await lab.make(ArtCmdVel, Structure("odometry_topic", ("relayed",)))
    moving = await lab.begun(1.5, artifact, "moveForward", 2)
    relay.on = False
    await lab.sleep(2)
    assert lab.last_command == STANDSTILL
    assert lab.speed() == (0, 0)
    relay.on = True
    await moving.done
    assert_at(lab, 2, 0, 0)
    moving = await lab.begun(1.5, artifact, "moveReverse", 2)
    relay.on = False
    await moving.done
    assert moving.reason == "no_odometry(5)"
    assert lab.speed() == (0, 0)


@made(ArtCmdVel, Structure("timeout", (2,)))
async def test_a_motion_that_takes_too_long_fails(lab: Lab, artifact: ArtifactId) -> None:
    assert (await lab.call(artifact, "moveForward", 2.5)).reason == "timeout(2)"
    await lab.sleep(1)
    assert lab.speed() == (0, 0)


async def test_nonsense_numbers_are_refused(lab: Lab, artifact: ArtifactId) -> None:
    nonsense = [("moveForward", (math.inf,)), ("rotate", (math.nan,)), ("goTo", (0, math.nan, 0))]
    for operation, arguments in nonsense:
        assert (await lab.call(artifact, operation, *arguments)).reason.startswith("wrong_number(")
    assert not (await lab.call(artifact, "moveForward", "far")).ok


# Odometry of the moving artifacts.


async def test_current_pose_and_odometry_are_shown_on_request_only(lab: Lab) -> None:
    artifact = await lab.make(ArtCmdVelAndOdometry)
    watcher = lab.watch(artifact)
    await lab.do(artifact, "moveForward", 0.5)
    await lab.do(artifact, "rotate", 90)
    assert watcher.values("odom_cmd_vel") == [(0, 0, 0)]
    await lab.do(artifact, "getCurrentOdom")
    x, y, z = watcher.values("odom_cmd_vel")[-1]
    assert (x, y, z) == pytest.approx((0.5, 0, 0), abs=0.01)
    outs = Out(), Out(), Out()
    await lab.do(artifact, "getCurrentPose", *outs)
    assert [out.value for out in outs] == pytest.approx([0.5, 0, 90], abs=0.5)


async def test_odometry_of_a_moving_artifact_can_be_verbose(lab: Lab) -> None:
    artifact = await lab.make(ArtCmdVelMuxAndOdometry, Structure("mode", ("verbose",)))
    watcher = lab.watch(artifact)
    await lab.do(artifact, "moveForward", 0.5)
    assert len(watcher.values("odom_cmd_vel_mux")) > 10


@pytest.mark.world("two_robots")
async def test_a_robot_name_prefixes_topics_and_properties_and_a_namespace_topics_alone(lab: Lab) -> None:
    lab.record("/robot_1/cmd_vel")
    named = await lab.make(ArtCmdVelAndOdometry, "robot_0")
    spaced = await lab.make(ArtCmdVelAndOdometry, Structure("namespace", ("robot_1",)))
    names = {p.name for p in lab.workspace.properties(named)}
    assert names == {"robot_0_odom_cmd_vel", "robot_0_moving"}
    assert {p.name for p in lab.workspace.properties(spaced)} == {"odom_cmd_vel", "moving"}
    await lab.do(named, "moveForward", 0.5)
    assert lab.commands == []
    assert lab.pose("robot_0")[0] == pytest.approx(-0.5, abs=0.01)
    await lab.do(spaced, "moveForward", 0.5)
    assert lab.commands
    assert lab.pose("robot_1")[0] == pytest.approx(0.5, abs=0.01)


async def test_an_invalid_speed_makes_creation_fail(lab: Lab) -> None:
    with pytest.raises(OperationFailed, match="speed"):
        await lab.make(ArtCmdVel, Structure("speed", (-1,)))
