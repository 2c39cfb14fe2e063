"""Records waiting for one page: bounded, and newest-only where only the newest record matters."""

import asyncio
from collections import deque
from collections.abc import Callable

from jacaros.inspector.live.records import LiveRecord, json_text
from jacaros.runtime.clock import real_time

QUEUED = 10_000
"""Maximum number of records waiting for one page."""
PIECE = 200
"""Number of records per message, which take a few milliseconds to encode."""
AGAIN = 2.0
"""Seconds of real time between two restarts of a page that is too slow."""


class Delivery:
    """The records for one page.

    A page that is too slow loses records: it receives their number, and then everything from the beginning; see `hello`.

    Args:
        records: returns the records so far, which a new page needs.
        hello: first message of every beginning.

    Attributes:
        arrived: set while there is something to send.
    """

    def __init__(self, records: Callable[[], list[LiveRecord]], hello: dict[str, object]) -> None:
        self._records, self._hello = records, hello
        self._queue: deque[LiveRecord] = deque()
        self._newest: dict[str, LiveRecord] = {}
        self._notes: deque[str] = deque([json_text(hello)])
        self._first: deque[LiveRecord] = deque(records())
        self._missed = 0
        self._again_at = 0.0
        self.arrived = asyncio.Event()
        self.arrived.set()

    def allow(self, commands: list[str]) -> None:
        """Tell the page which commands are available from now on."""
        self._hello["can"] = commands
        self._notes.append(json_text({"kind": "can", "can": commands}))
        self.arrived.set()

    def offer(self, record: LiveRecord) -> None:
        """Take a new record; never waits."""
        if record.newest is not None:
            self._newest[record.newest] = record
        elif self._missed:
            self._missed += 1
        elif len(self._queue) >= QUEUED:
            self._missed = len(self._queue) + len(self._first) + 1
            self._queue.clear()
            self._first.clear()
        else:
            self._queue.append(record)
        self.arrived.set()

    def take(self) -> str | None:
        """Return the next message, None if there is nothing to send."""
        if self._missed and real_time() >= self._again_at:
            self._begin_again()
        if self._notes:
            return self._notes.popleft()
        records = _piece(self._first) or _piece(self._queue)
        if not self._first and not self._queue:
            # Last, because the page expects records in time order.
            records += sorted(self._newest.values(), key=lambda each: each.number)
            self._newest.clear()
        if not records:
            self.arrived.clear()
            return None
        return f"[{','.join(each.text for each in records)}]"

    @property
    def complete(self) -> bool:
        """Whether nothing is waiting."""
        return not (self._missed or self._notes or self._first or self._queue or self._newest)

    def _begin_again(self) -> None:
        self._notes.append(json_text({"kind": "missed", "records": self._missed}))
        self._notes.append(json_text(self._hello))
        self._first = deque(self._records())
        self._missed = 0
        self._newest.clear()
        self._again_at = real_time() + AGAIN


def _piece(waiting: deque[LiveRecord]) -> list[LiveRecord]:
    return [waiting.popleft() for _ in range(min(PIECE, len(waiting)))]
