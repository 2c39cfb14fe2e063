"""Artifacts of single sensors: ``ArtBaseScan``, five ranges of a laser scan; bumpers and cliff sensors of a Kobuki."""

import math
from collections.abc import Sequence
from functools import lru_cache
from typing import ClassVar

from jacaros.artifacts.env.artifact import Out, internal_operation, operation
from jacaros.artifacts.env.values import Atom
from jacaros.robots.kit.options import positive, text
from jacaros.robots.kit.reading import READING_OPTIONS, Reading, Stamps, not_finite
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.backend import Sample
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.qos import SENSOR_DATA
from jacaros.robots.streams import ReadingPolicy

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
        topic = self.option("topic", "scan")
        policy = ReadingPolicy.from_options(self.options)
        self._ranges = tuple(
            self.reading(name, policy, *[0] * len(SHARES), topic=topic) for name in self.names
        )
        self._header = Stamps(self.faults_of(topic), self.clock, self.option("frame", ""))
        self.subscription(topic, "sensor_msgs/msg/LaserScan", self._take, SENSOR_DATA)

    def _take(self, sample: Sample) -> None:
        scan = sample.message
        longest = self.option("max", float(scan.range_max))
        header = scan.header
        stamp = to_seconds(header.stamp)
        if len(scan.ranges) and self._header.accept(stamp, sample.stamp, header.frame_id):
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
        await self.give_newest(self._ranges[0], "no_scan", a, b, c, d, e)


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


# ``ArtBumper`` and ``ArtCliff``: the bumper and cliff events of a Kobuki base (TurtleBot 2).

SIDES: tuple[str, ...] = ("left", "center", "right")
"""Sides by their numbers in ``kobuki_msgs/msg/BumperEvent`` and ``CliffEvent``."""


class KobukiEvents(RosArtifact):
    """Three sensors that publish an event when they change; state 1 is signalled."""

    known_options: ClassVar = {"topic": text}
    side_field: ClassVar[str]
    property_name: ClassVar[str]
    states: ClassVar[tuple[str, str]]

    def open(self) -> None:
        """Define the property of each side and subscribe."""
        self._shown = dict.fromkeys(SIDES, self.states[0])
        for side in SIDES:
            self.define_property(self.property_name, Atom(side), Atom(self.states[0]))
        kind = self.property_name
        topic = self.option("topic", f"mobile_base/events/{kind}")
        self._faults = self.faults_of(topic)
        self.subscription(topic, f"kobuki_msgs/msg/{kind.capitalize()}Event", self._take)

    def _take(self, sample: Sample) -> None:
        side, state = int(getattr(sample.message, self.side_field)), int(sample.message.state)
        if side >= len(SIDES):
            self._faults.out_of_range(self.side_field, side)
        elif state >= len(self.states):
            self._faults.out_of_range("state", state)
        else:
            self.start(self.show_event, SIDES[side], self.states[state], cause=sample.cause)

    @internal_operation
    def show_event(self, side: str, state: str) -> None:
        """Show the new state of a side, and signal state 1."""
        if self._shown[side] != state:
            self.remove_property(self.property_name, Atom(side), Atom(self._shown[side]))
            self.define_property(self.property_name, Atom(side), Atom(state))
            self._shown[side] = state
        if state == self.states[1]:
            self.signal(f"tick_{self.property_name.capitalize()}_{side.upper()}")


class ArtBumper(KobukiEvents):
    """Shows the bumpers of a Kobuki from ``/mobile_base/events/bumper`` (``kobuki_msgs/msg/BumperEvent``).

    Options:
        topic(T): another topic.

    Properties:
        bumper(Side, State): one for each side, ``left``, ``center`` and ``right``; the state is ``released`` or
            ``pressed``.

    Signals:
        tick_Bumper_LEFT, tick_Bumper_CENTER, tick_Bumper_RIGHT: that bumper was pressed.
        tick_Bumper: `getCurrentBumper` was called.
    """

    side_field = "bumper"
    property_name = "bumper"
    states = ("released", "pressed")

    @operation(name="getCurrentBumper")
    def get_current_bumper(self) -> None:
        """Signal ``tick_Bumper``; the properties are always current."""
        self.signal("tick_Bumper")


class ArtCliff(KobukiEvents):
    """Shows the cliff sensors of a Kobuki from ``/mobile_base/events/cliff`` (``kobuki_msgs/msg/CliffEvent``).

    Options:
        topic(T): another topic.

    Properties:
        cliff(Side, State): one for each side, ``left``, ``center`` and ``right``; the state is ``floor`` or
            ``cliff``.

    Signals:
        tick_Cliff_LEFT, tick_Cliff_CENTER, tick_Cliff_RIGHT: that sensor no longer detects the floor.
        tick_Cliff: `getCurrentCliff` was called.
    """

    side_field = "sensor"
    property_name = "cliff"
    states = ("floor", "cliff")

    @operation(name="getCurrentCliff")
    def get_current_cliff(self) -> None:
        """Signal ``tick_Cliff``; the properties are always current."""
        self.signal("tick_Cliff")
