"""The model of a robot, against a plant whose delay, acceleration, dead band and noise are known."""

import math
import random

import pytest
from plant import LIMITS, Plant

from jacaros.robots.artifacts.drive_model import (
    SHARES,
    Axis,
    DriveModel,
    Filtered,
    Velocity,
    ramp,
    vertex,
)
from jacaros.robots.plane.pose import Pose


@pytest.mark.parametrize("delay", [0.05, 0.2, 0.5, 1.0])
@pytest.mark.parametrize("command", [(0.4, 0.0), (-0.4, 0.0), (0.0, 1.2), (0.0, -1.2)])
def test_the_delay_is_measured(delay: float, command: tuple[float, float]) -> None:
    plant = Plant(delay)
    plant.wait(1.0)
    assert plant.model.quality is None
    assert not plant.model.measured
    for _ in range(3):
        plant.drive(*command, 1.5)
        plant.drive(0.0, 0.0, 2.0)
    assert plant.model.measured
    assert plant.model.delay == pytest.approx(delay, abs=0.04)


@pytest.mark.parametrize("share", SHARES[2:])
@pytest.mark.parametrize("turning", [False, True])
def test_the_acceleration_is_measured(share: float, turning: bool) -> None:
    plant = Plant(0.3, 0.8 * share, 4.0 * share)
    plant.wait(1.0)
    command = (0.0, 1.5) if turning else (0.5, 0.0)
    for _ in range(3):
        plant.drive(*command, 3.0)
        plant.drive(0.0, 0.0, 4.0)
    quality = plant.model.quality
    assert quality is not None
    measured = quality.turn_acceleration / 4.0 if turning else quality.acceleration / 0.8
    assert SHARES.index(measured) == pytest.approx(SHARES.index(share), abs=1)
    assert (quality.least, quality.least_turn) == (0.0, 0.0)


@pytest.mark.parametrize("delay", [0.1, 0.4, 0.8])
def test_the_predicted_pose_is_where_the_robot_is_when_a_command_takes_effect(delay: float) -> None:
    plant = Plant(delay)
    plant.wait(1.0)
    for _ in range(2):  # to be measured
        plant.drive(0.5, 0.0, 2.0)
        plant.drive(0.0, 1.0, 2.0)
        plant.drive(0.0, 0.0, 3.0)
    for command in ((0.5, 0.6), (0.2, -1.0), (0.0, 1.5), (0.0, 0.0)):
        plant.drive(*command, 0.4)
        pose, velocity = plant.model.ahead(plant.now)
        shown = (plant.wanted[:], plant.pose, plant.velocity, plant.steps)
        plant.wait(plant.model.delay)
        assert plant.pose[:2] == pytest.approx(pose[:2], abs=0.03)
        assert plant.pose.yaw == pytest.approx(pose.yaw, abs=0.08)
        assert plant.velocity.linear == pytest.approx(velocity.linear, abs=0.06)
        assert plant.velocity.angular == pytest.approx(velocity.angular, abs=0.25)
        assert shown[3] < plant.steps


@pytest.mark.parametrize(("turning", "dead"), [(False, 0.1), (False, 0.06), (True, 0.4)])
def test_a_dead_band_is_found_by_commands_that_move_nothing(turning: bool, dead: float) -> None:
    plant = Plant(0.2, dead=(0.0, dead) if turning else (dead, 0.0))
    plant.wait(1.0)

    def drive(speed: float, seconds: float) -> None:
        plant.drive(*((0.0, speed) if turning else (speed, 0.0)), seconds)

    for speed in (4.0 * dead, 0.9 * dead, 1.1 * dead):
        drive(speed, 2.0)
        drive(0.0, 2.0)
    quality, axis = plant.model.quality, plant.model.angular if turning else plant.model.linear
    assert quality is not None
    found, other = (quality.least_turn, quality.least) if turning else (quality.least, quality.least_turn)
    assert axis.lower == pytest.approx(0.9 * dead, rel=0.12)
    assert dead < found <= 1.3 * dead
    assert other == 0.0
    assert plant.model.has_rolled(driving=not turning)
    assert not plant.model.has_rolled(driving=turning)


def test_the_noise_of_odometry_is_learnt_from_a_standing_robot() -> None:
    plant = Plant(noise=(0.02, 0.03))
    plant.wait(20.0)
    assert plant.model.linear.noise == pytest.approx(0.03, rel=0.5)
    assert plant.model.angular.noise == pytest.approx(0.03, rel=0.5)
    assert plant.model.uncertainty.linear < 0.01, "averaged"
    assert plant.model.pose[:2] == pytest.approx((0.0, 0.0), abs=0.02)
    assert plant.model.linear.threshold == pytest.approx(3.0 * plant.model.linear.noise)


def test_exact_odometry_is_taken_as_it_is() -> None:
    plant = Plant()
    plant.wait(1.0)
    plant.drive(0.4, 0.5, 3.0)
    assert plant.model.pose == pytest.approx(plant.pose)
    assert plant.model.uncertainty == pytest.approx((0.0, 0.0), abs=1e-6)
    assert plant.model.linear.speed == pytest.approx(0.4)
    assert plant.model.angular.speed == pytest.approx(0.5)


@pytest.mark.parametrize("period", [0.02, 0.05, 0.2])
def test_the_period_of_odometry_is_measured(period: float) -> None:
    plant = Plant(period=period)
    plant.wait(10.0)
    assert plant.model.period == pytest.approx(period, rel=0.05)
    assert plant.model.jitter == pytest.approx(0.0, abs=0.005)


def test_messages_at_irregular_times_show_as_jitter() -> None:
    model = DriveModel(LIMITS)
    now, draw = 0.0, random.Random(1)
    for _ in range(400):
        now += draw.uniform(0.0, 0.2)
        model.observed(Pose(0.0, 0.0, 0.0), Velocity(), now, 0.0)
    assert model.period == pytest.approx(0.1, rel=0.3)
    assert model.jitter == pytest.approx(0.15, rel=0.5)  # three times the mean deviation of 0.05 s
    model.observed(Pose(0.0, 0.0, 0.0), Velocity(), now + 30.0, 0.0)
    assert model.period < 0.2, "a pause of odometry is not a period"


def test_a_robot_has_come_to_rest_when_nothing_is_on_the_way() -> None:
    plant = Plant(0.6)
    plant.wait(1.0)
    assert plant.model.has_come_to_rest()
    plant.drive(0.4, 0.0, 0.1)
    assert not plant.model.has_come_to_rest(), "it stands, but a command is on the way"
    plant.wait(2.0)
    assert not plant.model.has_come_to_rest()
    plant.drive(0.0, 0.0, 0.5)
    assert not plant.model.has_come_to_rest()
    plant.wait(3.0)
    assert plant.model.has_come_to_rest()
    assert plant.velocity == Velocity()


def test_what_was_measured_is_put_into_words() -> None:
    model = DriveModel(LIMITS)
    assert str(model) == "nothing was measured yet"
    model.delay, model.measured, model.linear.lower = 0.3, True, 0.1
    assert str(model) == "measured: 0.30 s of delay, 0.8 m/s2, rolls from 0.14 m/s on"


# ---- the parts


@pytest.mark.parametrize(
    ("speed", "wanted", "acceleration", "seconds", "way", "after"),
    [
        (0.0, 1.0, 2.0, 1.0, 0.75, 1.0),
        (0.0, 1.0, 2.0, 0.25, 0.0625, 0.5),
        (1.0, -1.0, 2.0, 0.5, 0.25, 0.0),
        (1.0, 0.0, 2.0, 1.0, 0.25, 0.0),
        (-1.0, -0.5, 1.0, 1.0, -0.625, -0.5),
        (0.3, 0.3, 1.0, 2.0, 0.6, 0.3),
    ],
)
def test_wheels_follow_a_command_by_aramp(
    speed: float, wanted: float, acceleration: float, seconds: float, way: float, after: float
) -> None:
    assert ramp(speed, wanted, acceleration, seconds) == pytest.approx((way, after))


def test_the_least_cost_lies_between_candidates() -> None:
    assert vertex([4.0, 1.0, 2.0], 1) == pytest.approx(0.25)
    assert vertex([2.0, 1.0, 4.0], 1) == pytest.approx(-0.25)
    assert vertex([0.0, 3.0, 4.0, 1.0, 4.0], 3) == pytest.approx(0.0)
    assert vertex([1.0, 1.0, 1.0], 1) == 0.0
    assert vertex([1.0, 2.0, 3.0], 0) == 0.0
    assert vertex([3.0, 2.0, 1.0], 2) == 0.0


def test_an_axis_brackets_its_dead_band() -> None:
    axis = Axis(0.5, 0.8, 0.02)
    assert axis.least == 0.02
    assert axis.did_not_roll(0.1)
    assert (axis.lower, axis.least) == (0.1, pytest.approx(0.14))
    assert axis.effective(0.1) == 0.0
    assert axis.effective(-0.11) == -0.11
    assert axis.did_not_roll(0.05)
    assert axis.lower == 0.1, "a slower command teaches nothing new"
    assert not axis.has_rolled
    axis.rolled(0.12)
    assert axis.has_rolled
    assert (axis.upper, axis.least) == (0.12, 0.12)
    axis.rolled(0.3)
    assert axis.upper == 0.12
    assert not axis.did_not_roll(0.18), "it has rolled at a lower speed: something blocks it"
    assert axis.did_not_roll(0.17)
    assert (axis.lower, axis.upper) == (0.17, pytest.approx(0.238))
    axis.rolled(0.1)
    assert (axis.lower, axis.upper) == (pytest.approx(0.09), 0.1)
    assert not Axis(0.5, 0.8, 0.02).did_not_roll(0.45), "nothing faster is left to try"
    assert Axis(0.5, 0.8, 0.02).did_not_roll(0.44)


def test_the_least_speed_is_at_most_the_cruise_speed() -> None:
    axis = Axis(0.5, 0.8, 0.02)
    axis.lower = 0.4
    assert axis.least == 0.5


def test_a_filtered_coordinate_weighs_noise_against_drift() -> None:
    exact = Filtered()
    exact.move(1.0)
    exact.measure(0.25)
    assert (exact.value, exact.deviation) == (1.25, 0.0)
    noisy = Filtered()
    for number in range(200):
        noisy.stand(0.1 if number % 2 else -0.1)
    assert noisy.noise == pytest.approx(0.1 / math.sqrt(6.0), rel=0.01)
    noisy.measure(0.0)
    noisy.move(1.0)
    assert noisy.deviation == pytest.approx(0.02, rel=0.05)
    noisy.measure(0.03)
    variance, noise = 0.02**2, 0.01 / 6.0
    assert noisy.value == pytest.approx(1.0 + 0.03 * variance / (variance + noise), rel=0.01)
    noisy.measure(5.0)
    assert noisy.value == pytest.approx(6.0, abs=0.02), "it was moved: the new place counts"
    assert noisy.deviation == pytest.approx(noisy.noise, rel=0.01)
