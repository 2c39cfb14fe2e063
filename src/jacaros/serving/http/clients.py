"""Clients over HTTP: a session for each caller, which ends some time after its last request."""

import asyncio
import json
import time
from collections.abc import Callable, Coroutine, Iterable, Mapping
from contextlib import suppress
from typing import Any, TypeVar

from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.crossing import Crossing, Lagging, Outbox, Reply
from jacaros.serving.goals import OVER
from jacaros.serving.service import Event, Service, Session

T = TypeVar("T")
LEASE = 15.0
"""Seconds after its last request, and the end of its last event stream, when a caller counts as gone."""
MOST_STREAMS = 128
"""Maximum number of event streams of one caller."""

Stream = Outbox[str | None]
"""Events as JSON for one stream; None ends it."""


class Client:
    """A caller over HTTP. Methods that begin with an underscore belong to the loop of the run.

    Args:
        caller: who it is.
        crossing: the way to the run.
        service: the service of the run.
    """

    def __init__(self, caller: Caller, crossing: Crossing, service: Service) -> None:
        self.caller = caller
        self._crossing, self._service = crossing, service
        self._session: Session | None = None
        self.streams: dict[Stream, None] = {}
        self._busy, self._seen = 0, time.monotonic()
        self._events = Outbox[tuple[Event, Stream | None]](asyncio.get_running_loop())
        self._distributing: asyncio.Task[None] | None = None

    # ---- requests

    async def do(self, request: Callable[[Session], T]) -> T:
        """Call a function with the session, on the loop of the run."""
        with self._present():
            return await self._crossing.call(lambda: request(self._opened()))

    def ask(self, request: Callable[[Session, Reply[T]], object]) -> "asyncio.Future[T]":
        """Call a function with the session and what takes the answer, now or later, on the loop of the run."""
        answer: asyncio.Future[T] = self._crossing.ask(lambda reply: request(self._opened(), reply))
        self.came()
        answer.add_done_callback(lambda _: self.went())
        return answer

    async def wait(self, request: Callable[[Session], Coroutine[Any, Any, T]]) -> T:
        """Await a coroutine function with the session, on the loop of the run."""

        async def start() -> T:
            return await request(self._opened())

        with self._present():
            return await self._crossing.wait(start)

    def _present(self) -> "_Presence":
        return _Presence(self)

    def came(self) -> None:
        """The caller is here."""
        self._busy += 1

    def went(self) -> None:
        """A request of the caller has ended."""
        self._busy -= 1
        self._seen = time.monotonic()

    @property
    def is_gone(self) -> bool:
        """Whether the caller has no stream and has not asked for some time."""
        return not self._busy and not self.streams and time.monotonic() - self._seen > LEASE

    async def leave(self) -> None:
        """End the session."""
        await self._crossing.call(self._close)
        if self._distributing is not None:
            self._distributing.cancel()

    def _close(self) -> None:
        if self._session is not None:
            self._session.close()

    def _opened(self) -> Session:
        if self._session is None or self._session.closed:
            self._session = self._service.open(self.caller)
        return self._session

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
        if self._distributing is None:
            self._distributing = asyncio.create_task(self._distribute())
        try:
            return stream, await self.do(lambda session: self._listen(session, stream, list(beliefs)))
        except BaseException:
            self.streams.pop(stream)
            raise

    async def end(self, stream: Stream, stop: Callable[[], None]) -> None:
        """End a stream."""
        self.streams.pop(stream, None)
        self._seen = time.monotonic()
        with suppress(RequestError):
            await self._crossing.call(stop)

    def _listen(self, session: Session, stream: Stream, beliefs: list[tuple[str, str]]) -> Callable[[], None]:
        ends: list[Callable[[], None]] = []

        def stop() -> None:
            for end in ends:
                end()

        try:
            for agent, name in beliefs:
                ends.append(self._watch(session, stream, agent, name))
        except RequestError:
            stop()
            raise
        if self._hear not in session.listeners:
            session.listen(self._hear)
        for goal in session.goals():
            if not goal.over:
                self._events.put(({"event": "goal", **goal.data()}, stream))
        return stop

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
                told = encoded(event)
                for stream in tuple(self.streams) if only is None else (only,):
                    stream.put(told, _subject(event))

    def end_streams(self) -> None:
        """End all streams."""
        for stream in self.streams:
            stream.put(None)


class _Presence:
    def __init__(self, client: Client) -> None:
        self._client = client

    def __enter__(self) -> None:
        self._client.came()

    def __exit__(self, *_: object) -> None:
        self._client.went()


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


class Clients:
    """All clients, by caller.

    Args:
        crossing: the way to the run.
        service: the service of the run.
    """

    def __init__(self, crossing: Crossing, service: Service) -> None:
        self._crossing, self._service = crossing, service
        self._known: dict[Caller, Client] = {}

    def of(self, caller: Caller) -> Client:
        """Return the client of a caller."""
        found = self._known.get(caller)
        if found is None:
            found = self._known[caller] = Client(caller, self._crossing, self._service)
        return found

    async def look(self) -> None:
        """End the sessions of callers that are gone, again and again."""
        while True:
            await asyncio.sleep(LEASE / 10)
            for client in tuple(self._known.values()):
                if client.is_gone:
                    del self._known[client.caller]
                    with suppress(RequestError):
                        await client.leave()

    def close(self) -> None:
        """End all streams: the run has ended."""
        for client in self._known.values():
            client.end_streams()
