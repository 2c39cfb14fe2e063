"""What a run tells people on the graph: its log on ``/rosout``, and its state on ``/diagnostics``.

The state goes out once a second, as robot monitors read it (``diagnostic_msgs``, REP 107).  There is a status for the
connection and one for each agent.  An agent whose queue of things to take in grows for some seconds has a warning; a defect
of JaCaROS, which ends the run, is an error.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from jacaros.bdi.mind import Mind
from jacaros.clock import Clock, Timer
from jacaros.mas.agent_host import AgentHost
from jacaros.mas.console import Console
from jacaros.ros.errors import RosError

if TYPE_CHECKING:
    from jacaros.ros.backend import Backend, Publisher

TOPIC = "/diagnostics"
TYPE = "diagnostic_msgs/msg/DiagnosticArray"
PERIOD = 1.0
"""Seconds between two messages, as REP 107 has it."""

OK, WARN, ERROR = 0, 1, 2
"""Levels of ``diagnostic_msgs/DiagnosticStatus``."""

MANY = 100
"""A queue of fewer things is none to worry about."""
GROWING = 3
"""Periods in a row in which a queue must grow to be a warning."""


@dataclass(frozen=True, slots=True)
class Status:
    """The state of one thing.

    Attributes:
        name: of the thing.
        level: `OK`, `WARN` or `ERROR`.
        text: one line for people.
        values: figures by name.
    """

    name: str
    level: int
    text: str
    values: dict[str, str] = field(default_factory=dict)


class AgentHealth:
    """Follows how one agent does.

    Args:
        host: of the agent.
    """

    def __init__(self, host: AgentHost) -> None:
        self._host = host
        self._cycles = 0
        self._waiting = 0
        self._grown = 0

    def look(self, seconds: float) -> Status:
        """Its state, *seconds* after the last look."""
        mind = self._host.mind
        if not isinstance(mind, Mind):
            return Status(f"agent {self._host.name}", OK, "an agent in Python")
        waiting = len(mind.events) + len(mind.incoming.messages) + len(mind.incoming.percepts)
        self._grown = self._grown + 1 if waiting > self._waiting else 0
        rate = (mind.counts.cycles - self._cycles) / seconds
        self._waiting, self._cycles = waiting, mind.counts.cycles
        values = {
            "intentions": str(len(mind.alive)),
            "events waiting": str(len(mind.events)),
            "messages waiting": str(len(mind.incoming.messages)),
            "percepts waiting": str(len(mind.incoming.percepts)),
            "cycles per second": f"{rate:.0f}",
        }
        if self._grown >= GROWING and waiting > MANY:
            text = f"{waiting} events, messages and percepts wait, and more come than it can take in"
            return Status(f"agent {self._host.name}", WARN, text, values)
        doing = "reasons" if mind.alive else "waits for events"
        return Status(f"agent {self._host.name}", OK, doing, values)


class Diagnostics:
    """Publishes the state of a run.

    Args:
        backend: our node.
        clock: of the run.
        hosts: gives the agents that there are now.
        error: gives the defect that ended the run, None while there is none.
    """

    def __init__(
        self,
        backend: "Backend",
        clock: Clock,
        hosts: Callable[[], Iterable[AgentHost]],
        error: Callable[[], BaseException | None],
    ) -> None:
        self._backend = backend
        self._clock = clock
        self._hosts = hosts
        self._error = error
        self._health: dict[AgentHost, AgentHealth] = {}
        self._publisher: Publisher | None = None
        self._timer: Timer | None = None
        self._lost = 0

    def start(self) -> None:
        """Begin to publish.

        Raises:
            UnknownInterface: ``diagnostic_msgs`` is not installed.
        """
        self._publisher = self._backend.publisher(TOPIC, TYPE)
        self._backend.on_connection(self._note_connection)
        self._timer = self._clock.call_later(PERIOD, self._tick)

    def close(self) -> None:
        """Publish the state at the end, and no more."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
            self._publish()

    def look(self) -> list[Status]:
        """The state of everything, `PERIOD` after the last look."""
        hosts = list(self._hosts())
        for gone in set(self._health) - set(hosts):
            del self._health[gone]
        agents = [self._health.setdefault(host, AgentHealth(host)).look(PERIOD) for host in hosts]
        return [self._connection(), *self._defect(), *agents]

    def _connection(self) -> Status:
        backend = self._backend
        values = {
            "middleware": backend.name,
            "node": backend.node_name,
            "times lost": str(self._lost),
        }
        if backend.connected:
            return Status("connection", OK, "connected", values)
        return Status("connection", WARN, "the graph cannot be reached", values)

    def _defect(self) -> list[Status]:
        error = self._error()
        if error is None:
            return []
        return [Status("run", ERROR, f"a defect of jacaros ended the run: {type(error).__name__}: {error}")]

    def _note_connection(self, connected: bool) -> None:
        self._lost += not connected

    def _tick(self) -> None:
        self._publish()
        self._timer = self._clock.call_later(PERIOD, self._tick)

    def _publish(self) -> None:
        assert self._publisher is not None
        prefix = self._backend.node_name.lstrip("/")
        statuses = [
            {
                "level": each.level,
                "name": f"{prefix}: {each.name}",
                "message": each.text,
                "hardware_id": "",
                "values": [{"key": key, "value": value} for key, value in each.values.items()],
            }
            for each in self.look()
        ]
        header = {"stamp": self._clock.now()}
        self._publisher.publish(self._publisher.message(header=header, status=statuses))


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
