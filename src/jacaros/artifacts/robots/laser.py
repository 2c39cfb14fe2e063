"""``ArtBaseScan``: five ranges of a laser scan."""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import ClassVar

from jacaros.artifacts.kit.faults import Header
from jacaros.artifacts.kit.options import positive, text
from jacaros.artifacts.kit.reading import READING_OPTIONS, Reading, ReadingPolicy
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.env.artifact import Out, operation
from jacaros.ros.backend import Sample
from jacaros.ros.qos import SENSOR_DATA

SHARES = (0.0, 0.25, 0.5, 0.75, 1.0)
"""Where in the scan the ranges are sampled: from its first beam to its last."""


class ArtBaseScan(RosArtifact):
    """Shows five ranges of ``/scan``, evenly spread from the first beam to the last.

    The number of beams may be any.  A beam without an echo (NaN, infinite, or beyond the sensor's range) has
    the sensor's greatest range, one whose echo is too near to be measured (minus infinity, REP 117) the least.

    Options:
        mode, rate, dead_band, latest_only, expire: see `ReadingPolicy`.
        topic(T): another topic, such as ``base_scan``.
        max(R): range of a beam without an echo, in metres, and greatest range shown.
        frame(F): the only frame in which scans are believed; that of the first scan by default.

    Properties:
        laserrange(R0, R25, R50, R75, R100): metres; all 0 before the first scan.  With `expire` it is not there then.
    """

    known_options: ClassVar = {**READING_OPTIONS, "topic": text, "max": positive, "frame": text}

    _ranges: Reading

    def open(self) -> None:
        """Define the property and listen."""
        topic = str(self.options.get("topic", "scan"))
        policy = ReadingPolicy.from_options(self.options)
        self._ranges = self.reading("laserrange", policy, *[0] * len(SHARES), topic=topic)
        self._header = Header(self.faults_of(topic), self.clock, str(self.options.get("frame", "")))
        self.subscription(topic, "sensor_msgs/msg/LaserScan", self._take, SENSOR_DATA)

    def _take(self, sample: Sample) -> None:
        scan = sample.message
        longest = self.options.get("max", float(scan.range_max))
        assert isinstance(longest, float)
        if len(scan.ranges) and self._header.accepts(sample):
            self._ranges.take(sampled(scan.ranges, longest, scan.range_min), sample.cause)

    @operation(name="getCurrentBaseScan")
    async def get_current_base_scan(self) -> None:
        """Give the property the newest ranges; ``no_scan(5)`` when there is none for 5 s."""
        await self.refresh("laserrange", self._ranges, "no_scan")

    @operation(name="getCurrentBaseScan")
    async def give_current_base_scan(self, a: Out, b: Out, c: Out, d: Out, e: Out) -> None:
        """Give the newest five ranges to the caller."""
        for out, value in zip((a, b, c, d, e), await self.newest(self._ranges, "no_scan"), strict=True):
            out.set(value)


class ArtScan(ArtBaseScan):
    """The same under the name that the thesis's architecture chapter uses."""


def sampled(ranges: Sequence[float], longest: float, shortest: float = 0.0) -> tuple[float, ...]:
    """Five ranges, evenly spread over the scan; what is no range becomes *longest*, what is too near *shortest*."""
    least = shortest if 0.0 <= shortest < longest else 0.0
    return tuple([_echo(float(ranges[place]), longest, least) for place in _places(len(ranges))])


@lru_cache(16)
def _places(beams: int) -> tuple[int, ...]:
    """Which beams of so many are sampled; the others are never touched."""
    return tuple(round(share * (beams - 1)) for share in SHARES)


def _echo(distance: float, longest: float, shortest: float) -> float:
    if distance == -math.inf:
        return shortest
    return distance if distance < longest else longest
