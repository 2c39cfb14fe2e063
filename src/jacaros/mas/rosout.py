"""What a run tells people, told on the graph's log ``/rosout`` too."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from jacaros.mas.console import Console
from jacaros.ros.errors import RosError

if TYPE_CHECKING:
    from jacaros.ros.backend import Backend

LEVELS = {"debug": "debug", "info": "info", "warning": "warn", "error": "error"}
"""A console's levels, in the words of ROS's log."""

_ABOUT_THE_GRAPH = "[ros]"
"""Lines about the connection itself begin so; the graph need not be told of them, and may be unable to be."""


class RosoutConsole:
    """Writes to another console, and under our node's name to ``/rosout`` as soon as the graph has been joined.

    Args:
        console: where all goes in any case.
        backend: gives our node; None before the graph has been joined.
    """

    def __init__(self, console: Console, backend: "Callable[[], Backend | None]") -> None:
        self._console = console
        self._backend = backend
        self._refused = False

    def print(self, agent: str, text: str) -> None:
        """Show a line of an agent's output; on the graph it is a message of level info."""
        self._console.print(agent, text)
        self._tell("info", f"[{agent}] {text}")

    def log(self, text: str, level: str = "info") -> None:
        """Tell people about what happens, with the same level on the graph."""
        self._console.log(text, level)
        if not text.startswith(_ABOUT_THE_GRAPH):
            self._tell(LEVELS[level], text)

    def _tell(self, level: str, text: str) -> None:
        backend = self._backend()
        if backend is None or not backend.connected or self._refused:
            return
        try:
            backend.rosout(level, text)
        except RosError as error:
            # Said once, and here alone: a log that cannot be written must not stop what it tells of.
            self._refused = True
            self._console.log(f"{_ABOUT_THE_GRAPH} nothing is written to /rosout: {error}", "warning")
