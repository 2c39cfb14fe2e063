"""Frames of tf as properties, looked up at a fixed rate, or at the stamps of messages."""

from collections import deque
from collections.abc import Callable, Iterable, Mapping
from typing import NamedTuple

from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.streams import Values
from jacaros.robots.mapping.decoding import converted
from jacaros.robots.mapping.fields import FieldPart
from jacaros.robots.mapping.host import MappingHost
from jacaros.robots.mapping.properties import DerivedPart, FramePart
from jacaros.robots.plane.pose import pitch_of, roll_of
from jacaros.robots.ros.errors import CapabilityMissing, TransformUnavailable
from jacaros.robots.ros.protocols.transform import Transform
from jacaros.robots.ros.waiting import MISSING_AFTER
from jacaros.runtime.files.texts import is_worth_a_line
from jacaros.runtime.trace import Cause


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
        self._notes = [(note.name, note.path.text, converted(note.conversion)) for note in part.annotations]
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
        self._host.annotate(
            self._part.name,
            tuple(Structure(name, (convert(_part(transform, what)),)) for name, what, convert in self._notes),
        )
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


# Frames of tf at the stamps of messages, for derived entries that join the two.

OnTransform = Callable[[float, Values, dict[int, Values], Cause | None], None]
"""Called with the time of a message, its values, those of each frame at that time by the number of its stream, and
the cause."""


class _Message(NamedTuple):
    time: float
    values: Values
    cause: Cause | None
    until: float


class StampedFrames:
    """Look up frames at the stamps of messages, in the order of their arrival.

    A message waits until tf knows all frames at its stamp; after *patience* it is dropped.

    Args:
        host: the artifact.
        part: the derived entry.
        frames: by the numbers of their streams.
        patience: seconds.
        found: called with the result.
    """

    def __init__(
        self,
        host: MappingHost,
        part: DerivedPart,
        frames: Mapping[int, FramePart],
        patience: float,
        found: OnTransform,
    ) -> None:
        self._host, self._part, self._patience, self._found = host, part, patience, found
        self._frames = [
            (number, host.frame(each.target), host.frame(each.source), values_of(each.fields))
            for number, each in frames.items()
        ]
        self._messages: deque[_Message] = deque()
        self._is_waiting = False
        self._began = host.clock.elapsed
        self._dropped = 0

    def add(self, time: float, values: Values, cause: Cause | None) -> None:
        """Look up the frames at the time of a message."""
        self._messages.append(_Message(time, values, cause, self._host.clock.elapsed + self._patience))
        if not self._is_waiting and not self._find_all():
            self._is_waiting = True
            self._host.start(self._host.run_process, self._wait)

    def clear(self) -> None:
        """Forget the waiting messages."""
        self._messages.clear()

    def _find_all(self) -> bool:
        """Look up what tf already knows. Return whether no message is left."""
        lookup = self._host.ros.tf_lookup
        while self._messages:
            message = self._messages[0]
            try:
                found = {
                    number: values(lookup(target, source, message.time))
                    for number, target, source, values in self._frames
                }
            except TransformUnavailable as error:
                if error.reason != "too_old" and self._host.clock.elapsed < message.until:
                    return False
                self._drop(error)
                continue
            self._messages.popleft()
            self._found(message.time, message.values, found, message.cause)
        return True

    async def _wait(self) -> None:
        """Wait until tf knows the frames, or the time is over."""
        try:
            while not self._find_all():
                message = self._messages[0]
                for _, target, source, _ in self._frames:
                    left = max(0.0, message.until - self._host.clock.elapsed)
                    try:
                        await self._host.ros.tf_wait(target, source, message.time, left)
                    except TransformUnavailable:
                        break  # the next look-up drops it
        finally:
            self._is_waiting = False

    def _drop(self, error: TransformUnavailable) -> None:
        self._messages.popleft()
        if self._host.clock.elapsed - self._began < MISSING_AFTER:
            return  # tf may still be unknown
        self._dropped += 1
        if is_worth_a_line(self._dropped):
            part, count = self._part, self._dropped
            message = f"`{part.name}`: dropped {count} message{'s' if count > 1 else ''} without a transform: {error}"
            self._host.report_once(
                (part.name, "frames", count), part.place, message, "allow more time: lateness: 1"
            )
