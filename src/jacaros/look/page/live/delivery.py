"""Records on their way to pages: each is encoded once, for any number of pages.

For each page they wait in a bounded queue. A page that connects late gets the last part of the run, and the state
before it.
"""

import asyncio
from collections import deque
from collections.abc import Callable, Mapping
from heapq import merge
from operator import attrgetter
from typing import Any

from msgspec import to_builtins

from jacaros.look.page.scene import row_of
from jacaros.look.records.lasting import Lasting
from jacaros.look.records.line_format import encoded
from jacaros.look.records.records import EventLine, Frame, RecordingLine
from jacaros.runtime.clock import real_time
from jacaros.serving.service import Session

QUEUED = 10_000
"""Maximum number of records waiting for one page."""
PIECE = 200
"""Number of records per message, which take a few milliseconds to encode."""
AGAIN = 2.0
"""Seconds of real time between two restarts of a page that is too slow."""
EVENTS, FRAMES = 20_000, 3_000
"""Maximum number of records kept for later pages, without those of the state."""
LONGEST = 200_000
"""Maximum length of a record in bytes; the strings of a longer one are cut to `_CUT` characters."""
_CUT = 5_000


class LiveRecord:
    """A record, as in a line of a recording.

    Args:
        number: number of the record, in time order.
        data: the record.
        newest: subject of the record if only its newest record matters; None if every record matters.
    """

    __slots__ = ("_text", "data", "newest", "number")

    def __init__(self, number: int, data: RecordingLine, newest: str | None = None) -> None:
        self.number, self.data, self.newest = number, data, newest
        self._text: str | None = None

    @property
    def text(self) -> str:
        """The record as JSON. Most frames are superseded before a page needs it."""
        if self._text is None:
            data = self.data
            if isinstance(data, Frame):
                data = Frame(round(data.t, 3), tuple(map(row_of, data.robots)))
            self._text = json_text(data)
        return self._text


def json_text(data: object) -> str:
    """Return *data* as JSON that browsers can parse: null for NaN and infinity, strings of limited length."""
    written = encoded(data)
    if len(written) > LONGEST:
        written = encoded(_cut(to_builtins(data, enc_hook=str)))
    return written.decode()


def _cut(data: Any) -> Any:
    if isinstance(data, Mapping):
        return {key: _cut(value) for key, value in data.items()}
    if isinstance(data, list | tuple):
        return [_cut(each) for each in data]
    if isinstance(data, str) and len(data) > _CUT:
        return f"{data[:_CUT]} …"
    return data


class Delivery:
    """The records for one page.

    A page that is too slow loses records: it receives their number, and then everything from the beginning; see `hello`.

    Args:
        records: returns the records so far, which a new page needs.
        hello: first message of every beginning.

    Attributes:
        arrived: set while there is something to send.
        session: the session of the page in a run.
    """

    def __init__(self, records: Callable[[], list[LiveRecord]], hello: dict[str, object]) -> None:
        self._records, self._hello = records, hello
        self._queue: deque[LiveRecord] = deque()
        self._newest: dict[str, LiveRecord] = {}
        self._notes: deque[str] = deque([json_text(hello)])
        self._first: deque[LiveRecord] = deque(records())
        self._missed = 0
        self._again_at = 0.0
        self.session: Session | None = None
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


_number = attrgetter("number")


class Backlog:
    """A bounded number of records, and the state before them.

    Args:
        events: maximum number of records kept; older ones survive only in the state.
        frames: maximum number of frames kept.
    """

    def __init__(self, events: float = EVENTS, frames: float = FRAMES) -> None:
        self._before: Lasting[LiveRecord] = Lasting()
        self._events: deque[LiveRecord] = deque()
        self._frames: deque[LiveRecord] = deque()
        self._newest: dict[str, LiveRecord] = {}
        self._limits = events, frames

    def take(self, record: LiveRecord) -> None:
        """Add a record."""
        if isinstance(record.data, Frame):
            self._add(self._frames, record, self._limits[1])
        elif record.newest is not None:
            self._newest[record.newest] = record
        else:
            self._add(self._events, record, self._limits[0])

    def _add(self, kept: deque[LiveRecord], record: LiveRecord, limit: float) -> None:
        kept.append(record)
        if len(kept) > limit:
            forgotten = kept.popleft()
            match forgotten.data:
                case EventLine(event=event, data=data):
                    self._before.take(event, data, forgotten)
                case data:
                    self._before.take(type(data).__name__, {}, forgotten)

    def records(self) -> list[LiveRecord]:
        """Return the state, followed by all kept records, in time order."""
        newest = sorted(self._newest.values(), key=_number)
        before = sorted(self._before, key=_number)
        return [*before, *merge(self._events, self._frames, newest, key=_number)]
