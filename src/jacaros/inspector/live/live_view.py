"""A run as shown on its live pages: receives the watch's records, keeps a bounded part, and delivers it."""

from collections.abc import Iterable, Mapping
from typing import Any

from jacaros.inspector.live.commands import Commands
from jacaros.inspector.live.delivery import Delivery
from jacaros.inspector.live.past import Past
from jacaros.inspector.live.records import FrameRecord, LiveRecord, hello
from jacaros.inspector.scene import RobotView
from jacaros.mas.history.records import VERSION, Happened, Line, Text, World

_NEWEST = ("laser", "believed")
"""Events of which only the newest for each robot matters."""


class LiveView:
    """Delivers a run to pages; receives records like a recorder, see `jacaros.inspector.watch.Watcher`.

    Args:
        title: title of the page.
        commands: commands available to pages.
        live: whether the run continues; False for a recording.
    """

    def __init__(self, title: str, commands: Commands, live: bool = True) -> None:
        self._title, self._commands, self._live = title, commands, live
        self._past = Past()
        self._deliveries: list[Delivery] = []
        self._number = 0
        self._last: FrameRecord | None = None
        self._held: LiveRecord | None = None
        """The last frame, if nothing has moved since the previous one."""

    # ---- records of the watch

    def world(self, drawing: Mapping[str, Any]) -> None:
        """Show the world."""
        self._take(World(version=VERSION, world=dict(drawing)))

    def frame(self, t: float, robots: Iterable[RobotView]) -> None:
        """Show the robots at a time."""
        self._number += 1
        frame = FrameRecord(self._number, t, list(robots))
        if self._last is not None and self._last.robots == frame.robots:
            self._held = frame  # pages see that time passes, but the frame is not stored
        else:
            if self._held is not None:
                self._past.take(self._held)
            self._past.take(frame)
            self._last, self._held = frame, None
        self._offer(frame)

    def text(self, t: float, agent: str, text: str) -> None:
        """Show a line of an agent's output."""
        self._take(Text(round(t, 3), agent, text))

    def event(self, t: float, kind: str, data: Mapping[str, Any]) -> None:
        """Show an event."""
        newest = f"{kind} {data.get('robot')}" if kind in _NEWEST else None
        self._take(Happened(t, kind, data), newest)

    def commands_changed(self) -> None:
        """Tell the pages which commands are available from now on."""
        for delivery in self._deliveries:
            delivery.allow(self._commands.names)

    def close(self) -> None:
        """Do nothing: there is nothing to close."""

    def _take(self, data: Line, newest: str | None = None) -> None:
        record = self._record(data, newest)
        self._past.take(record)
        self._offer(record)

    def _record(self, data: Line, newest: str | None) -> LiveRecord:
        self._number += 1
        return LiveRecord(self._number, data, newest)

    def _offer(self, record: LiveRecord) -> None:
        for delivery in self._deliveries:
            delivery.offer(record)

    # ---- requests of the server

    def begin(self) -> Delivery:
        """Start delivering to another page."""
        delivery = Delivery(self._past.records, hello(self._title, self._live, self._commands.names))
        self._deliveries.append(delivery)
        return delivery

    def end(self, delivery: Delivery) -> None:
        """Stop delivering to a page."""
        self._deliveries.remove(delivery)

    async def answer(self, command: Mapping[str, Any]) -> Mapping[str, Any]:
        """Execute a command of a page."""
        return await self._commands.answer(command)
