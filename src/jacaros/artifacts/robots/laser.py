"""``ArtBaseScan``: five ranges of a laser scan."""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import ClassVar

from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.kit.faults import Header
from jacaros.artifacts.kit.options import positive, text
from jacaros.artifacts.kit.reading import READING_OPTIONS, Reading, ReadingPolicy, not_finite
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.ros.node import Sample
from jacaros.ros.qos import SENSOR_DATA

SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Positions of the sampled ranges in the scan: from its first beam to its last."""


class ArtBaseScan(RosArtifact):
    """Shows five ranges of ``/scan``, evenly spread from the first beam to the last.

    The number of beams does not matter. A beam without an echo (NaN, infinite, or beyond the sensor's range) has the
    sensor's maximum range; a beam whose echo is too close to measure (minus infinity, REP 117) has its minimum range.

    Options:
        mode, rate, dead_band, latest_only, expire: see `ReadingPolicy`.
        topic(T): another topic, such as ``base_scan``.
        max(R): range of a beam without an echo, in metres, and the maximum range shown.
        frame(F): the only frame in which scans are accepted; default: that of the first scan.

    Properties:
        laserrange(R0, R25, R50, R75, R100): metres; all 0 before the first scan. With `expire` the property does not
            exist then.
        base_scan(R0, R25, R50, R75, R100): the same, under its name in the original system (not of `ArtScan`).
    """

    known_options: ClassVar = {**READING_OPTIONS, "topic": text, "max": positive, "frame": text}

    names: ClassVar[tuple[str, ...]] = ("laserrange", "base_scan")

    _ranges: tuple[Reading, ...]

    def open(self) -> None:
        """Define the properties and subscribe."""
        topic = str(self.options.get("topic", "scan"))
        policy = ReadingPolicy.from_options(self.options)
        self._ranges = tuple(
            self.reading(name, policy, *[0] * len(SHARES), topic=topic) for name in self.names
        )
        self._header = Header(self.faults_of(topic), self.clock, str(self.options.get("frame", "")))
        self.subscription(topic, "sensor_msgs/msg/LaserScan", self._take, SENSOR_DATA)

    def _take(self, sample: Sample) -> None:
        scan = sample.message
        longest = self.options.get("max", float(scan.range_max))
        assert isinstance(longest, float)
        if len(scan.ranges) and self._header.accepts(sample):
            values = sampled(scan.ranges, longest, scan.range_min)
            if not_finite(values) is None:
                self.take_together(sample.cause, *((reading, values) for reading in self._ranges))
            else:
                self._ranges[0].take(values, sample.cause)  # which reports it, once

    @operation(name="getCurrentBaseScan")
    async def get_current_base_scan(self) -> None:
        """Update the properties to the newest ranges; fails with ``no_scan(5)`` if none arrive for 5 s."""
        for reading in self._ranges:
            await self.refresh(reading.name, reading, "no_scan")

    @operation(name="getCurrentBaseScan")
    async def give_current_base_scan(self, a: Out, b: Out, c: Out, d: Out, e: Out) -> None:
        """Give the newest five ranges to the caller."""
        for out, value in zip((a, b, c, d, e), await self.newest(self._ranges[0], "no_scan"), strict=True):
            out.set(value)


class ArtScan(ArtBaseScan):
    """`ArtBaseScan` under its name in the thesis's chapter on architecture, with the property of that chapter."""

    names = ("laserrange",)


def sampled(ranges: Sequence[float], longest: float, shortest: float = 0.0) -> tuple[float, ...]:
    """Return five ranges, evenly spread over the scan; an invalid range becomes *longest*, one that is too close
    *shortest*."""
    least = shortest if 0.0 <= shortest < longest else 0.0
    return tuple([_echo(float(ranges[place]), longest, least) for place in _places(len(ranges))])


@lru_cache(16)
def _places(beams: int) -> tuple[int, ...]:
    """Return which beams are sampled; the others are never read."""
    return tuple(round(share * (beams - 1)) for share in SHARES)


def _echo(distance: float, longest: float, shortest: float) -> float:
    if distance == -math.inf:
        return shortest
    return distance if distance < longest else longest
