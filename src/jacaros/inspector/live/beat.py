"""Real time for a loop on any clock: on the virtual clock, timers of the loop would fire as soon as all agents wait."""

import asyncio
import threading
import time

PERIOD = 1 / 30
"""Seconds between two beats."""


class Beat:
    """Wakes the waiting tasks of the running loop 30 times per second of real time.

    A thread wakes them like an external message, which does not advance a virtual clock.
    """

    def __init__(self) -> None:
        self._loop = asyncio.get_running_loop()
        self._waiting: list[asyncio.Future[None]] = []
        self._wanted = threading.Event()
        self._closed = False
        self._thread: threading.Thread | None = None

    async def next(self) -> None:
        """Wait for the next beat."""
        future: asyncio.Future[None] = self._loop.create_future()
        self._waiting.append(future)
        self._wanted.set()
        if self._thread is None:
            self._thread = threading.Thread(target=self._run, name="jacaros beat", daemon=True)
            self._thread.start()
        await future

    def close(self) -> None:
        """End the thread, and wake all waiters."""
        self._closed = True
        self._wanted.set()
        self._ring()

    def _run(self) -> None:
        while not self._closed:
            self._wanted.wait()
            time.sleep(PERIOD)
            try:
                self._loop.call_soon_threadsafe(self._ring)
            except RuntimeError:  # the loop is closed
                return

    def _ring(self) -> None:
        waiting, self._waiting = self._waiting, []
        if not self._closed:
            self._wanted.clear()
        for future in waiting:
            if not future.done():
                future.set_result(None)
