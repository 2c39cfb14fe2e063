"""A robot that was not watched for a while: it stands until new odometry arrives, and its agent is notified."""

from typing import Any

import pytest
from robot_lab import STANDSTILL, Lab, Watcher, assert_at, made

from jacaros.artifacts import ArtifactId
from jacaros.artifacts.env.values import Structure
from jacaros.robots.artifacts.driving import GUARD_TRIPPED
from jacaros.robots.artifacts.velocity import ArtCmdVel
from jacaros.robots.ros.drivers.memory.graph import delayed, dropped
from jacaros.robots.ros.guarded import guarded_by
from jacaros.runtime.clock import VirtualClock

pytestmark = [pytest.mark.world("empty"), made(ArtCmdVel, recorded=True)]

A_SECOND = 1000 * VirtualClock.CYCLES_PER_MILLISECOND
"""Cycles of agents that move the virtual clock by a second, while nothing else has a turn."""


def freeze(lab: Lab, seconds: int) -> None:
    """The process gets no turn for so long."""
    lab.clock.busy(seconds * A_SECOND)


def disturb(lab: Lab, disturbance: Any) -> Any:
    backend: Any = lab.backend
    return backend.graph.disturb("/odom", disturbance)


async def test_a_motion_by_odometry_continues_after_a_freeze_and_arrives(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    moving = await lab.begun(2, artifact, "moveForward", 3)
    freeze(lab, 6)
    await moving.done
    assert moving.ok
    [(name, (why,))] = watcher.signals
    assert name == "motion_interrupted"
    assert isinstance(why, Structure)
    assert why.functor == "delayed"
    first = next(command for time, *command in lab.commands if time > 7.9)
    assert tuple(first) == STANDSTILL
    assert_at(lab, 3, 0, 0)


async def test_old_odometry_that_arrives_after_a_freeze_moves_nothing(lab: Lab, artifact: ArtifactId) -> None:
    moving = await lab.begun(2, artifact, "moveForward", 3)
    stop = disturb(lab, delayed(3.0))
    freeze(lab, 1)
    await lab.sleep(2)
    assert {tuple(command) for time, *command in lab.commands if time > 2.9} == {STANDSTILL}
    stop()
    moving.execution.cancel()


async def test_turns_that_come_late_make_a_motion_by_time_alone_no_longer(lab: Lab) -> None:
    lab.record()
    artifact = await lab.make(ArtCmdVel)
    moving = lab.begin(artifact, "move", 25)
    for _ in range(10):
        await lab.sleep(0.15)
        lab.clock.busy(A_SECOND // 15)
    await moving.done
    drives = [time for time, *command in lab.commands if tuple(command) != STANDSTILL]
    assert len(drives) == 26
    assert drives[-1] - drives[0] == pytest.approx(2.5, abs=0.01)


async def test_a_motion_by_time_alone_fails_after_a_freeze(lab: Lab, artifact: ArtifactId) -> None:
    moving = await lab.begun(2, artifact, "move", 100)
    freeze(lab, 2)
    await moving.done
    assert moving.reason.startswith("interrupted(")
    assert lab.last_command == STANDSTILL


async def test_a_motion_by_time_alone_fails_when_the_robot_falls_silent(lab: Lab) -> None:
    artifact = await lab.make(ArtCmdVel)
    moving = await lab.begun(2, artifact, "move", 100)
    disturb(lab, dropped())
    await moving.done
    assert moving.reason.startswith("interrupted(")
    assert lab.clock.elapsed < 2.8


async def test_an_agent_is_notified_of_missing_odometry(lab: Lab) -> None:
    artifact = await lab.make(ArtCmdVel)
    watcher = lab.watch(artifact)
    moving = await lab.begun(2, artifact, "moveForward", 3)
    back = disturb(lab, dropped())
    await lab.sleep(2)
    back()
    await moving.done
    assert moving.ok
    [(name, (why,))] = watcher.signals
    assert (name, getattr(why, "functor", "")) == ("motion_interrupted", "no_odometry")
    assert_at(lab, 3, 0, 0)


async def test_a_motion_does_not_continue_where_odometry_was_reset(lab: Lab, artifact: ArtifactId) -> None:
    """The robot was started anew: its places have another meaning."""
    moving = await lab.begun(4, artifact, "driveTo", 5, 0)
    back = disturb(lab, dropped())
    await lab.sleep(2)
    lab.world.robot().odometry.x = 0.0
    back()
    await moving.done
    assert moving.reason.startswith("interrupted(")
    assert lab.speed() == STANDSTILL


async def test_a_guard_that_has_stopped_the_robot_interrupts_its_motions(
    lab: Lab, artifact: ArtifactId, watcher: Watcher
) -> None:
    moving = await lab.begun(1, artifact, "moveForward", 2)
    guarded_by(lab.backend).interrupt()
    await lab.sleep(0)
    assert lab.last_command == STANDSTILL
    await moving.done
    assert moving.ok
    assert watcher.signals == [("motion_interrupted", (GUARD_TRIPPED,))]
    assert_at(lab, 2, 0, 0)


async def test_an_artifact_names_what_it_drives_until_it_is_disposed(lab: Lab) -> None:
    guarded = guarded_by(lab.backend)
    artifact = await lab.make(ArtCmdVel, "robot_1")
    assert guarded.topics == [("/robot_1/cmd_vel", "geometry_msgs/msg/Twist")]
    lab.workspace.dispose_artifact(artifact)
    await lab.sleep(0)
    assert guarded.topics == []
