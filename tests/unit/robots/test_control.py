"""The pure parts: angles, lines, speed profiles and maneuvers, against a small model of a base."""

import math

import pytest
from plant import Plant

from jacaros.robots.artifacts.approach import Outlook, TimedCommand
from jacaros.robots.artifacts.drive_model import Limits, Velocity
from jacaros.robots.artifacts.maneuver import (
    DriveTo,
    Line,
    Maneuver,
    Sequence,
    Straight,
    Timed,
    Turn,
    TurnTo,
    bearing,
    distance,
    go_to,
)
from jacaros.robots.plane.pose import ORIGIN, Pose, normalised

LIMITS = Limits(speed=0.65, turn_speed=1.0)


class Base(Plant):
    """A robot that follows maneuvers; *late*: periods of 0.05 s from a command until odometry shows its effect."""

    def __init__(self, late: int = 1, acceleration: float = 0.8) -> None:
        super().__init__(late * 0.05, acceleration, 6.0 * acceleration, limits=LIMITS)
        self.wait(1.0)

    def outlook(self) -> Outlook:
        ahead, velocity = self.model.ahead(self.now)
        return Outlook(self.model, LIMITS, self.now, self.model.pose, ahead, velocity)

    def follow(self, maneuver: Maneuver, seconds: float = 60.0) -> float:
        """Drive *maneuver* to its end; the seconds it took."""
        began = self.now
        maneuver.begin(self.model.pose)
        while self.now < began + seconds:
            step = maneuver.command(self.outlook())
            if step is None:
                return self.now - began
            self.drive(*step.velocity, step.seconds)
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
    assert math.degrees(base.pose.yaw) == pytest.approx(degrees, abs=1)


def furthest(base: Base, maneuver: Maneuver) -> float:
    """Drive a maneuver to its end; the greatest x on the way."""
    reached = 0.0
    maneuver.begin(base.model.pose)
    while (step := maneuver.command(base.outlook())) is not None:
        base.drive(*step.velocity, step.seconds)
        reached = max(reached, base.pose.x)
    return reached


@pytest.mark.parametrize("late", [0, 2, 6])
@pytest.mark.parametrize("acceleration", [0.1, 0.3, 3.0])
def test_a_drive_brakes_by_the_acceleration_that_it_has_measured(late: int, acceleration: float) -> None:
    base = Base(late, acceleration=acceleration)
    assert furthest(base, Straight(2.0)) < 2.05
    assert base.pose.x == pytest.approx(2, abs=0.01)
    assert base.model.linear.acceleration == pytest.approx(min(0.8, acceleration), rel=0.45)


def test_a_robot_whose_delay_is_unknown_does_not_overshoot_a_short_way() -> None:
    assert furthest(Base(12), Straight(0.1)) < 0.12


@pytest.mark.parametrize("goal", [(2, 1), (-1, 0.2), (0.03, 0.03), (0, -2)])
def test_a_journey_ends_at_point_and_heading(goal: tuple[float, float]) -> None:
    base = Base(1)
    base.follow(go_to(*goal, math.radians(170)))
    assert distance(base.pose, Pose(*goal, 0)) < 0.02
    assert math.degrees(normalised(base.pose.yaw - math.radians(170))) == pytest.approx(0, abs=1)


def test_a_point_at_the_robot_needs_no_motion() -> None:
    base = Base(1)
    assert base.follow(DriveTo(0.01, 0.0)) < 0.5
    assert base.pose == ORIGIN


def test_turning_to_a_heading_takes_the_short_way() -> None:
    base = Base(1)
    base.follow(Turn(math.radians(170)))
    maneuver = TurnTo(math.radians(-170))
    base.follow(maneuver)
    assert maneuver.covered == pytest.approx(20, abs=1)
    assert math.degrees(normalised(base.pose.yaw)) == pytest.approx(-170, abs=0.5)


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
    commands = [timed.command(Base().outlook()) for _ in range(4)]
    assert commands == [TimedCommand(Velocity(0.65, 0.0), 0.1)] * 3 + [None]


def test_a_line_tells_along_and_aside() -> None:
    line = Line(Pose(1, 1, math.pi / 2), 2.0)
    assert line.along(Pose(0, 2, 0)) == pytest.approx(1)
    assert line.aside(Pose(0, 2, 0)) == pytest.approx(1)
    assert line.remaining(Pose(0, 2, 0)) == pytest.approx(1)
    assert bearing(Pose(1, 1, 0), 0, 1) == pytest.approx(math.pi)


def test_speed_rises_by_the_acceleration_and_never_passes_the_cruise_speed() -> None:
    base, before = Base(0), 0.0
    maneuver = Straight(3.0)
    maneuver.begin(base.model.pose)
    for _ in range(60):
        step = maneuver.command(base.outlook())
        assert step is not None
        assert before - 0.05 < step.velocity.linear <= min(0.65, before + 0.04 + 1e-9)
        before = step.velocity.linear
        base.drive(*step.velocity, step.seconds)
    assert before == 0.65


def test_a_robot_past_its_goal_comes_back() -> None:
    base = Base(1)
    maneuver = Straight(0.2)
    maneuver.begin(base.model.pose)
    base.pose = Pose(0.3, 0.0, 0.0)
    base.wait(0.2)
    while (step := maneuver.command(base.outlook())) is not None:
        assert step.velocity.linear <= 0.0
        base.drive(*step.velocity, step.seconds)
    assert base.pose.x == pytest.approx(0.2, abs=0.006)
