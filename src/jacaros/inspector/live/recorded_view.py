"""A recorded run on the page of live runs, without a run."""

from collections.abc import Iterator, Mapping
from heapq import merge
from operator import attrgetter
from typing import Any

from jacaros.inspector.live.commands import Commands, Given, number_in, text_in
from jacaros.inspector.live.delivery import Delivery
from jacaros.inspector.live.records import LiveRecord, hello
from jacaros.inspector.page import lines_of, title_of
from jacaros.inspector.recording import Recording
from jacaros.mas.history.records import Line
from jacaros.mas.history.why import explain


class RecordedView:
    """Delivers a recording to pages; see `jacaros.inspector.live.server.Source`.

    Args:
        recording: the recording.
        title: title of the page; the name of the project or the world by default.
    """

    def __init__(self, recording: Recording, title: str | None = None) -> None:
        self._recording = recording
        self._records = [LiveRecord(number, each) for number, each in enumerate(_all_records(recording))]
        self._commands = Commands()
        self._commands.add({"why": self._why})
        self._hello = hello(title or title_of(recording), live=False, can=self._commands.names)

    def records(self) -> list[LiveRecord]:
        """Return all records."""
        return self._records

    def begin(self) -> Delivery:
        """Start delivering to another page."""
        return Delivery(self.records, self._hello)

    def end(self, delivery: Delivery) -> None:
        """Stop delivering; nothing is kept open."""

    async def answer(self, command: Mapping[str, Any]) -> Mapping[str, Any]:
        """Execute a command of a page."""
        return await self._commands.answer(command)

    def _why(self, given: Given) -> str:
        at = number_in(given, "at") if given.get("at") is not None else None
        return explain(self._recording.events, text_in(given, "question"), at).text()


def _all_records(recording: Recording) -> Iterator[Line]:
    """Yield the records of a recording in time order; at equal times frames come first."""
    world, *others = lines_of(recording)
    yield world
    yield from merge(recording.frames, others, key=attrgetter("t"))
