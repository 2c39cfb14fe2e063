"""Lines of the standard input, read only when they are wanted, in a thread: the loop never waits for a person."""

import asyncio
import os
import signal
import sys
import threading
from collections.abc import Callable

from jacaros.runtime.clock import start_thread

_MOMENT = 1.0
"""Seconds of real time for which a virtual clock waits for a line of a pipe: a script of answers arrives in time."""
_LONGEST = 64 * 1024
"""Maximum number of bytes of a line, about; a longer one is divided."""


class LineInput:
    """Reads lines from a file descriptor.

    In a background job, a terminal counts as an input at its end.

    Args:
        descriptor: file descriptor; 0 is the standard input.
    """

    def __init__(self, descriptor: int = 0) -> None:
        self._descriptor = descriptor
        self._rest = b""
        self._turn = threading.Lock()

    def next_line(self, callback: Callable[[str | None], None]) -> None:
        """Call *callback* on the running loop with the next line, None at the end of the input."""
        over = threading.Event()

        def read() -> str | None:
            try:
                with self._turn:
                    return self._read()
            finally:
                over.set()

        def deliver(line: asyncio.Future[str | None]) -> None:
            if not line.cancelled():
                callback(line.result())

        start_thread(read).add_done_callback(deliver)
        if not self._is_terminal():
            asyncio.get_running_loop().run_in_executor(None, over.wait, _MOMENT)

    def _is_terminal(self) -> bool:
        try:
            return os.isatty(self._descriptor)
        except OSError:
            return False

    def _read(self) -> str | None:
        if sys.platform != "win32":
            # Reading a terminal in the background then fails. Otherwise it would stop the process, while its robot drives.
            signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGTTIN})
        while b"\n" not in self._rest and len(self._rest) < _LONGEST:
            try:
                piece = os.read(self._descriptor, _LONGEST)
            except OSError:
                piece = b""
            if not piece:
                line, self._rest = self._rest, b""
                return line.decode("utf-8", "replace") if line else None
            self._rest += piece
        line, _, self._rest = self._rest.partition(b"\n")
        return line.decode("utf-8", "replace")
