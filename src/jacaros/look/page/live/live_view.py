"""A run or a recording as shown on live pages: keeps a part of its records, delivers them, and executes commands."""

from collections.abc import Callable, Iterable, Mapping
from heapq import merge
from math import inf
from operator import attrgetter
from typing import Any

from jacaros.look.page.live.commands import Commands, Text
from jacaros.look.page.live.delivery import EVENTS, FRAMES, Backlog, Delivery, LiveRecord
from jacaros.look.page.page import lines_of, story_record, title_of
from jacaros.look.page.scene import RobotView
from jacaros.look.records import records
from jacaros.look.records.recording import Recording
from jacaros.look.records.records import VERSION, FiniteNumber, Frame
from jacaros.look.why.why import explain
from jacaros.serving.service import Session

_NEWEST = ("laser", "believed")
"""Events of which only the newest for each robot matters."""


class LiveView:
    """Delivers a run to pages; receives records like a recorder, see `jacaros.look.page.watch.Watcher`.

    Args:
        title: title of the page.
        commands: commands available to pages.
        live: whether the run continues; False for a recording, of which everything is kept.
        open_session: opens the session of another page.
    """

    def __init__(
        self,
        title: str,
        commands: Commands,
        live: bool = True,
        open_session: Callable[[], Session | None] = lambda: None,
    ) -> None:
        self._title, self._commands, self._live = title, commands, live
        self._open_session = open_session
        self._past = Backlog(EVENTS, FRAMES) if live else Backlog(inf, inf)
        self._deliveries: list[Delivery] = []
        self._number = 0
        self._last: Frame | None = None
        self._held: LiveRecord | None = None
        """The last frame, if nothing has moved since the previous one."""

    @classmethod
    def of_recording(cls, recording: Recording) -> "LiveView":
        """Return a view of a recording, which answers questions."""

        def why(question: Text, at: FiniteNumber | None = None) -> str:
            return explain(recording.events, question, at).text()

        commands = Commands()
        commands.add({"why": why})
        view = cls(title_of(recording), commands, live=False)
        world, *others = lines_of(recording)
        # In time order; at equal times frames come first.
        for record in (world, *merge(recording.frames, others, key=attrgetter("t"))):
            view.take(record)
        view.take(story_record(recording))
        return view

    # ---- records of the watch

    def world(self, drawing: Mapping[str, Any]) -> None:
        """Show the world."""
        self.take(records.WorldLine(version=VERSION, world=dict(drawing)))

    def frame(self, t: float, robots: Iterable[RobotView]) -> None:
        """Show the robots at a time."""
        data = Frame(t, list(robots))
        record = self._record(data, "frame")
        if self._last is not None and self._last.robots == data.robots:
            self._held = record  # pages see that time passes, but the frame is not stored
        else:
            if self._held is not None:
                self._past.take(self._held)
            self._past.take(record)
            self._last, self._held = data, None
        self._offer(record)

    def text(self, t: float, agent: str, text: str) -> None:
        """Show a line of an agent's output."""
        self.take(records.TextLine(round(t, 3), agent, text))

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Show an event."""
        newest = f"{kind} {data.get('robot')}" if kind in _NEWEST else None
        self.take(records.EventLine(t, kind, data), newest)

    def commands_changed(self) -> None:
        """Tell the pages which commands are available from now on."""
        for delivery in self._deliveries:
            delivery.allow(self._commands.names)

    def close(self) -> None:
        """Do nothing: there is nothing to close."""

    def take(self, data: records.RecordingLine, newest: str | None = None) -> None:
        """Keep and deliver a record. Of those with the same subject in *newest*, only the last one matters."""
        record = self._record(data, newest)
        self._past.take(record)
        self._offer(record)

    def _record(self, data: records.RecordingLine, newest: str | None) -> LiveRecord:
        self._number += 1
        return LiveRecord(self._number, data, newest)

    def _offer(self, record: LiveRecord) -> None:
        for delivery in self._deliveries:
            delivery.offer(record)

    # ---- requests of the server

    def begin(self) -> Delivery:
        """Start delivering to another page; its first message has the title, and what the page can do."""
        hello = {"kind": "hello", "version": VERSION, "title": self._title, "live": self._live}
        delivery = Delivery(self._past.records, {**hello, "can": self._commands.names})
        delivery.session = self._open_session()
        self._deliveries.append(delivery)
        return delivery

    def end(self, delivery: Delivery) -> None:
        """Stop delivering to a page."""
        self._deliveries.remove(delivery)
        if delivery.session is not None:
            delivery.session.close()

    async def answer(self, delivery: Delivery, command: Mapping[str, Any]) -> Mapping[str, Any]:
        """Execute a command of a page."""
        return await self._commands.answer(command, delivery.session)
