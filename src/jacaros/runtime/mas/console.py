"""The console of a run: output of agents as ``[agent] text`` on standard output, everything else on standard error."""

import contextlib
import os
import sys
import sysconfig
import traceback
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Protocol, TextIO, TypeVar

from jacaros.runtime.output import CLOSING, PATIENCE, Output, Printed

L = TypeVar("L")

_NOT_OF_USERS = (str(Path(__file__).parents[2]), sysconfig.get_path("stdlib"), "<")
"""Beginnings of the names of files that are not the user's code."""

LEVELS = ("debug", "info", "warning", "error")


class RunConsole(Protocol):
    """The outputs of a run."""

    def print(self, agent: str, text: str) -> None:
        """Print a line of an agent's output."""

    def log(self, text: str, level: str = "info") -> None:
        """Log a line; *level* is one of `LEVELS`."""


class StandardConsole:
    """Prints agents' lines to standard output, unbuffered, and logs to standard error.

    It neither raises nor waits for a reader: see `jacaros.runtime.output.Output`.

    Args:
        level: the lowest level that is shown.
        output: stream for agents' lines. Default: the current standard output.
        errors: stream for logs. Default: the current standard error.
        patience: seconds to wait for a slow reader while the queue is full.
    """

    def __init__(
        self,
        level: str = "info",
        output: TextIO | None = None,
        errors: TextIO | None = None,
        patience: float = PATIENCE,
    ) -> None:
        self._errors = Output(errors or (lambda: self._standard("stderr")), "standard error", None, patience)
        self._output = Output(
            output or (lambda: self._standard("stdout")), "standard output", self._warn, patience
        )
        self._least = LEVELS.index(level)
        self._printed: dict[str, Printed] = {}
        self._streams: dict[str, TextIO | None] = {}

    @contextlib.contextmanager
    def with_prints(self) -> Iterator[None]:
        """Capture what other code of the process prints, and write it in order with the agents' lines.

        It replaces `sys.stdout` and `sys.stderr` of the whole process, so use it only for a process of JaCaROS's own.
        """
        with open(os.devnull, "w", encoding="utf-8") as nothing:
            for name, output in (("stdout", self._output), ("stderr", self._errors)):
                stream = self._streams[name] = getattr(sys, name)
                self._printed[name] = Printed(nothing if stream is None else stream, output)
                setattr(sys, name, self._printed[name])
            try:
                yield
            finally:
                for name, printed in self._printed.items():
                    printed.flush()
                    if getattr(sys, name) is printed:
                        setattr(sys, name, self._streams[name])
                self._printed, self._streams = {}, {}

    def _standard(self, name: str) -> TextIO | None:
        stream: TextIO | None = self._streams[name] if name in self._streams else getattr(sys, name)
        return stream

    def print(self, agent: str, text: str) -> None:
        """Write a line as a whole."""
        if (printed := self._printed.get("stdout")) is not None:
            printed.flush()
        self._output.write(line_of(agent, text))

    def log(self, text: str, level: str = "info") -> None:
        """Log a line."""
        if LEVELS.index(level) >= self._least:
            if (printed := self._printed.get("stderr")) is not None:
                printed.flush()
            self._errors.write(f"{text}\n")

    def when_gone(self, callback: Callable[[], object]) -> None:
        """Call *callback*, in any thread, instead of warning when the reader closes the pipe of the agents' lines."""
        self._output.when_gone = callback

    def close(self, patience: float | None = CLOSING, limit: float | None = None) -> None:
        """Write what waits for a slow reader. See `jacaros.runtime.output.Output.close`."""
        self._output.close(patience, limit)
        self._errors.close(patience, limit)

    def _warn(self, text: str) -> None:
        self.log(f"warning: {text}", "warning")


class HeardConsole:
    """Passes everything on to another console, and log lines to listeners.

    Args:
        console: the other console.

    Attributes:
        print: prints a line of an agent's output on *console*.
    """

    def __init__(self, console: RunConsole) -> None:
        self._console = console
        self.print = console.print
        self._listeners: list[Callable[[str, str], None]] = []
        self._print_listeners: list[Callable[[str, str], None]] = []

    def log(self, text: str, level: str = "info") -> None:
        """Log a line."""
        self._console.log(text, level)
        for listener in tuple(self._listeners):
            listener(text, level)

    def listen(self, listener: Callable[[str, str], None]) -> Callable[[], None]:
        """Call *listener* with text and level of each line from now on. Return a function that ends this."""
        return entered(self._listeners, listener)

    def listen_to_prints(self, listener: Callable[[str, str], None]) -> Callable[[], None]:
        """Call *listener* with agent and text of each line that agents print. Return a function that ends this."""
        self.print = self._print_and_tell
        return entered(self._print_listeners, listener)

    def _print_and_tell(self, agent: str, text: str) -> None:
        self._console.print(agent, text)
        for listener in tuple(self._print_listeners):
            listener(agent, text)


def entered(listeners: list[L], listener: L) -> Callable[[], None]:
    """Add *listener* to *listeners*. Return a function that removes it; calling that again has no effect."""
    listeners.append(listener)
    return lambda: listeners.remove(listener) if listener in listeners else None


def line_of(agent: str, text: str) -> str:
    """Return the line for an agent's output. Line ends in the text are kept."""
    return f"[{agent}] {text}\n"


def places_of_fault(error: BaseException) -> list[str]:
    """Return the lines of the user's code in the traceback of an exception, the innermost last."""
    frames = ((frame.f_code, line) for frame, line in traceback.walk_tb(error.__traceback__))
    return [
        f"{code.co_filename}:{line}, in {code.co_name}"
        for code, line in frames
        if not code.co_filename.startswith(_NOT_OF_USERS)
    ]


def place_of_fault(error: BaseException) -> str:
    """Return the innermost line of the user's code in the traceback, in brackets; empty without one."""
    places = places_of_fault(error)
    return f" ({places[-1]})" if places else ""
