"""The ROS outputs of a run: its log on ``/rosout``, and its state on ``/diagnostics``.

The state is published once a second for robot monitors (``diagnostic_msgs``, REP 107), with a status for the connection
and one for each agent. An agent whose queues grow for some seconds has a warning. A defect of JaCaROS, which ends the
run, is an error.
"""

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from jacaros.robots.ros.errors import RosError
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.console import RunConsole

if TYPE_CHECKING:
    from jacaros.robots.ros.backend import Backend
    from jacaros.robots.ros.node import Publisher

TOPIC = "/diagnostics"
TYPE = "diagnostic_msgs/msg/DiagnosticArray"
PERIOD = 1.0
"""Seconds between two messages, as REP 107 recommends."""

OK, WARN, ERROR = 0, 1, 2
"""Levels of ``diagnostic_msgs/DiagnosticStatus``."""

MANY = 100
"""A queue of fewer entries causes no warning."""
GROWING = 3
"""Number of consecutive periods in which a queue must grow to cause a warning."""


@dataclass(frozen=True, slots=True)
class Status:
    """The state of one component.

    Attributes:
        name: name of the component.
        level: `OK`, `WARN` or `ERROR`.
        text: one line for users.
        values: figures by name.
    """

    name: str
    level: int
    text: str
    values: dict[str, str] = field(default_factory=dict)


@dataclass(eq=False)
class AgentHealth:
    """Observes the queues of one agent.

    Attributes:
        host: host of the agent.
    """

    host: AgentHost
    _cycles: int = 0
    _waiting: int = 0
    _grown: int = 0

    def look(self, seconds: float) -> Status:
        """Return its state, *seconds* after the last call."""
        mind, name = self.host.mind, f"agent {self.host.name}"
        if mind is None:
            return Status(name, OK, "Python agent")
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
            text = f"{waiting} events, messages and percepts are waiting, and arrive faster than the agent processes them"
            return Status(name, WARN, text, values)
        return Status(name, OK, "reasoning" if mind.alive else "waiting for events", values)


@dataclass(eq=False)
class Diagnostics:
    """Publishes the state of a run.

    Attributes:
        backend: the node of the run.
        clock: clock of the run.
        hosts: returns the current agents.
        error: returns the defect that ended the run, or None.
    """

    backend: "Backend"
    clock: Clock
    hosts: Callable[[], Iterable[AgentHost]]
    error: Callable[[], BaseException | None]
    _health: dict[AgentHost, AgentHealth] = field(default_factory=dict)
    _publisher: "Publisher | None" = None
    _timer: Timer | None = None
    _lost: int = 0

    def start(self) -> None:
        """Begin to publish.

        Raises:
            UnknownInterface: ``diagnostic_msgs`` is not installed.
        """
        self._publisher = self.backend.publisher(TOPIC, TYPE)
        self.backend.on_connection(self._note_connection)
        self._timer = self.clock.call_later(PERIOD, self._tick)

    def close(self) -> None:
        """Publish the final state, and stop."""
        if self._timer is not None:
            self._timer.cancel()
            self._timer = None
            self._publish()

    def look(self) -> list[Status]:
        """Return the state of everything, `PERIOD` seconds after the last call."""
        hosts = list(self.hosts())
        for gone in set(self._health) - set(hosts):
            del self._health[gone]
        agents = [self._health.setdefault(host, AgentHealth(host)).look(PERIOD) for host in hosts]
        backend, error = self.backend, self.error()
        values = {"middleware": backend.name, "node": backend.node_name, "connection losses": str(self._lost)}
        level, text = (OK, "connected") if backend.connected else (WARN, "ROS graph unreachable")
        found = [Status("connection", level, text, values)]
        if error is not None:
            found.append(Status("run", ERROR, f"internal error: {type(error).__name__}: {error}"))
        return [*found, *agents]

    def _note_connection(self, connected: bool) -> None:
        self._lost += not connected

    def _tick(self) -> None:
        self._publish()
        self._timer = self.clock.call_later(PERIOD, self._tick)

    def _publish(self) -> None:
        assert self._publisher is not None
        prefix = self.backend.node_name.lstrip("/")
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
        header = {"stamp": self.clock.now()}
        self._publisher.publish(self._publisher.message(header=header, status=statuses))


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
