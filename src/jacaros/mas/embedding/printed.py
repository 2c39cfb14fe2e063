"""What the agents of an embedded system print, and what people are told."""

from collections.abc import Callable
from typing import NamedTuple

from jacaros.mas.console import StandardConsole
from jacaros.mas.python_agents.faults import place_of_fault, said


class PrintedLine(NamedTuple):
    """A line that an agent printed.

    Attributes:
        agent: its name.
        text: the line, without the name.
    """

    agent: str
    text: str

    def __str__(self) -> str:
        return f"[{self.agent}] {self.text}"


OnPrint = Callable[[str, str], None]
"""Called with the name of an agent and what it prints."""

OnLog = Callable[[str, str], None]
"""Called with a line for people and its level: ``debug``, ``info``, ``warning`` or ``error``."""


class PrintedConsole:
    """The console of an embedded system.

    Args:
        on_print: shows what agents print; on the standard output, as ``[agent] text``, unless given.
        on_log: tells people; on the standard error output unless given.
    """

    def __init__(self, on_print: OnPrint | None, on_log: OnLog | None) -> None:
        # Finds the standard outputs at the time of writing: tests and notebooks put others in their place.
        self._standard = StandardConsole()
        self._on_print = on_print or self._standard.print
        self._on_log = on_log or self._standard.log
        self._listeners: list[OnPrint] = []

    def listen(self, told: OnPrint) -> Callable[[], None]:
        """Tell *told* what is printed from now on, too; gives what ends that."""
        self._listeners.append(told)
        return lambda: self._listeners.remove(told) if told in self._listeners else None

    def print(self, agent: str, text: str) -> None:
        """Show a line of an agent's output."""
        for told in (self._on_print, *self._listeners):
            try:
                told(agent, text)
            except Exception as error:
                self.log(
                    f"error: a callback for what is printed failed: {said(error)}{place_of_fault(error)}",
                    "error",
                )

    def log(self, text: str, level: str = "info") -> None:
        """Tell people about what happens."""
        try:
            self._on_log(text, level)
        except Exception as error:
            self._standard.log(text, level)
            self._standard.log(
                f"error: a callback for logs failed: {said(error)}{place_of_fault(error)}", "error"
            )

    def close(self) -> None:
        """Write what waits for a slow reader."""
        self._standard.close()
