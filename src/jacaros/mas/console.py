"""Where a run writes: output of the agents goes out as ``[agent] text``, everything else to the errors."""

import contextlib
import os
import sys
from collections.abc import Callable, Iterator
from typing import Protocol, TextIO

from jacaros.output import CLOSING, PATIENCE, Output, Printed, Stream

LEVELS = ("debug", "info", "warning", "error")


class Console(Protocol):
    """The outputs of a run."""

    def print(self, agent: str, text: str) -> None:
        """Show a line of an agent's output."""

    def log(self, text: str, level: str = "info") -> None:
        """Tell people about what happens; *level* is one of `LEVELS`."""


class StandardConsole:
    """Agents' lines on the standard output, complete lines immediately; logs on the standard error output.

    Neither raises nor waits for a reader: see `jacaros.output.Output`.

    Args:
        level: the least level that is shown.
        output: takes the lines of agents; the standard output of the moment unless given.
        errors: takes the logs; the standard error output of the moment unless given.
        patience: seconds to wait for a reader that takes nothing while the queue is full.
    """

    def __init__(
        self,
        level: str = "info",
        output: Stream | None = None,
        errors: Stream | None = None,
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
        """Take in what other code of the process prints, to write it as safely as the agents' lines and in its order.

        It changes `sys.stdout` and `sys.stderr` of the whole process: only for one that is ours.
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

    def _standard(self, name: str) -> Stream | None:
        stream: Stream | None = self._streams[name] if name in self._streams else getattr(sys, name)
        return stream

    def print(self, agent: str, text: str) -> None:
        """Write a line, so that it is complete for every reader."""
        if (printed := self._printed.get("stdout")) is not None:
            printed.flush()
        self._output.write(line_of(agent, text))

    def log(self, text: str, level: str = "info") -> None:
        """Write a line for people."""
        if LEVELS.index(level) >= self._least:
            if (printed := self._printed.get("stderr")) is not None:
                printed.flush()
            self._errors.write(f"{text}\n")

    def when_gone(self, told: Callable[[], object]) -> None:
        """Call *told*, in any thread, instead of warning when the reader closes the pipe of the agents' lines."""
        self._output.when_gone = told

    def close(self, patience: float | None = CLOSING, limit: float | None = None) -> None:
        """Write what waits for a slow reader; see `jacaros.output.Output.close`."""
        self._output.close(patience, limit)
        self._errors.close(patience, limit)

    def _warn(self, text: str) -> None:
        self.log(f"warning: {text}", "warning")


class HeardConsole:
    """Passes everything on to another console, and log lines to those who listen.

    Args:
        console: where everything goes.

    Attributes:
        print: shows a line of an agent's output: that of *console*.
    """

    def __init__(self, console: Console) -> None:
        self._console = console
        self.print = console.print
        self._listeners: tuple[Callable[[str, str], None], ...] = ()

    def log(self, text: str, level: str = "info") -> None:
        """Tell people about what happens."""
        self._console.log(text, level)
        for listener in self._listeners:
            listener(text, level)

    def listen(self, listener: Callable[[str, str], None]) -> Callable[[], None]:
        """Call *listener* with text and level of each line from now on; gives what ends that."""
        self._listeners = (*self._listeners, listener)

        def end() -> None:
            self._listeners = tuple(each for each in self._listeners if each is not listener)

        return end


def line_of(agent: str, text: str) -> str:
    """The line that shows what an agent prints; line ends inside stay, as the agent wants them."""
    return f"[{agent}] {text}\n"
