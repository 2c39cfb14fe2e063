"""The server of the live pages of a running system, from its start to its end."""

import asyncio
import contextlib
from collections.abc import AsyncIterator
from contextlib import asynccontextmanager

from jacaros.agents.language.offers import OPERATOR
from jacaros.look.page.live.access import Access
from jacaros.look.page.live.server import LiveServer, bound_socket
from jacaros.look.page.live.shown_run import ShownRun
from jacaros.look.page.watch import Watch, watch_of
from jacaros.runtime.clock import outside_run
from jacaros.runtime.mas.embedding.mas import Mas
from jacaros.runtime.mas.system import System

FIRST_VISIT = 5.0
"""Seconds that the end of a run waits for an opened browser that has not shown the run yet."""

SIGNALS = 128
"""Exit codes from here on mean that a signal ended the run, which must then not wait."""


class RunView:
    """Serves the live pages of one run.

    Args:
        system: the run; already started.
        address: address of this machine; only this machine reaches the loopback address.
        port: port; 0 for a free one.
        token: token in the path; None for a random one.
        role: what pages may do; see `ShownRun`.
        framed: whether other pages may show the page in a frame.

    Attributes:
        watcher: receives the run.
        address: address of the page.
        awaited: whether a browser was opened, so that the end of the run waits until the page has shown something.

    Raises:
        UsageError: the address cannot be used, or the token is invalid.
    """

    def __init__(
        self,
        system: System,
        address: str,
        port: int,
        token: str | None,
        role: str = OPERATOR,
        framed: bool = False,
    ) -> None:
        self._system = system
        self.awaited = False
        self._shown = ShownRun(system, role)
        self.watcher = self._shown.watcher
        access = Access(address, token, framed)
        self._server = LiveServer(bound_socket(address, port), access, self.watcher)
        self.address = self._server.address
        self._open_address = self.address.removesuffix(f"{access.token}/")
        """Without the token, which other members of a fleet do not get."""
        self._serving: asyncio.Task[None] | None = None

    def begin(self, watch: Watch) -> None:
        """Serve until the run ends or `close` is called.

        Args:
            watch: watch of the run, with `watcher` among its watchers.
        """
        self._shown.begin(watch)
        self._show_page(self._open_address)
        with outside_run():  # a paused run must be able to continue
            self._serving = asyncio.create_task(self._serve())
        self._system.close_last(self.close)  # pages show the end of the run
        # A task that is cancelled before its first step executes no `finally`.
        self._serving.add_done_callback(lambda _: self._server.release())

    def _show_page(self, address: str) -> None:
        if self._system.fleet is not None:
            self._system.fleet.show_page(address)

    async def close(self) -> None:
        """Send waiting records, and disconnect the pages."""
        self._shown.end()
        self._show_page("")
        if self._serving is not None:
            self._serving.cancel()
            with contextlib.suppress(asyncio.CancelledError):
                await self._serving

    async def _serve(self) -> None:
        try:
            await self._server.start()
            await asyncio.get_running_loop().create_future()
        finally:
            # The run has ended, or was interrupted.
            code = self._system.exit_code
            if self.awaited and code is not None and code < SIGNALS:
                await self._server.close(FIRST_VISIT, visited=True)
            else:
                await self._server.close()


@asynccontextmanager
async def view(
    mas: Mas, *, address: str = "127.0.0.1", port: int = 0, token: str | None = None, role: str = OPERATOR
) -> AsyncIterator[str]:
    """Serve live pages of a running system inside an ``async with``.

    ::

        async with Mas("patrol.jcm") as mas, view(mas) as page:
            print(page)
            await mas.ended()

    Args:
        mas: the running system.
        address: address of this machine; by default one that only this machine can reach.
        port: port; a free one by default.
        token: token in the path, at least 16 letters and digits; random by default.
        role: what pages may do: ``observer``, ``user`` or ``operator``; see `ShownRun`.

    Returns:
        The address of the page.

    Raises:
        UsageError: the address cannot be used, or the token is invalid.
        RunEnded: the system is not running.
    """
    shown = RunView(mas.system, address, port, token, role)
    watch = watch_of(mas.system, [shown.watcher], live=True)
    watch.start()
    end_prints = mas.on_print(watch.text)
    shown.begin(watch)
    try:
        yield shown.address
    finally:
        end_prints()
        watch.stop()
        await shown.close()
