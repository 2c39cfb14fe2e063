"""The pure parts: angles, lines, speed profiles and maneuvers, against a small model of a base."""

import math

import pytest

from jacaros.artifacts.robots.control import (
    Limits,
    Line,
    Pose,
    Velocity,
    approach,
    bearing,
    distance,
    heading_of,
    unwrapped,
)
from jacaros.artifacts.robots.journey import DriveTo, Sequence, TurnTo, go_to
from jacaros.artifacts.robots.maneuver import Maneuver, Straight, Timed, Turn

LIMITS = Limits(speed=0.65, turn_speed=1.0)
ORIGIN = Pose(0.0, 0.0, 0.0)


class Base:
    """A base with limits, whose commands and odometry are late by some periods.

    Args:
        late: periods from a pose being true to its command taking effect.
        sticks: commands below these speeds move nothing.
    """

    def __init__(self, late: int = 1, sticks: Velocity = Velocity()) -> None:  # noqa: B008 - frozen
        self.pose, self.velocity, self.sticks = ORIGIN, Velocity(), sticks
        self.seen = [ORIGIN] * (late + 1)

    def drive(self, command: Velocity, period: float) -> None:
        linear = command.linear if abs(command.linear) >= self.sticks.linear else 0.0
        angular = command.angular if abs(command.angular) >= self.sticks.angular else 0.0
        for _ in range(5):
            self._step(linear, angular, period / 5)
        self.seen = [*self.seen[1:], self.pose]

    def _step(self, linear: float, angular: float, dt: float) -> None:
        def ramp(now: float, wanted: float, most: float) -> float:
            return now + max(-most, min(most, wanted - now))

        v = ramp(self.velocity.linear, linear, 0.8 * dt)
        w = ramp(self.velocity.angular, angular, 5.0 * dt)
        middle = self.pose.heading + 0.5 * w * dt
        self.velocity = Velocity(v, w)
        self.pose = Pose(
            self.pose.x + v * dt * math.cos(middle),
            self.pose.y + v * dt * math.sin(middle),
            self.pose.heading + w * dt,
        )

    def follow(self, maneuver: Maneuver, seconds: float = 60.0) -> float:
        """Drive *maneuver* to its end; the seconds it took."""
        maneuver.begin(self.seen[0])
        before, settled = Velocity(), 0
        for tick in range(round(seconds / 0.05)):
            command = maneuver.command(self.seen[0], before, LIMITS, 0.05)
            settled = settled + 1 if command is None else 0
            if settled > 3:
                return tick * 0.05
            before = command if command is not None else maneuver.hold(self.seen[0])
            self.drive(before, 0.05)
        raise AssertionError(f"no end: {self.pose}")


@pytest.mark.parametrize("late", [0, 1, 2, 4])
@pytest.mark.parametrize("length", [0.05, 0.3, 1, 4, -1])
def test_a_drive_stops_within_a_centimetre_whatever_the_latency(late: int, length: float) -> None:
    base = Base(late)
    base.follow(Straight(length))
    assert base.pose.x == pytest.approx(length, abs=0.01)
    assert base.pose.y == pytest.approx(0, abs=0.002)


@pytest.mark.parametrize("late", [0, 1, 2, 4])
@pytest.mark.parametrize("degrees", [3, 90, 180, 540, -90, -720])
def test_a_turn_stops_within_a_degree_whatever_the_latency(late: int, degrees: float) -> None:
    base = Base(late)
    base.follow(Turn(math.radians(degrees)))
    assert math.degrees(base.pose.heading) == pytest.approx(degrees, abs=1)


def test_a_motion_ends_although_wheels_stick_below_a_speed() -> None:
    base = Base(1, Velocity(0.019, 0.049))
    base.follow(Straight(1.0))
    base.follow(Turn(2.0))
    assert base.pose.x == pytest.approx(1, abs=0.01)
    assert math.degrees(base.pose.heading) == pytest.approx(math.degrees(2), abs=1)


def test_a_drive_takes_hardly_longer_than_the_ramps_allow() -> None:
    ideal = 2 / 0.65 + 0.65 / 0.8
    assert Base(1).follow(Straight(2.0)) < ideal + 1.2


@pytest.mark.parametrize("goal", [(2, 1), (-1, 0.2), (0.03, 0.03), (0, -2)])
def test_a_journey_ends_at_point_and_heading(goal: tuple[float, float]) -> None:
    base = Base(1)
    base.follow(go_to(*goal, math.radians(170)))
    assert distance(base.pose, Pose(*goal, 0)) < 0.02
    assert math.degrees(unwrapped(base.pose.heading - math.radians(170))) == pytest.approx(0, abs=1)


def test_a_point_at_the_robot_needs_no_motion() -> None:
    base = Base(1)
    assert base.follow(DriveTo(0.01, 0.0)) < 0.5
    assert base.pose == ORIGIN


def test_turning_to_a_heading_takes_the_short_way() -> None:
    maneuver = TurnTo(math.radians(-170))
    maneuver.begin(Pose(0, 0, math.radians(170)))
    command = maneuver.command(Pose(0, 0, math.radians(170)), Velocity(), LIMITS, 0.05)
    assert command is not None
    assert command.angular > 0
    assert maneuver.progress(Pose(0, 0, math.radians(170))) == pytest.approx(math.radians(20))


def test_the_covered_distance_is_in_metres_and_degrees() -> None:
    straight, turn, there = Straight(-1.0), Turn(2.0), DriveTo(1.0, 1.0)
    for maneuver in (straight, turn, there):
        Base(1).follow(maneuver)
    assert straight.covered == pytest.approx(1, abs=0.01)
    assert turn.covered == pytest.approx(math.degrees(2), abs=1)
    assert there.covered == pytest.approx(math.sqrt(2), abs=0.02)
    journey = Sequence(DriveTo(1.0, 0.0), TurnTo(1.0))
    Base(1).follow(journey)
    assert journey.covered == pytest.approx(1, abs=0.02)


def test_a_drive_by_time_gives_its_commands_and_ends() -> None:
    timed = Timed(Velocity(2.0, 0.0), 3)
    timed.begin(ORIGIN)
    commands = [timed.command(ORIGIN, Velocity(), LIMITS, 0.1) for _ in range(4)]
    assert commands == [Velocity(0.65, 0.0)] * 3 + [None]
    assert timed.hold(ORIGIN) == Velocity()


@pytest.mark.parametrize(
    ("angle", "same"),
    [(0, 0), (math.pi, math.pi), (-math.pi, math.pi), (7, 7 - math.tau), (-7, math.tau - 7)],
)
def test_directions_are_unwrapped(angle: float, same: float) -> None:
    assert unwrapped(angle) == pytest.approx(same)


def test_a_line_tells_along_and_aside() -> None:
    line = Line(Pose(1, 1, math.pi / 2), 2.0)
    assert line.along(Pose(0, 2, 0)) == pytest.approx(1)
    assert line.aside(Pose(0, 2, 0)) == pytest.approx(1)
    assert line.remaining(Pose(0, 2, 0)) == pytest.approx(1)
    assert bearing(Pose(1, 1, 0), 0, 1) == pytest.approx(math.pi)


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.5, 3.1])
def test_the_heading_is_read_from_a_quaternion(heading: float) -> None:
    assert heading_of(0, 0, math.sin(heading / 2), math.cos(heading / 2)) == pytest.approx(heading)


def test_speed_rises_by_the_acceleration_and_never_passes_the_cruise_speed() -> None:
    speed = 0.0
    for _ in range(40):
        faster = approach(10.0, speed, cruise=0.5, acceleration=0.8, least=0.02, period=0.05)
        assert faster - speed <= 0.04 + 1e-9
        speed = faster
    assert speed == 0.5


def test_a_robot_past_its_goal_comes_back() -> None:
    assert approach(-0.1, 0.02, cruise=0.5, acceleration=0.8, least=0.02, period=0.05) < 0
