"""ArtBaseScan: five ranges of a scan of any size."""

import math

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import Out, Structure
from jacaros.robots.artifacts.sensors import ArtBaseScan, ArtScan, sampled


def scan(lab: Lab, ranges: list[float], topic: str = "/scan", longest: float = 8.0) -> None:
    publisher = lab.backend.publisher(topic, "sensor_msgs/msg/LaserScan")
    publisher.publish(publisher.message(ranges=ranges, range_min=0.1, range_max=longest))


def test_five_ranges_are_spread_from_the_first_beam_to_the_last() -> None:
    assert sampled([float(i) for i in range(1081)], 5000) == (0, 270, 540, 810, 1080)
    assert sampled([float(i) for i in range(360)], 5000) == (0, 90, 180, 269, 359)
    assert sampled([3.0], 10) == (3, 3, 3, 3, 3)


def test_no_echo_is_the_greatest_range() -> None:
    assert sampled([math.inf, math.nan, 1.0, 9.0, 8.0], 8.0) == (8, 8, 1, 8, 8)


def test_an_echo_too_near_to_be_measured_is_the_least_range() -> None:
    """REP 117: minus infinity; taken for no echo at all, an obstacle would seem to be far away."""
    ranges = [-math.inf, 1.0, math.inf, 1.0, -math.inf]
    assert sampled(ranges, 8.0, 0.12) == (0.12, 1, 8, 1, 0.12)
    for unknown in (math.nan, math.inf, -1.0, 9.0):
        assert sampled(ranges, 8.0, unknown) == (0, 1, 8, 1, 0)


async def test_scans_of_any_size_are_shown(lab: Lab) -> None:
    """The original took 1081 beams for granted, and 50000 for no echo."""
    watcher = lab.watch(await lab.make(ArtBaseScan))
    assert watcher.holds("laserrange") == [(0, 0, 0, 0, 0)]
    scan(lab, [1, 2, math.inf, 4, 5])
    await lab.sleep(0.1)
    assert watcher.holds("laserrange") == [(1, 2, 8, 4, 5)]
    scan(lab, [])
    scan(lab, [1, 2, math.inf, 4, 5])
    await lab.sleep(0.1)
    assert len(watcher.values("laserrange")) == 2


@made(ArtScan, Structure("max", (50000,)), {"topic": "base_scan"})
async def test_the_range_of_no_echo_is_an_option(lab: Lab, watcher: Watcher) -> None:
    scan(lab, [math.nan] * 5, "/base_scan")
    await lab.sleep(0.1)
    assert watcher.holds("laserrange") == [(50000,) * 5]


@pytest.mark.world("house")
async def test_the_scan_of_the_world_is_seen_and_given_on_request(lab: Lab) -> None:
    artifact = await lab.make(ArtBaseScan, Structure("mode", ("on_demand",)))
    watcher = lab.watch(artifact)
    outs = [Out() for _ in range(5)]
    await lab.do(artifact, "getCurrentBaseScan", *outs)
    assert all(0.1 < float(str(out.value)) <= 10 for out in outs)
    assert len(watcher.changes) == 2, "the values before the first scan"
    await lab.do(artifact, "getCurrentBaseScan")
    assert watcher.holds("laserrange") == [pytest.approx(tuple(out.value for out in outs))]
    assert watcher.holds("base_scan") == watcher.holds("laserrange"), "its name in the original system"


async def test_a_missing_scan_fails_as_no_scan(lab: Lab) -> None:
    artifact = await lab.make(ArtBaseScan)
    assert (await lab.call(artifact, "getCurrentBaseScan")).reason == "no_scan(5)"


@pytest.mark.world("house")
async def test_the_artifact_of_the_thesis_has_the_property_of_the_thesis_only(lab: Lab) -> None:
    watcher = lab.watch(await lab.make(ArtScan))
    await lab.sleep(1.0)
    assert watcher.holds("laserrange")
    assert not watcher.holds("base_scan")
