"""Suspended motions stop the robot and go on with what remained; motions of one robot exclude each other."""

import math
import random
from typing import Any

import pytest
from robot_lab import STANDSTILL, Lab, Watcher, assert_at, made

from jacaros.artifacts import ArtifactId, Structure
from jacaros.robots.artifacts.velocity import ArtCmdVel, ArtCmdVelMux, ArtCmdVelMuxAndOdometry

pytestmark = [pytest.mark.world("empty"), made(ArtCmdVel, recorded=True)]


async def test_a_drive_continues_with_the_remaining_distance(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    moving = await lab.begun(2, artifact, "moveForward", 2)
    begin = lab.clock.elapsed
    await moving.pause(0.001)
    assert lab.last_command == STANDSTILL
    assert lab.commands[-1][0] == begin
    await lab.sleep(10)
    assert lab.speed() == (0, 0)
    assert lab.pose()[0] < 1.5
    assert watcher.holds("moving") == [("paused",)]
    assert not moving.done.done()
    await moving.resumed()
    assert_at(lab, 2, 0, 0)
    assert watcher.holds("moving") == [("stopped",)]


async def test_a_turn_continues_with_the_remaining_angle(lab: Lab, artifact: ArtifactId) -> None:
    turning = lab.begin(artifact, "rotate", 270)
    for _ in range(3):
        await lab.sleep(1)
        await turning.pause(2)
        assert lab.speed() == (0, 0)
        turning.execution.resume()
    await turning.done
    assert_at(lab, 0, 0, -90)


async def test_a_pause_and_resume_in_the_same_moment_changes_nothing(lab: Lab, artifact: ArtifactId) -> None:
    moving = lab.begin(artifact, "moveForward", 1)
    for _ in range(5):
        await lab.sleep(0.33)
        moving.execution.pause()
        moving.execution.resume()
    await moving.done
    assert_at(lab, 1, 0, 0)


async def test_an_open_loop_motion_continues_with_the_remaining_time(lab: Lab, artifact: ArtifactId) -> None:
    moving = await lab.begun(1.05, artifact, "move", 19)
    await moving.pause(5)
    assert lab.speed() == (0, 0)
    await moving.resumed()
    assert len([1 for _, linear, _ in lab.commands if linear]) == 20


@pytest.mark.parametrize("when", [0.6, 2.0, 4.0, 5.5, 6.5, 7.5, 8.0, 8.5])
async def test_a_drive_to_a_pose_continues_from_wherever_the_robot_is(lab: Lab, when: float) -> None:
    artifact = await lab.make(ArtCmdVelMuxAndOdometry)
    other = await lab.make(ArtCmdVelMux)
    going = await lab.begun(when, artifact, "goTo", -1.5, 1, 90)
    assert not going.done.done()
    going.execution.pause()
    await lab.do(other, "goTo", 1, 1, 0)
    assert_at(lab, 1, 1, 0, metres=0.02)
    await going.resumed()
    assert going.ok
    assert_at(lab, -1.5, 1, 90, metres=0.02)


async def test_a_second_motion_waits_for_the_first_across_artifacts(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    first = await lab.make(ArtCmdVelMuxAndOdometry)
    a = await lab.begun(0.1, first, "moveForward", 1)
    b = lab.begin(artifact, "rotate", 90)
    c = await lab.begun(1, first, "moveForward", 1)
    assert watcher.holds("moving") == [("waiting",)]
    await a.done
    assert not b.done.done()
    await b.done
    assert_at(lab, 1, 0, 90)
    await c.done
    assert_at(lab, 1, 1, 90)


@pytest.mark.world("two_robots")
async def test_motions_of_different_robots_do_not_wait_for_each_other(lab: Lab) -> None:
    artifacts = [await lab.make(ArtCmdVel, name) for name in ("robot_0", "robot_1")]
    for each in [lab.begin(each, "moveForward", 0.5) for each in artifacts]:
        await each.done
    assert lab.clock.elapsed < 3
    assert lab.pose("robot_0")[0] == pytest.approx(-0.5, abs=0.01)
    assert lab.pose("robot_1")[0] == pytest.approx(0.5, abs=0.01)


@made(ArtCmdVelMuxAndOdometry)
async def test_recharging_in_the_middle_of_a_side_as_in_the_thesis_keeps_the_remaining_distance(
    lab: Lab, artifact: ArtifactId
) -> None:
    """Patrol with relative recharging (listing 23): others drive while the patrol's motion is suspended."""
    side = await lab.begun(2, artifact, "moveForward", 2)
    side.execution.pause()
    await lab.do(artifact, "moveForward", 1)
    away = lab.pose()
    for degrees in (90, 180, -90):
        await lab.do(artifact, "rotate", degrees)
        await lab.do(artifact, "moveForward", 1)
    await lab.do(artifact, "rotate", 180)
    assert lab.pose()[0] == pytest.approx(away[0] - 1, abs=0.02)
    await side.resumed()
    assert_at(lab, 2, 0, 0, metres=0.03, degrees=1)


async def test_what_remains_is_driven_from_where_the_robot_was_left(lab: Lab, artifact: ArtifactId) -> None:
    side = await lab.begun(2, artifact, "moveForward", 2)
    await side.pause(2)
    stood = lab.pose()[0]
    await lab.do(artifact, "rotate", 90)
    await side.resumed()
    assert_at(lab, stood, 2 - stood, 90)
    turn = await lab.begun(1, artifact, "rotate", 90)
    await turn.pause(2)
    await lab.do(artifact, "rotate", 200)
    await turn.resumed()
    left = math.degrees(math.remainder(math.radians(lab.pose()[2] - 180 - 200), math.tau))
    assert left == pytest.approx(0, abs=0.5)


async def test_a_resumed_motion_waits_until_the_robot_is_free(lab: Lab, artifact: ArtifactId) -> None:
    side = await lab.begun(1, artifact, "driveTo", 2, 0)
    await side.pause(2)
    other = await lab.begun(1, artifact, "goTo", 0, 1, 0)
    side.execution.resume()
    await lab.sleep(1)
    assert not side.done.done()
    await other.done
    assert_at(lab, 0, 1, 0, metres=0.02)
    await side.done
    assert lab.pose()[:2] == pytest.approx((2, 0), abs=0.02)


@pytest.mark.parametrize("end", ["suspended", "dropped"])
async def test_a_motion_that_is_suspended_or_dropped_while_it_waits_does_not_take_the_robot(
    lab: Lab, artifact: ArtifactId, end: str
) -> None:
    first = await lab.begun(0.1, artifact, "moveForward", 0.5)
    second = lab.begin(artifact, "rotate", 90)
    third = await lab.begun(0.1, artifact, "moveForward", 0.5)
    (second.execution.pause if end == "suspended" else second.execution.cancel)()
    await first.done
    await third.done
    assert_at(lab, 1, 0, 0)
    if end == "suspended":
        await second.resumed()
        assert_at(lab, 1, 0, 90)


async def test_a_motion_waits_until_the_previous_one_has_stopped(lab: Lab, artifact: ArtifactId) -> None:
    side = await lab.begun(2, artifact, "moveForward", 2)
    side.execution.pause()
    await lab.do(artifact, "rotate", 180)
    assert lab.pose()[1] == pytest.approx(0, abs=0.005)
    await lab.do(artifact, "rotate", 180)
    await side.resumed()
    assert_at(lab, 2, 0, 0)


async def test_dropping_a_suspended_motion_leaves_the_robot_to_the_others(
    lab: Lab, artifact: ArtifactId
) -> None:
    side = await lab.begun(2, artifact, "moveForward", 2)
    await side.pause(2)
    other = await lab.begun(0.7, artifact, "moveReverse", lab.pose()[0])
    commands = len(lab.commands)
    await side.drop(0.001)
    assert all(command[1:] != STANDSTILL for command in lab.commands[commands:])
    await other.done
    assert_at(lab, 0, 0, 0)


async def test_abort_ends_the_waiting_motions_too_but_not_the_suspended_ones(
    lab: Lab, artifact: ArtifactId
) -> None:
    mux = await lab.make(ArtCmdVelMux)
    suspended = await lab.begun(1, artifact, "moveForward", 2)
    await suspended.pause(2)
    driving = await lab.begun(0.5, artifact, "rotate", 180)
    waiting = await lab.begun(0.5, mux, "moveForward", 1)
    await lab.do(mux, "abortMoving")
    await driving.done
    await waiting.done
    assert driving.reason.startswith("aborted(")
    assert waiting.reason == "aborted(0)"
    await lab.do(artifact, "turnTo", 0)
    await suspended.resumed()
    assert_at(lab, 2, 0, 0)


async def test_suspending_before_a_motion_begins_keeps_it_from_driving(
    lab: Lab, artifact: ArtifactId
) -> None:
    side = lab.begin(artifact, "moveForward", 0.5)
    await side.pause(3)
    assert all(command[1:] == STANDSTILL for command in lab.commands)
    await side.resumed()
    assert_at(lab, 0.5, 0, 0)


@pytest.mark.parametrize("seed", range(8))
async def test_any_mixture_of_pauses_ends_at_the_goal(lab: Lab, seed: int) -> None:
    chance = random.Random(seed)
    artifact: Any = await lab.make(ArtCmdVelMuxAndOdometry, Structure("speed", (0.4,)))
    for corner in [(1, 0, 90), (1, 1, 180), (0, 1, -90), (0, 0, 0)]:
        for operation in (("moveForward", 1), ("rotate", 90)):
            started = lab.begin(artifact, *operation)
            for _ in range(chance.randint(0, 6)):
                await lab.sleep(chance.uniform(0, 1.2))
                (started.execution.pause if chance.random() < 0.5 else started.execution.resume)()
            await started.resumed()
        assert_at(lab, *corner, metres=0.03, degrees=1)
