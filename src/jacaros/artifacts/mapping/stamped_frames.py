"""Frames of tf at the stamps of messages, for derived entries that join the two."""

from collections import deque
from collections.abc import Callable, Mapping
from typing import NamedTuple

from jacaros.artifacts.kit.reading import Values
from jacaros.artifacts.mapping.declared import DerivedPart, FramePart
from jacaros.artifacts.mapping.frames import values_of
from jacaros.artifacts.mapping.host import Host
from jacaros.files.texts import is_worth_a_line
from jacaros.ros.errors import TransformUnavailable
from jacaros.ros.waiting import MISSING_AFTER
from jacaros.runtime.trace import Cause

Found = Callable[[float, Values, dict[int, Values], Cause | None], None]
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
        self, host: Host, part: DerivedPart, frames: Mapping[int, FramePart], patience: float, found: Found
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
