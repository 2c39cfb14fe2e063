"""The log of a run on the graph's ``/rosout``."""

from collections.abc import Callable
from typing import TYPE_CHECKING

from jacaros.robots.ros.errors import RosError
from jacaros.runtime.mas.console import RunConsole

if TYPE_CHECKING:
    from jacaros.robots.ros.backend import Backend

LEVELS = {"debug": "debug", "info": "info", "warning": "warn", "error": "error"}
"""From a console's levels to those of ROS's log."""

_ABOUT_THE_GRAPH = "[ros]"
"""Prefix of lines about the connection itself, which are not published."""


class RosoutConsole:
    """Writes to another console and, once the graph has been joined, to ``/rosout`` under the name of our node.

    Args:
        console: the other console.
        backend: returns our node; None before the graph has been joined.
    """

    def __init__(self, console: RunConsole, backend: "Callable[[], Backend | None]") -> None:
        self._console = console
        self._backend = backend
        self._refused = False

    def print(self, agent: str, text: str) -> None:
        """Print a line of an agent's output, on the graph as a message of level info."""
        self._console.print(agent, text)
        self._tell("info", f"[{agent}] {text}")

    def log(self, text: str, level: str = "info") -> None:
        """Log a line, on the graph with the same level."""
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
            # Logged once, and only here: an error in logging must not stop the run.
            self._refused = True
            self._console.log(f"{_ABOUT_THE_GRAPH} cannot write to /rosout: {error}", "warning")
