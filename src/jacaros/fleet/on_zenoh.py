"""The carrier on Eclipse Zenoh: a datagram is a publication, presence a liveliness token.

Zenoh finds the other members, secures and routes what they send, and notices when one ends. Its callbacks run in threads
of its own; here they are passed on to the event loop.
"""

import asyncio
import queue
import threading
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from functools import lru_cache
from itertools import count
from typing import Any

import zenoh

from jacaros.fleet.carrier import Listener, MemberId
from jacaros.fleet.network import Network, NoRouter, open_session, session_config
from jacaros.runtime.errors import JacarosError

_ROOT = "jacaros"
_MOST = 100_000
"""Arrivals that wait for the event loop at most; more are dropped, as by a network, and sent again."""
_MEMBERS = 1000
"""Keys whose member is remembered."""
_TOKEN, _DATAGRAM = 5, 8
"""Parts of the keys of liveliness tokens and of datagrams."""
_CLOSING = 1.0
"""Seconds that a thread of Zenoh has to end."""
_TRY = 1.0
"""Seconds between attempts to reach a router."""
_REMIND = 5
"""Attempts between lines about them."""


def _named(key: str) -> MemberId | None:
    """Return the member whose token or datagram has this key."""
    parts = key.split("/")
    return MemberId(parts[-2], parts[-1]) if len(parts) in (_TOKEN, _DATAGRAM) else None


class ZenohCarrier:
    """A carrier on Zenoh.

    Args:
        network: which fleet, and how it is reached.
        log: takes a line about a router that does not answer.
    """

    def __init__(self, network: Network, log: Callable[[str], None] = lambda line: None) -> None:
        self._network = network
        self._log = log
        self._waiting: asyncio.Task[None] | None = None
        self._is_closed = False
        self._root = f"{_ROOT}/{network.fleet}"
        self._session: Any = None
        self._publishers: dict[MemberId, Any] = {}
        self._keys: dict[MemberId, Any] = {}
        self._arrived: deque[tuple[str, Any]] = deque()
        self._is_called = False
        self._loop: asyncio.AbstractEventLoop | None = None
        self._listener: Listener | None = None
        self._me = MemberId("", "")
        self._declared: list[Any] = []
        self._named = lru_cache(_MEMBERS)(_named)
        self._threads = 0
        self._ended: queue.SimpleQueue[threading.Thread] = queue.SimpleQueue()

    async def open(self, me: MemberId, listener: Listener) -> None:
        """Open the session, or keep trying in the background: a robot without its router must run, too.

        See `jacaros.fleet.carrier.Carrier.open`.
        """
        self._me, self._listener = me, listener
        self._loop = asyncio.get_running_loop()
        try:
            await self._connect()
        except NoRouter as missing:
            self._log(f"warning: waiting for a router: {missing}")
            self._waiting = self._loop.create_task(self._wait())

    async def _connect(self) -> None:
        for kind, sample in await asyncio.to_thread(self._open):
            self._arrive(kind, sample)

    async def _wait(self) -> None:
        """Try again until a router answers."""
        for attempt in count(1):
            await asyncio.sleep(_TRY)
            try:
                await self._connect()
            except NoRouter as missing:
                if attempt % _REMIND == 0:
                    self._log(f"warning: still waiting for a router: {missing}")
            except JacarosError as error:
                self._log(str(error))
                break
            else:
                self._log("connected to a router")
                break

    def _open(self) -> list[tuple[str, Any]]:
        session = open_session(session_config(self._network))
        if self._is_closed:  # while this thread was waiting
            session.close()  # type: ignore[no-untyped-call]  # the stub of Zenoh says nothing of it
            return []
        self._session = session
        me = self._me
        self._declared = [
            session.declare_subscriber(
                f"{self._root}/to/{me.name}/{me.incarnation}/from/**", self._calling(self._on_datagram)
            ),
            session.liveliness().declare_subscriber(
                f"{self._root}/member/**", self._calling(self._on_token), history=False
            ),
        ]
        known = [
            ("token", reply.ok) for reply in session.liveliness().get(f"{self._root}/member/**") if reply.ok
        ]
        self._declared.append(
            session.liveliness().declare_token(f"{self._root}/member/{me.name}/{me.incarnation}")
        )
        if self._network.routers:
            self._declared.append(
                session.info.declare_transport_events_listener(
                    self._calling(self._on_transport), history=False
                )
            )
        return known

    def _calling(self, callback: Callable[[Any], None]) -> Any:
        """Return a handler that calls *callback* in a thread of its own, which is noted when it ends."""
        self._threads += 1
        return zenoh.handlers.Callback(callback, lambda: self._ended.put(threading.current_thread()))

    # ---- in threads of Zenoh

    def _on_transport(self, event: Any) -> None:
        routers = " or ".join(self._network.routers)
        is_there = event.kind == zenoh.SampleKind.PUT
        line = (
            "connected to a router again"
            if is_there
            else f"warning: lost the router; trying to reach {routers}"
        )
        if self._loop is not None and not self._is_closed:
            with suppress(RuntimeError):  # the loop is closed
                self._loop.call_soon_threadsafe(self._log, line)

    def _on_datagram(self, sample: Any) -> None:
        self._pass_on("datagram", sample)

    def _on_token(self, sample: Any) -> None:
        self._pass_on("token", sample)

    def _pass_on(self, kind: str, sample: Any) -> None:
        if len(self._arrived) < _MOST or kind == "token":
            self._arrived.append((kind, sample))
            if not self._is_called and self._loop is not None:
                self._is_called = True
                with suppress(RuntimeError):  # the loop is closed
                    self._loop.call_soon_threadsafe(self._take)

    # ---- on the event loop

    def _take(self) -> None:
        """Take what has arrived."""
        self._is_called = False  # first: what arrives from now on calls again
        for _ in range(len(self._arrived)):
            self._arrive(*self._arrived.popleft())
        if self._listener is not None:
            self._listener.all_received()

    def _arrive(self, kind: str, sample: Any) -> None:
        if self._session is None or self._listener is None:
            return
        key = str(sample.key_expr)
        member = self._named(key)
        if member is None:
            self._listener.refused(key, "a key of no member")
        elif kind == "datagram":
            self._listener.received(member, sample.payload.to_bytes())
        elif member != self._me:
            is_there = sample.kind == zenoh.SampleKind.PUT
            self._expect(member, is_there)
            self._listener.present(member, is_there)

    def _expect(self, member: MemberId, is_there: bool) -> None:
        """Expect datagrams of a member from now on, or no longer.

        Zenoh finds the subscriber of a declared key once. For other keys it compares texts with each datagram.
        """
        if is_there and member not in self._keys:
            self._keys[member] = self._session.declare_keyexpr(self._key(self._me, member))
        elif not is_there:
            if (key := self._keys.pop(member, None)) is not None:
                self._session.undeclare(key)
            if (publisher := self._publishers.pop(member, None)) is not None:
                publisher.undeclare()

    def _key(self, receiver: MemberId, sender: MemberId) -> str:
        to, by = "/".join(receiver), "/".join(sender)
        return f"{self._root}/to/{to}/from/{by}"

    def send(self, to: MemberId, datagram: bytes) -> None:
        """Send a datagram. Zenoh drops it if the link is congested."""
        if self._session is None:
            return
        publisher = self._publishers.get(to)
        if publisher is None:
            publisher = self._publishers[to] = self._session.declare_publisher(
                self._key(to, self._me),
                congestion_control=zenoh.CongestionControl.DROP,
                express=True,
            )
        publisher.put(datagram)

    async def close(self) -> None:
        """Close the session."""
        self._is_closed = True
        if self._waiting is not None:
            self._waiting.cancel()
        session, self._session = self._session, None
        if session is not None:
            await asyncio.to_thread(self._close, session)

    def _close(self, session: Any) -> None:
        session.close()
        with suppress(queue.Empty):  # a thread that survives the interpreter aborts the process
            for _ in range(self._threads):
                self._ended.get(timeout=_CLOSING).join(_CLOSING)
