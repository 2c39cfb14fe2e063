"""Frames of tf as properties, looked up at a fixed rate."""

from collections.abc import Callable, Iterable

from jacaros.robots.mapping.decoding import converted
from jacaros.robots.mapping.fields import FieldPart
from jacaros.robots.mapping.host import MappingHost
from jacaros.robots.mapping.properties import FramePart
from jacaros.robots.plane.pose import pitch_of, roll_of
from jacaros.robots.ros.errors import CapabilityMissing, TransformUnavailable
from jacaros.robots.ros.protocols.transform import Transform
from jacaros.robots.ros.waiting import MISSING_AFTER
from jacaros.robots.streams import Values


class FrameUpdater:
    """A property from a transform; it exists while the transform is known.

    Args:
        host: the artifact.
        part: its declaration.
    """

    def __init__(self, host: MappingHost, part: FramePart) -> None:
        self._host, self._part = host, part
        self._target, self._source = host.frame(part.target), host.frame(part.source)
        self._reading = host.reading_of(part.name, part.policy)
        self._values = values_of(part.fields)
        self._taps = host.taps.get(part.name, ())
        self._reported = -1.0
        self._began = host.clock.elapsed
        try:
            host.ros.tf_listen()
        except CapabilityMissing as error:
            host.fail(f"{host.mapping.where(part.place)}: {error}", "ros_error", host.name)
        self._look()

    def _look(self) -> None:
        self._timer = self._host.clock.call_later(1.0 / self._part.rate, self._look)
        try:
            transform = self._host.ros.tf_lookup(self._target, self._source)
        except TransformUnavailable as error:
            self._lose(error)
            return
        oldest = self._part.oldest
        if oldest is not None and 0.0 < transform.stamp < self._host.clock.now() - oldest:
            self._withdraw()
            return
        values = self._values(transform)
        self._reading.take(values)
        if self._taps and (transform.stamp != self._reported or not transform.stamp):
            self._reported = transform.stamp
            for tap in self._taps:
                tap(transform.stamp, values, None)

    def _lose(self, error: TransformUnavailable) -> None:
        self._withdraw()
        part = self._part
        if self._host.clock.elapsed - self._began >= MISSING_AFTER:
            message = f"`{part.name}` is unknown: {error}; still listening"
            self._host.report_once(
                part.name, part.place, message, "are the nodes that publish these frames running?"
            )

    def _withdraw(self) -> None:
        if self._reading.newest is not None:
            self._reading.withdraw()
            for tap in self._taps:
                tap(0.0, None, None)

    def close(self) -> None:
        """Stop the look-ups."""
        self._timer.cancel()


def values_of(fields: Iterable[FieldPart]) -> Callable[[Transform], Values]:
    """Return a function that reads the shown values of a transform."""
    parts = [(field.path.text, converted(field.conversion)) for field in fields]
    return lambda transform: tuple([convert(_part(transform, what)) for what, convert in parts])


_PARTS: dict[str, Callable[[Transform], float]] = {
    "x": lambda transform: transform.translation[0],
    "y": lambda transform: transform.translation[1],
    "z": lambda transform: transform.translation[2],
    "roll": lambda transform: roll_of(*transform.rotation),
    "pitch": lambda transform: pitch_of(*transform.rotation),
    "yaw": lambda transform: transform.yaw,
    "stamp": lambda transform: transform.stamp,
}


def _part(transform: Transform, what: str) -> float:
    return float(_PARTS[what](transform))
