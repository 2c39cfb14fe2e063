"""Records on their way to pages: each is encoded once, for any number of pages."""

from collections.abc import Mapping, Sequence
from typing import Any

from msgspec import to_builtins

from jacaros.inspector.line_format import encoded
from jacaros.inspector.scene import RobotView, row_of
from jacaros.mas.history.records import VERSION, Frame, Line

LONGEST = 200_000
"""Maximum length of a record in characters; the strings of a longer one are cut to `_CUT` characters."""
_CUT = 5_000


class LiveRecord:
    """A record, as in a line of a recording.

    Args:
        number: number of the record, in time order.
        data: the record; None for a frame.
        newest: subject of the record if only its newest record matters; None if every record matters.
    """

    __slots__ = ("_text", "data", "newest", "number")

    def __init__(self, number: int, data: Line | None, newest: str | None = None) -> None:
        self.number, self.data, self.newest = number, data, newest
        self._text: str | None = None

    @property
    def text(self) -> str:
        """The record as JSON."""
        if self._text is None:
            self._text = json_text(self.data)
        return self._text


class FrameRecord(LiveRecord):
    """A frame: the robots at a time. Most frames are superseded before a page needs their data.

    Args:
        number: number of the record.
        t: seconds since the start of the run.
        robots: the robots.
    """

    __slots__ = ("robots", "t")

    def __init__(self, number: int, t: float, robots: Sequence[RobotView]) -> None:
        super().__init__(number, None, "frame")
        self.t, self.robots = t, robots

    @property
    def text(self) -> str:
        """The record as JSON."""
        if self._text is None:
            rows = tuple(map(row_of, self.robots))
            self._text = json_text(Frame(round(self.t, 3), rows))
        return self._text


def hello(title: str, live: bool, can: Sequence[str]) -> dict[str, Any]:
    """Return the first message to a page: its title, whether the run continues, and the available commands."""
    return {"kind": "hello", "version": VERSION, "title": title, "live": live, "can": can}


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
