"""The edges of readings, goals, units and maps: NaN, ages, waits, ranges, late clocks, names that are used twice."""

import math

import pytest
from fake_actions import FakeServer
from navigator import Navigator, failed
from robot_lab import Lab

from jacaros.artifacts import Out, Structure
from jacaros.robots.map.cells import HIT, OBSTACLE, OccupancyCells
from jacaros.robots.map.mapper import Localisation
from jacaros.robots.mapping.decoding import converted
from jacaros.robots.mapping.fields import Conversion, LinearConversion, conversion
from jacaros.robots.mapping.file import read_mapping
from jacaros.robots.plane.pose import Pose
from jacaros.robots.streams import ReadingPolicy


def test_a_number_that_appears_or_disappears_differs_whatever_the_dead_band_is() -> None:
    policy = ReadingPolicy(dead_band=10.0, finite=False)
    assert policy.differ((1.0,), (math.nan,))
    assert policy.differ((math.nan,), (1.0,))
    assert not policy.differ((1.0,), (2.0,))
    assert not policy.differ((float("nan"),), (float("nan"),))


async def test_the_time_that_a_server_takes_to_accept_counts_towards_the_timeout(lab: Lab) -> None:
    server = FakeServer(lab)
    server.accepting = 2.0
    artifact = await lab.make(Navigator, Structure("timeout", (3,)))
    going = lab.begin(artifact, "go", 3, Out())
    await failed(going, "timeout(3)")
    assert lab.clock.elapsed == pytest.approx(3.0, abs=0.05)


def test_a_conversion_of_units_is_followed_by_scale_and_offset() -> None:
    both = conversion("kelvin", "celsius").then(LinearConversion(1.8, 32.0))
    assert both.there(300.0) == pytest.approx(80.33)
    assert both.back(80.33) == pytest.approx(300.0)


@pytest.mark.parametrize(("share", "percent"), [(0.57, 57), (0.5699, 56), (1.0, 100), (0.0, 0)])
def test_rounding_down_forgives_the_error_of_a_multiplication(share: float, percent: int) -> None:
    down = converted(Conversion(line=LinearConversion(100.0), digits=0, floor=True))
    assert down(share) == percent


def test_operations_may_share_the_name_of_their_feedback_but_not_that_of_a_property() -> None:
    go = "{{action: {0}, type: nav2_msgs/action/NavigateToPose, feedback: {{left: {{fields: [distance_remaining]}}}}}}"
    both = f"operations:\n  a: {go.format('x')}\n  b: {go.format('y')}\n"
    read_mapping(both)
    with pytest.raises(Exception, match="has the same name as the property"):
        read_mapping(f"properties: {{left: {{topic: t}}}}\n{both}")


def test_a_clock_that_was_set_back_begins_a_new_history_of_odometry() -> None:
    localisation = Localisation()
    for stamp, x in ((10.0, 1.0), (11.0, 2.0), (5.0, 3.0), (6.0, 4.0)):
        localisation.take_odometry(stamp, Pose(x, 0.0, 0.0))
    assert localisation.pose_at(5.5) == Pose(3.5, 0.0, 0.0)
    assert localisation.pose_at(1.0) == Pose(3.0, 0.0, 0.0), "the oldest of the new history"


def test_a_cell_with_an_echo_gains_all_that_an_echo_gives() -> None:
    cells = OccupancyCells(OBSTACLE, 1.0)
    cells.add_scan((0.0, 0.0), [(2.0, 0.0)], [(4.0, 0.0)])
    assert cells.odds[2, 0] == HIT
