"""Wait for the first subscription of a publisher: what it sends before is lost, and no error says so."""

import math
from collections import deque
from collections.abc import Callable, Iterator, Mapping

from jacaros.artifacts.ros.options import Reader, one_of, positive
from jacaros.ros.backend import Publisher

MATCH_TIMEOUT = 3.0
"""Seconds that an operation waits for a subscription by default.  First discovery on ROS 2 can take two."""

MATCH_OPTIONS: Mapping[str, Reader] = {"match_timeout": positive, "unmatched": one_of("warn", "fail")}
"""Options of artifacts whose operations publish."""

LOOK = 0.05
"""Seconds between two looks at the number of subscriptions."""

TURN = 0.005
"""Seconds between two looks at the messages that wait in front."""

SETTLING = 0.2
"""Seconds between the first match and the first message: the other end may have to match too, as may a bridge's own
publisher and further subscriptions."""


Missed = Callable[[str, float, bool], None]
"""Takes the topic, the seconds, and whether the wait before was in vain as well."""


class Matching:
    """Paces the operations that publish on one topic, so that the first message arrives.

    Args:
        publisher: sends the messages.
        timeout: seconds to wait; 0.0 in a graph where subscriptions are matched immediately.
        missed: called when no subscription was matched in time; an exception ends the operation.
    """

    def __init__(self, publisher: Publisher, timeout: float, missed: Missed) -> None:
        self._publisher = publisher
        self._timeout = timeout
        self._missed = missed
        self._vain = False
        self._line: deque[object] = deque()
        """The messages that wait, in order: a later one must not overtake them when a subscription is matched."""

    def exists(self) -> bool:
        """Whether a message may be sent now: a subscription is matched, and no earlier message waits."""
        return not self._line and self._matched()

    def _matched(self) -> bool:
        if self._publisher.subscription_count:
            self._vain = False
            return True
        return False

    def pauses(self, always: bool = False) -> Iterator[float]:
        """Give the seconds to pause, one pause after the other, until messages arrive or the time is over.

        There are none while a subscription is matched.  After a wait in vain there are none either until one has been
        matched, so that a topic without subscribers delays only the first operation.  The message must be sent as soon
        as there are no more pauses: the next one in line may go then.

        Args:
            always: wait again after a wait in vain: for open-loop motions, which go wrong when a command is lost.
        """
        if self.exists():
            return
        ticket = object()
        self._line.append(ticket)
        try:
            for _ in range(math.ceil(self._timeout / TURN)):
                if self._line[0] is ticket:
                    break
                yield TURN
            while self._line[0] is not ticket:  # those in front are suspended, and lose their place
                self._line.popleft()
            yield from self._first_pauses(always)
        finally:
            if ticket in self._line:
                self._line.remove(ticket)

    def _first_pauses(self, always: bool) -> Iterator[float]:
        """Give the pauses of the first message in line."""
        if self._matched():  # those in front have waited
            return
        if not self._vain or always:
            for _ in range(math.ceil(self._timeout / LOOK)):
                yield LOOK
                if self._matched():
                    yield SETTLING
                    return
        again, self._vain = self._vain, True
        self._missed(self._publisher.topic, self._timeout, again)
