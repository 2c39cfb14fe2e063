"""Robots that are late, slow, sticky or noisy: the drive operations arrive, or say what they have measured."""

import asyncio
import math
import random
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import pytest

import jacaros
from jacaros import Mas
from jacaros.artifacts.env.values import Structure

TRACK = 0.23
STEP = 0.01


@dataclass(frozen=True)
class Robot:
    """A robot with two wheels.

    Attributes:
        delay, jitter: seconds that each message travels: the delay, and up to the jitter more.
        acceleration: of a wheel, m/s2.
        dead_band: speed below which a wheel does not roll, m/s.
        rate: odometry messages a second.
        noise: standard deviation of odometry's positions, metres.
        wall: greatest x that the robot can reach.
        reacts: whether it obeys at all.
    """

    delay: float = 0.0
    jitter: float = 0.0
    acceleration: float = 0.8
    dead_band: float = 0.0
    rate: float = 20.0
    noise: float = 0.0
    wall: float = math.inf
    reacts: bool = True


class Base:
    """Drives as the robot does, on the graph of *mas*."""

    def __init__(self, mas: Mas, robot: Robot, seed: int) -> None:
        self.robot, self.random = robot, random.Random(seed)
        self.loop = asyncio.get_running_loop()
        self.x = self.y = self.heading = self.left = self.right = 0.0
        self.wanted, self.heard, self.at = (0.0, 0.0), -math.inf, self.loop.time()
        self.epoch = mas.clock.now() - self.loop.time()
        self.busy_until = {"command": 0.0, "odometry": 0.0}
        self.out = mas.ros.publisher("/odom", "nav_msgs/msg/Odometry")
        mas.ros.subscription("/cmd_vel", "geometry_msgs/msg/Twist", self.take)
        self.loop.call_later(0.1, self.measure)

    def send(self, line: str, callback: Callable[..., object], *arguments: Any) -> None:
        """Call back after the time of a message; messages keep their order."""
        at = self.loop.time() + self.robot.delay + self.random.random() * self.robot.jitter
        self.busy_until[line] = max(at, self.busy_until[line] + 1e-6)
        self.loop.call_at(self.busy_until[line], callback, *arguments)

    def take(self, sample: Any) -> None:
        self.send("command", self.obey, (sample.message.linear.x, sample.message.angular.z))

    def obey(self, wanted: tuple[float, float]) -> None:
        self.roll()
        self.wanted, self.heard = wanted, self.loop.time()

    def measure(self) -> None:
        self.roll()
        message = self.out.message()
        stamp = self.epoch + self.loop.time()
        message.header.stamp.sec, message.header.stamp.nanosec = int(stamp), int(stamp % 1 * 1e9)
        message.header.frame_id = "odom"
        message.pose.pose.position.x = self.x + self.random.gauss(0.0, self.robot.noise)
        message.pose.pose.position.y = self.y + self.random.gauss(0.0, self.robot.noise)
        message.pose.pose.orientation.z = math.sin(self.heading / 2)
        message.pose.pose.orientation.w = math.cos(self.heading / 2)
        message.twist.twist.linear.x = (self.left + self.right) / 2
        message.twist.twist.angular.z = (self.right - self.left) / TRACK
        self.send("odometry", self.out.publish, message)
        self.loop.call_later(1.0 / self.robot.rate, self.measure)

    def roll(self) -> None:
        while self.at < self.loop.time() - 1e-9:
            self.at += STEP
            v, w = self.wanted if self.robot.reacts and self.at - self.heard < 0.6 else (0.0, 0.0)
            self.left = self.wheel(self.left, v - w * TRACK / 2)
            self.right = self.wheel(self.right, v + w * TRACK / 2)
            self.heading += (self.right - self.left) / TRACK * STEP
            self.x += (self.left + self.right) / 2 * math.cos(self.heading) * STEP
            self.y += (self.left + self.right) / 2 * math.sin(self.heading) * STEP
            if self.x > self.robot.wall:
                self.x, self.left, self.right = self.robot.wall, 0.0, 0.0

    def wheel(self, speed: float, wanted: float) -> float:
        wanted = wanted if abs(wanted) >= self.robot.dead_band else 0.0
        most = self.robot.acceleration * STEP
        return speed + max(-most, min(most, wanted - speed))


@dataclass
class Outcome:
    """What came of operations."""

    base: Base
    reason: str
    message: str
    seconds: float
    quality: tuple[float, ...] | None
    furthest: float


def drive(robot: Robot, *operations: tuple[Any, ...], seed: int = 1, **options: Any) -> Outcome:
    async def body() -> Outcome:
        async with Mas(world="none", seed=seed, on_log=lambda text, level: None) as mas:
            base = Base(mas, robot, seed)
            settings = [Structure(name, (value,)) for name, value in options.items()]
            await mas.make_artifact("wheels", "ArtCmdVel", settings)
            session = mas.session("driver")
            session.focus("wheels")
            await mas.sleep(1.0)
            began, reason, message = mas.clock.now(), "", ""
            try:
                for name, *arguments in operations:
                    await session.act(name, *arguments)
            except jacaros.OperationFailed as failed:
                reason, message = str(failed.reason), str(failed)
            seconds = mas.clock.now() - began
            await mas.sleep(2.0)
            base.roll()
            shown = [each.values for each in session.properties("drive_quality")]
            return Outcome(base, reason, message, seconds, shown[0] if shown else None, base.x)

    return jacaros.run(body(), clock="fast")


LATE = Robot(delay=0.15, jitter=0.05)
ROBOTS = {
    "exact": Robot(),
    "150 ms": LATE,
    "300 ms and more or less 100": Robot(delay=0.2, jitter=0.2),
    "0.1 m/s2": Robot(acceleration=0.1),
    "3 m/s2, late": replace(LATE, acceleration=3.0),
    "0.2 m/s2, late": replace(LATE, acceleration=0.2),
    "dead band": Robot(dead_band=0.08),
    "dead band, late": replace(LATE, dead_band=0.06),
    "4 Hz": Robot(rate=4.0),
    "4 Hz, late": replace(LATE, rate=4.0),
    "100 Hz, slow": Robot(rate=100.0, acceleration=0.1),
    "noise": Robot(noise=0.02),
    "noise, late": replace(LATE, noise=0.02),
    "noise, dead band": Robot(noise=0.02, dead_band=0.06),
}


@pytest.mark.parametrize("name", ROBOTS)
def test_a_robot_drives_a_square_however_it_is_built(name: str) -> None:
    outcome = drive(ROBOTS[name], *[("moveForward", 0.6), ("rotate", 90)] * 4)
    assert outcome.reason == ""
    assert math.hypot(outcome.base.x, outcome.base.y) < 0.05
    assert abs(math.degrees(math.remainder(outcome.base.heading, math.tau))) < 4.0


@pytest.mark.parametrize("name", ROBOTS)
def test_a_robot_drives_to_a_point_however_it_is_built(name: str) -> None:
    outcome = drive(ROBOTS[name], ("driveTo", 1.0, -0.7), seed=2)
    assert outcome.reason == ""
    assert math.hypot(outcome.base.x - 1.0, outcome.base.y + 0.7) < 0.04


def test_what_was_measured_is_a_property() -> None:
    quality = drive(replace(LATE, acceleration=0.3), ("moveForward", 1.5)).quality
    assert quality == (pytest.approx(0.35, abs=0.08), pytest.approx(0.3, rel=0.2), 0)
    sticky = drive(Robot(dead_band=0.06), ("moveForward", 0.5), ("moveForward", 0.01)).quality
    assert sticky is not None
    assert 0.0 <= sticky[-1] < 0.12


def test_a_robot_in_front_of_a_wall_is_blocked() -> None:
    outcome = drive(replace(LATE, wall=0.5), ("moveForward", 2.0))
    assert outcome.reason.startswith("blocked(0.")
    assert float(outcome.reason[8:-1]) == pytest.approx(0.5, abs=0.02)


def test_a_robot_that_never_reacts_does_not_move() -> None:
    outcome = drive(Robot(reacts=False), ("moveForward", 2.0))
    assert outcome.reason == "does_not_move(no_reaction)"
    assert outcome.seconds < 10.0


def test_a_robot_whose_topic_has_no_subscriber_is_unmatched() -> None:
    outcome = drive(Robot(), ("moveForward", 1.0), command_topic="/elsewhere")
    assert outcome.base.x == 0.0
    assert outcome.reason == "does_not_move(unmatched)"


def test_a_robot_that_is_too_irregular_fails_with_its_delay() -> None:
    outcome = drive(Robot(delay=0.1, jitter=0.45, dead_band=0.08), *[("rotate", 5)] * 3)
    if outcome.reason:  # by chance, it may be placed
        assert outcome.reason.startswith("late(")
        assert "of delay" in outcome.message
    assert outcome.seconds < 90.0


def test_without_delay_a_square_takes_hardly_longer_than_the_ramps_allow() -> None:
    outcome = drive(Robot(), *[("moveForward", 1.0), ("rotate", 90)] * 4)
    assert outcome.seconds < 20.0
    assert math.hypot(outcome.base.x, outcome.base.y) < 0.01
