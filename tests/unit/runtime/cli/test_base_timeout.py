"""`jacaros ros check --base-timeout`: what a base does when commands cease, and that the robot is stopped at the end."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

from jacaros.robots.ros.node import Sample
from jacaros.runtime.cli.graph.base_timeout import GUARDED, SPEED, WATCHED, Ceased, Drive, find_base, verdict
from jacaros.runtime.cli.graph.joining import Joined, NothingThere, clock_for, joined
from jacaros.runtime.cli.main import call
from jacaros.runtime.clock import run
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.options import RunOptions

TWIST = "geometry_msgs/msg/Twist"
HALL = "size: [8, 8]\nrobots:\n"
STUBBORN = "  - {name: robot, pose: {x: 4, y: 4}, limits: {command_timeout: 600}}\n"
SLOW = "  - {name: robot, pose: {x: 4, y: 4}, limits: {command_timeout: 1.5}}\n"


class Lab:
    """The graph of a world, and every velocity and odometry in it."""

    def __init__(self, there: Joined) -> None:
        self.there = there
        self.commands: list[float] = []
        self.speed = 0.0
        there.backend.subscription("/cmd_vel", TWIST, self._command)
        there.backend.subscription("/odom", "nav_msgs/msg/Odometry", self._odometry)

    def _command(self, sample: Sample) -> None:
        self.commands.append(sample.message.linear.x)

    def _odometry(self, sample: Sample) -> None:
        self.speed = sample.message.twist.twist.linear.x

    def drive(self) -> Drive:
        return Drive(self.there, *find_base(self.there, set(), ""))


def in_world(world: str | Path, body: Callable[[Lab], Awaitable[Any]], namespace: str = "") -> Lab:
    options = RunOptions(world=world, namespace=namespace)
    clock = clock_for(options)
    labs: list[Lab] = []

    async def main() -> None:
        async with joined(options, clock, 5.0) as there:
            labs.append(Lab(there))
            await body(labs[0])

    run(main, clock)
    return labs[0]


@pytest.fixture
def hall(tmp_path: Path) -> Callable[[str], Path]:
    """Writes a world with these robots."""

    def write(robots: str) -> Path:
        (tmp_path / "hall.yaml").write_text(HALL + robots, encoding="utf-8")
        return tmp_path / "hall.yaml"

    return write


def test_a_base_with_a_timeout_stops_by_itself(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["ros", "check", "--base-timeout", "--world", "house"]) == 0
    output = capsys.readouterr().out
    assert "driving with `/cmd_vel`, watching `/odom`" in output
    assert "the base stood 0.5" in output


def test_a_base_without_a_timeout_is_an_error_and_is_stopped(hall: Callable[[str], Path]) -> None:
    ceased: list[Ceased] = []

    async def body(lab: Lab) -> None:
        ceased.append(await lab.drive().run())

    lab = in_world(hall(STUBBORN), body)
    assert ceased[0].seconds is None
    assert ceased[0].metres == pytest.approx(SPEED * WATCHED, rel=0.1)
    assert set(lab.commands) == {SPEED, 0.0}
    assert lab.commands[-3:] == [0.0] * 3
    assert lab.speed == 0.0


def test_the_exit_code_is_1_if_the_base_keeps_driving(hall: Callable[[str], Path], capsys):
    assert call(["ros", "check", "--base-timeout", "--world", str(hall(STUBBORN))]) == 1
    output = capsys.readouterr().out
    assert "error: the base was still driving 3 s after the last command" in output
    assert "start `jacaros guard` on the robot's computer" in output


def test_a_mapping_file_is_checked_too_and_names_the_topics(tmp_path, capsys):
    file = tmp_path / "robot.yaml"
    file.write_text(
        "properties:\n  pose: {topic: robot_1/odom}\n"
        "operations:\n  drive: {parameters: [v], publish: robot_1/cmd_vel, type: geometry_msgs/msg/Twist,"
        " fields: {linear.x: $v}}\n",
        encoding="utf-8",
    )
    assert call(["ros", "check", str(file), "--base-timeout", "--world", "two_robots"]) == 0
    output = capsys.readouterr().out
    assert f"{file} matches this graph\ndriving with `/robot_1/cmd_vel`, watching `/robot_1/odom`" in output


def test_a_slow_timeout_is_measured_and_a_guard_is_recommended(hall: Callable[[str], Path]) -> None:
    ceased: list[Ceased] = []

    async def body(lab: Lab) -> None:
        ceased.append(await lab.drive().run())

    in_world(hall(SLOW), body)
    assert ceased[0].seconds == pytest.approx(1.5, abs=0.15)
    assert ceased[0].metres == pytest.approx(1.5 * SPEED, abs=0.01)
    assert f"`jacaros guard` on the robot's computer stops it within {GUARDED:g} s" in verdict(ceased[0])


def test_an_interrupted_drive_stops_the_robot(hall: Callable[[str], Path]) -> None:
    async def body(lab: Lab) -> None:
        task = asyncio.ensure_future(lab.drive().run())
        while lab.speed < SPEED / 2:
            await lab.there.clock.sleep(0.05)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    lab = in_world(hall(STUBBORN), body)
    assert lab.commands[-3:] == [0.0] * 3
    assert lab.speed == 0.0


def test_the_end_of_the_process_stops_the_robot(hall: Callable[[str], Path]) -> None:
    async def body(lab: Lab) -> None:
        task = asyncio.ensure_future(lab.drive().run())
        while lab.speed < SPEED / 2:
            await lab.there.clock.sleep(0.05)
        lab.there.backend.lifetime.stop()  # type: ignore[attr-defined]  # as a signal does
        await lab.there.clock.sleep(0.1)
        task.cancel()
        with pytest.raises(asyncio.CancelledError):
            await task

    assert in_world(hall(STUBBORN), body).commands[-1] == 0.0


def test_a_robot_that_moves_already_is_not_driven(hall: Callable[[str], Path]) -> None:
    async def body(lab: Lab) -> None:
        pusher = lab.there.backend.publisher("/cmd_vel", TWIST)
        pusher.publish({"linear": {"x": 0.2}})
        await lab.there.clock.sleep(1.0)
        with pytest.raises(NothingThere, match="already moving"):
            await lab.drive().run()

    assert SPEED not in in_world(hall(STUBBORN), body).commands


def test_a_robot_that_does_not_move_is_reported_and_stopped(hall: Callable[[str], Path]) -> None:
    async def body(lab: Lab) -> None:
        # The robot obeys other commands, ten times as often.
        pusher = lab.there.backend.publisher("/cmd_vel", TWIST)

        async def push() -> None:
            while True:
                pusher.publish({})
                await lab.there.clock.sleep(0.01)

        pushing = asyncio.ensure_future(push())
        with pytest.raises(NothingThere, match="odometry shows no motion"):
            await lab.drive().run()
        pushing.cancel()

    assert in_world(hall(STUBBORN), body).commands[-1] == 0.0


def test_one_of_several_robots_must_be_named(hall: Callable[[str], Path]) -> None:
    robots = "".join(
        f"  - {{name: robot_{number}, namespace: robot_{number}, pose: {{x: {2 * number}, y: 4}}}}\n"
        for number in (1, 2)
    )

    async def body(lab: Lab) -> None:
        with pytest.raises(UsageError) as wrong:
            find_base(lab.there, set(), "")
        assert "found `/robot_1/cmd_vel`, `/robot_2/cmd_vel`" in str(wrong.value)
        assert "select it with --namespace" in str(wrong.value)
        named, _ = find_base(lab.there, {"/robot_2/cmd_vel", "/robot_2/odom"}, "")
        assert named.name == "/robot_2/cmd_vel"

    in_world(hall(robots), body)


def test_a_robot_of_another_namespace_is_never_driven(hall: Callable[[str], Path]) -> None:
    async def body(lab: Lab) -> None:
        with pytest.raises(UsageError, match="no topic `/robot_2/cmd_vel`"):
            find_base(lab.there, set(), "robot_2")

    in_world(hall(STUBBORN), body, "robot_2")


@pytest.mark.parametrize("kind", ["ros1", "ros2", "rosbridge"])
def test_a_real_robot_is_not_driven_without_consent(kind: str, capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["ros", "check", "--base-timeout", "--ros", kind]) == 2
    assert "help: check that the way is free, and add --yes" in capsys.readouterr().err


def test_a_file_or_the_drive_must_be_asked_for(capsys: pytest.CaptureFixture[str]) -> None:
    assert call(["ros", "check"]) == 2
    assert "name a mapping file, or add --base-timeout" in capsys.readouterr().err
