"""A clock that is set back while a robot drives and while agents, operations and deadlines wait."""

import asyncio
from collections.abc import Callable
from typing import Any

from faults_lab import Lab, in_lab

from jacaros.runtime.clock import VIRTUAL_EPOCH


async def never(request: Any) -> Any:
    await asyncio.Event().wait()


def gripper_that_never_answers(lab: Lab) -> None:
    lab.node("gripper").service("/open_gripper", "std_srvs/srv/Trigger", never)


def simulator_is_reset(to: float) -> Callable[[Lab], None]:
    def faults(lab: Lab) -> None:
        gripper_that_never_answers(lab)
        clock: Any = lab.robot_clock
        lab.at(2, lambda: clock.reset(to))
        lab.at(10, lab.kill_robot)

    return faults


def test_all_waits_resume_with_their_remaining_time_and_the_robot_arrives() -> None:
    lab = in_lab("waiting.asl", simulator_is_reset(0), mapping="robot.yaml", simulated=1000, seconds=14)
    assert [line for line in lab.lines if not line.startswith("bad")] == [
        *("connected /odom", "connected /odom", "the clock jumped back by 1002 s", "service_timeout(3)"),
        *("arrived", "half empty", "wait_timeout", "waited", "lost /odom", "lost /odom"),
    ]
    for line, seconds in (
        ("service_timeout", 3),
        ("half", 5),
        ("wait_timeout", 7),
        ("waited", 8),
        ("lost", 10),
    ):
        assert seconds <= lab.when(line) <= seconds + 1.1, line
    bad = [line.split("(")[0] for line in lab.lines if line.startswith("bad")]
    assert bad == ["bad /odom out_of_order"] * 2 + ["bad /odom clock_jumped"] * 2, (
        "the wheels, and the mapping"
    )
    assert (lab.place, lab.safe) == ((2, 0), True)
    told = [line for line in lab.errors if line.startswith("[ros] /clock jumped back by")]
    assert len(told) == 1
    assert len(lab.errors) <= 9, lab.errors


def test_a_clock_that_is_set_back_a_little_changes_nothing() -> None:
    lab = in_lab("waiting.asl", simulator_is_reset(1001.5), mapping="robot.yaml", simulated=1000, seconds=14)
    lines = [line for line in lab.lines if not line.startswith("bad")]
    assert "service_timeout(3)" in lines
    assert "arrived" in lines
    assert (lab.place, lab.safe) == ((2, 0), True)


def test_a_robot_whose_clock_is_set_back_continues_to_drive() -> None:
    """The clock of the robot alone, as when it finds a time server after the start."""

    def faults(lab: Lab) -> None:
        clock: Any = lab.robot_clock
        lab.at(2, lambda: clock.reset(VIRTUAL_EPOCH - 5))

    lab = in_lab("driving.asl", faults, simulated=VIRTUAL_EPOCH, followed=False)
    assert [line.split("(")[0] for line in lab.lines] == [
        "connected /odom",
        "bad /odom out_of_order",
        "bad /odom clock_jumped",
        "at 2 0",
        "at 0 0",
    ]
    assert (lab.exit_code, lab.place, lab.safe) == (0, (0, 0), True)
