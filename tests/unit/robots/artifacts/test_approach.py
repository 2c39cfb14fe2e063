"""The approach to a goal: pulses, profiles, tolerances and what is learnt from a drive that fell short."""

import math
from collections.abc import Callable

import pytest

from jacaros.robots.artifacts import approach
from jacaros.robots.artifacts.approach import Approach, NotMoving, Outlook, Tolerance, Unsettled, pulse_for
from jacaros.robots.artifacts.drive_model import DriveModel, Limits, Velocity
from jacaros.robots.artifacts.maneuver import Line, steer
from jacaros.robots.plane.pose import Pose

LIMITS = Limits(speed=0.6, turn_speed=2.0, acceleration=0.8, turn_acceleration=4.0)
TOLERANCE = Tolerance(0.005, 0.02)


def rolled_way(speed: float, least: float, acceleration: float, seconds: float) -> float:
    """How far wheels roll that are commanded *least* for some seconds and then to stand."""
    way, now, tick = 0.0, speed, 1e-5
    while seconds > 0 or now > 0:
        wanted = least if seconds > 0 else 0.0
        now += max(-acceleration * tick, min(acceleration * tick, wanted - now))
        now = max(now, 0.0)
        way += now * tick
        seconds -= tick
    return way


@pytest.mark.parametrize("speed", [0.0, 0.03])
@pytest.mark.parametrize("least", [0.05, 0.1])
@pytest.mark.parametrize("acceleration", [0.2, 0.8])
@pytest.mark.parametrize("rest", [0.004, 0.01, 0.03])
def test_a_pulse_rolls_to_the_goal(speed: float, least: float, acceleration: float, rest: float) -> None:
    seconds = pulse_for(rest, speed, least, acceleration)
    assert seconds > 0
    assert rolled_way(speed, least, acceleration, seconds) == pytest.approx(rest, abs=2e-5)


def test_a_robot_that_rolls_to_the_goal_anyway_needs_no_pulse() -> None:
    assert pulse_for(0.01, 0.2, 0.3, 0.8) < 0
    assert pulse_for(0.025, 0.2, 0.3, 0.8) == pytest.approx(0.0, abs=1e-9)
    assert pulse_for(0.125, 0.2, 0.1, 0.8) == pytest.approx(1.0), "faster than the pulse: at its speed"


class Scene:
    """A model whose robot stands, or moves, where the test says."""

    def __init__(self) -> None:
        self.model = DriveModel(LIMITS)
        self.now = 0.0
        self.rest()

    def rest(self) -> None:
        """Let odometry show a standing robot."""
        for _ in range(10):
            self.now += 0.05
            self.model.observed(Pose(0.0, 0.0, 0.0), Velocity(), self.now, 0.0)

    def outlook(self, velocity: Velocity = Velocity()) -> Outlook:  # noqa: B008 - frozen
        pose = self.model.pose
        return Outlook(self.model, LIMITS, self.now, pose, pose, velocity)


def begun(scene: Scene, rest: float, velocity: Velocity = Velocity()) -> Approach:  # noqa: B008 - frozen
    """An approach that has checked the pose at rest and drives."""
    made = Approach(TOLERANCE)
    assert made.speed(scene.model.linear, scene.outlook(velocity), rest, rest) is not None
    return made


@pytest.mark.parametrize("rest", [0.0, 0.001, -0.001])
def test_a_robot_at_its_goal_needs_no_drive(rest: float) -> None:
    scene = Scene()
    assert Approach(TOLERANCE).speed(scene.model.linear, scene.outlook(), rest, rest) is None


@pytest.mark.parametrize("rest", [0.002, -0.002])
def test_the_first_drives_aim_at_a_fraction_of_the_tolerance(rest: float) -> None:
    scene = Scene()
    assert Approach(TOLERANCE).speed(scene.model.linear, scene.outlook(), rest, rest) is not None


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_a_drive_accelerates_cruises_and_brakes(sign: float) -> None:
    scene = Scene()
    axis = scene.model.linear
    made = begun(scene, sign * 2.0)

    def speed(ahead: float, velocity: float) -> float:
        found = made.speed(axis, scene.outlook(Velocity(sign * velocity)), sign * 2.0, sign * ahead)
        assert found is not None
        assert found.seconds == approach.PERIOD
        return sign * found.speed

    assert speed(2.0, -0.5) == pytest.approx(2 * 0.8 * 0.05), (
        "it still rolls the other way: from the last command on"
    )
    assert speed(2.0, 0.0) == pytest.approx(3 * 0.8 * 0.05)
    assert speed(2.0, 0.3) == pytest.approx(0.34)
    assert speed(2.0, 0.6) == 0.6
    braking = 0.6 * 0.8
    lead = braking * max(0.05, scene.model.jitter)
    assert speed(0.1, 0.6) == pytest.approx(math.sqrt(lead**2 + 2 * braking * 0.1) - lead)


def test_a_turn_uses_the_speeds_of_turning() -> None:
    scene = Scene()
    made = Approach(Tolerance(0.005, 0.02))
    found = made.speed(scene.model.angular, scene.outlook(Velocity(0.6, 1.0)), 3.0, 3.0)
    assert found is not None
    assert found.speed == pytest.approx(1.0 + 4.0 * 0.05)


def test_the_last_millimetres_are_one_short_pulse_after_which_the_robot_stands() -> None:
    scene = Scene()
    axis = scene.model.linear
    made = begun(scene, 0.5)
    axis.lower = 0.05
    pulse = made.speed(axis, scene.outlook(Velocity(0.05)), 0.01, 0.003)
    assert pulse is not None
    assert pulse.speed == axis.least
    assert approach.SHORTEST <= pulse.seconds < approach.PERIOD
    assert pulse.seconds == pytest.approx(max(approach.SHORTEST, pulse_for(0.003, 0.05, axis.least, 0.8)))
    scene.model.commanded(Velocity(0.05), scene.now)
    assert made.speed(axis, scene.outlook(), 0.01, 0.0) == approach.STAND, "it waits for the robot to rest"


def test_a_robot_that_can_never_be_placed_fails() -> None:
    scene = Scene()
    axis = scene.model.linear
    made = Approach(TOLERANCE)
    for drive in range(approach.MOST):
        made.speed(axis, scene.outlook(), 0.5 if drive % 2 else -0.5, 0.0)
        made.speed(axis, scene.outlook(), 0.0, 0.0)
    with pytest.raises(Unsettled):
        made.speed(axis, scene.outlook(), 0.5, 0.0)


def test_a_robot_that_does_not_move_fails() -> None:
    scene = Scene()
    axis = scene.model.linear
    made = Approach(TOLERANCE)

    def drive_in_vain() -> None:
        for _ in range(20):
            assert made.speed(axis, scene.outlook(Velocity(0.5)), 1.0, 1.0) is not None
        while made.speed(axis, scene.outlook(), 1.0, 0.0) != approach.STAND:
            pass

    with pytest.raises(NotMoving):
        drive_often(drive_in_vain)


def drive_often(drive: Callable[[], None]) -> None:
    for _ in range(200):
        drive()


def test_the_tolerance_narrows_first_and_ends_at_what_the_robot_can_do() -> None:
    scene, made = Scene(), Approach(TOLERANCE)
    axis, model = scene.model.linear, scene.model
    axis.lower, model.jitter = 0.1, 0.05

    def allowed(corrections: int) -> float:
        made._corrections = corrections
        return made._allowed(axis, model)

    assert [allowed(each) for each in range(5)] == pytest.approx([0.00125, 0.00125, 0.0025, 0.005, 0.005])
    assert allowed(5) == pytest.approx(axis.least * 0.07)
    model.jitter = 0.5
    assert allowed(5) == TOLERANCE.most
    axis.lower, model.jitter = 0.0, 0.0
    assert allowed(5) == TOLERANCE.usual


def test_steering_is_gentler_the_more_irregular_commands_are_and_limited() -> None:
    line, beside = Line(Pose(0.0, 0.0, 0.0), 2.0), Pose(0.5, 0.0, 0.1)
    assert steer(line, beside, 0.3, 0.0, 2.0) == pytest.approx(-0.2)
    assert steer(line, beside, 0.3, 0.1, 2.0) == pytest.approx(-0.2)
    assert steer(line, beside, 0.3, 0.4, 2.0) == pytest.approx(-0.1)
    assert steer(line, Pose(0.5, 0.0, 1.4), 0.3, 0.0, 2.0) == -1.0
    left = Pose(0.5, 0.1, 0.0)
    assert steer(line, left, 0.3, 0.0, 2.0) == pytest.approx(-2.0 * math.atan2(0.1, 0.4))
    assert steer(line, left, -0.3, 0.0, 2.0) == pytest.approx(2.0 * math.atan2(0.1, 0.4)), (
        "in reverse, the other way"
    )
    assert steer(line, Pose(1.98, 0.1, 0.0), 0.3, 0.0, 2.0) == 0.0, "close to the goal it keeps its heading"
