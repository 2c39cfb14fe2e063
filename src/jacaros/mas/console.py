"""Where a run writes: what the agents print goes out as ``[agent] text``, everything else to the errors."""

import sys
from typing import Protocol, TextIO

LEVELS = ("debug", "info", "warning", "error")


class Console(Protocol):
    """The outputs of a run."""

    def print(self, agent: str, text: str) -> None:
        """Show a line of an agent's output."""

    def log(self, text: str, level: str = "info") -> None:
        """Tell people about what happens; *level* is one of `LEVELS`."""


class StandardConsole:
    """Agents' lines on the standard output, complete lines at once; logs on the standard error output.

    Args:
        level: the least level that is shown.
    """

    def __init__(
        self, level: str = "info", output: TextIO | None = None, errors: TextIO | None = None
    ) -> None:
        self._output = output if output is not None else sys.stdout
        self._errors = errors if errors is not None else sys.stderr
        self._least = LEVELS.index(level)

    def print(self, agent: str, text: str) -> None:
        """Write a line, so that it is complete for whoever reads along."""
        self._output.write(line_of(agent, text))
        self._output.flush()

    def log(self, text: str, level: str = "info") -> None:
        """Write a line for people."""
        if LEVELS.index(level) >= self._least:
            self._errors.write(f"{text}\n")
            self._errors.flush()


def line_of(agent: str, text: str) -> str:
    """The line that shows what an agent prints; line ends inside stay, as the agent wants them."""
    return f"[{agent}] {text}\n"
