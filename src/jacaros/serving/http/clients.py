"""Clients over HTTP, and their event streams."""

import asyncio
import json
from collections.abc import Callable, Iterable, Mapping
from contextlib import ExitStack, suppress
from typing import Any

from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.crossing import Crossing, Lagging, Outbox
from jacaros.serving.goals import OVER
from jacaros.serving.remote import RemoteCaller
from jacaros.serving.service import Event, Service, Session

MOST_STREAMS = 128
"""Maximum number of event streams of one caller."""
REMEMBERED = 1_000_000
"""Maximum number of characters of the events whose JSON is remembered, beside the newest."""

Stream = Outbox[str | None]
"""Events as JSON for one stream; None ends it."""


class Encoder:
    """Encodes each event once for all streams of all callers."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[Event, str]] = {}
        self._size = 0

    def text(self, event: Event) -> str:
        """Return an event as JSON."""
        key = id(event.get("beliefs", event))  # streams have events of their own about the same beliefs
        if key not in self._known:
            while self._size > REMEMBERED:
                self._size -= len(self._known.pop(next(iter(self._known)))[1])
            self._known[key] = event, encoded(event)  # with the event, so that no other gets its id
            self._size += len(self._known[key][1])
        return self._known[key][1]


class Client(RemoteCaller):
    """A caller over HTTP, with its event streams."""

    def __init__(self, caller: Caller, crossing: Crossing, service: Service, encoder: Encoder) -> None:
        super().__init__(caller, crossing, service)
        self._encoder = encoder
        self.streams: dict[Stream, None] = {}
        self._events = Outbox[tuple[Event, Stream | None]](asyncio.get_running_loop())
        self._distributing: asyncio.Task[None] | None = None

    async def leave(self) -> None:
        """End the session."""
        await super().leave()
        if self._distributing is not None:
            self._distributing.cancel()

    # ---- events

    async def begin(self, beliefs: Iterable[tuple[str, str]]) -> tuple[Stream, Callable[[], None]]:
        """Begin a stream: goals that have not ended, beliefs as they are now, and then all changes.

        Args:
            beliefs: agents and names of the beliefs to watch.

        Returns:
            The stream, and a function that stops watching the beliefs, for the loop of the run.
        """
        if len(self.streams) >= MOST_STREAMS:
            raise RequestError("too_many_requests", f"{self.caller} has {MOST_STREAMS} event streams")
        stream = Stream(asyncio.get_running_loop())
        self.streams[stream] = None
        self.came()
        if self._distributing is None:
            self._distributing = asyncio.create_task(self._distribute())
        try:
            return stream, await self.do(lambda session: self._listen(session, stream, list(beliefs)))
        except BaseException:
            self._forget(stream)
            raise

    async def end(self, stream: Stream, stop: Callable[[], None]) -> None:
        """End a stream."""
        self._forget(stream)
        with suppress(RequestError):
            await self._crossing.call(stop)

    def _forget(self, stream: Stream) -> None:
        self.streams.pop(stream)
        self.went()

    def _listen(self, session: Session, stream: Stream, beliefs: list[tuple[str, str]]) -> Callable[[], None]:
        with ExitStack() as ends:
            for agent, name in beliefs:
                ends.callback(self._watch(session, stream, agent, name))
            if self._hear not in session.listeners:
                session.listen(self._hear)
            for goal in session.goals():
                if not goal.over:
                    self._events.put(({"event": "goal", **goal.data()}, stream))
            return ends.pop_all().close

    def _watch(self, session: Session, stream: Stream, agent: str, name: str) -> Callable[[], None]:
        subject = "belief", agent, name, id(stream)

        def tell(facts: Any) -> None:
            event = {"event": "belief", "agent": agent, "name": name, "beliefs": facts}
            self._events.put((event, stream), subject)  # not to the stream, which would be a wake-up for each

        return session.watch(agent, name, tell)

    def _hear(self, event: Event) -> None:
        self._events.put((event, None))

    async def _distribute(self) -> None:
        while True:
            try:
                events = await self._events.take()
            except Lagging:
                self.end_streams()
                self._events = Outbox(asyncio.get_running_loop())
                continue
            for event, only in events:
                told = self._encoder.text(event)
                for stream in tuple(self.streams) if only is None else (only,):
                    stream.put(told, _subject(event))

    def end_streams(self) -> None:
        """End all streams."""
        for stream in self.streams:
            stream.put(None)


def _subject(event: Event) -> tuple[str, ...] | None:
    """Return of what only the newest event matters: the progress of a goal, but not its states."""
    if event["event"] == "belief":
        return "belief", event["agent"], event["name"]
    if event["event"] != "goal" or event["state"] in OVER:
        return None
    return "goal", event["id"], event["state"]


def encoded(data: Mapping[str, Any]) -> str:
    """Return JSON in one line."""
    return json.dumps(data, separators=(",", ":"))
