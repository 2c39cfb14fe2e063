"""The history of a run: the events of its agents and their environment, as records of plain data."""

from collections import deque
from collections.abc import Callable, Mapping
from contextlib import ExitStack
from operator import itemgetter
from typing import TYPE_CHECKING, Any, NamedTuple

from jacaros.agents.mind.mind import Mind
from jacaros.look.records import records
from jacaros.look.records.lasting import Lasting
from jacaros.look.records.records import RecordSink
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.mas.console import entered
from jacaros.runtime.mas.history.causes import CauseRecords
from jacaros.runtime.mas.history.goals import GoalRecords
from jacaros.runtime.mas.history.intentions import Looks, Moments
from jacaros.runtime.mas.history.minds import IN_ALL, MessageRecords, MindRecords, RateLimit, Shared
from jacaros.runtime.mas.history.programs import ProgramRecords
from jacaros.runtime.mas.history.run_environment import ObservedSystem, RunEnvironmentRecords
from jacaros.runtime.trace import Cause
from jacaros.version import VERSION

if TYPE_CHECKING:
    from jacaros.robots.world.data.ground_truth import JsonRecord
    from jacaros.robots.world.physics.world import World

KEPT = 50_000
"""Number of records that are kept. Older ones are dropped."""


class Happening(NamedTuple):
    """One record.

    Attributes:
        t: seconds of the run's clock since `History.beginning`.
        event: its kind, see ``docs/reference/recordings.md``.
        data: plain JSON data, which must not be changed.
    """

    t: float
    event: str
    data: Mapping[str, Any]


RecordListener = Callable[[float, str, Mapping[str, Any]], None]
"""Called with ``t``, ``event`` and ``data`` of a record. See `Happening`."""


def run_record(system: ObservedSystem) -> records.RunRecord:
    """Return the record ``run``."""
    clock, options = system.clock, system.options
    kind = "fast" if clock.virtual else "ros" if options.ros_clock else "real"
    return records.RunRecord(system.deployment.name, kind, options.ros, options.seed, VERSION)


class History:
    """Observes a running system from `start` to `stop`, keeps records of its events, and passes them to listeners.

    It costs nothing until it is started. A run is the same with and without it.

    Args:
        system: the system, started before `start` is called.
        kept: number of records that are kept.

    Attributes:
        beginning: time of the run's clock from which ``t`` counts.
        events: the newest records, oldest first.
    """

    def __init__(self, system: ObservedSystem, kept: int = KEPT) -> None:
        self._system = system
        self.beginning = system.clock.now()
        self.events: deque[Happening] = deque(maxlen=kept)
        self._kept = kept
        self._lasting: Lasting[Happening] = Lasting()
        self._listeners: list[RecordListener] = []
        self._ends = ExitStack()
        self._starts = 0
        self._agents: AgentRecords | None = None

    def listen(self, listener: RecordListener) -> Callable[[], None]:
        """Call *listener* with every record from now on. Return a function that ends this."""
        return entered(self._listeners, listener)

    def start(self) -> None:
        """Begin to observe. Each `start` needs a `stop`, and the last `stop` ends the observation."""
        self._starts += 1
        if self._starts > 1:
            return
        self.record(run_record(self._system))
        environment = RunEnvironmentRecords(self._system, self.beginning, self.record)
        environment.start(self._ends)
        self._agents = AgentRecords(self._system, environment.causes, self.t, self.record)
        self._agents.start(self._ends)
        self._ends.callback(self._system.ros.watch_world(self._observe_world))

    def stop(self) -> None:
        """End the observation, unless it was started several times. The records are kept."""
        self._starts = max(0, self._starts - 1)
        if not self._starts:
            self._ends.close()

    def look(self) -> None:
        """Record the current state of the agents: while the run is paused, no timer does so."""
        if self._starts and self._agents is not None:
            self._agents.look()

    def run_ended(self, code: int) -> None:
        """Record the end of the run. Open goals are dropped."""
        if self._starts and self._agents is not None:
            self._agents.run_ended()
            self.record(records.EndedRecord(code))

    def t(self, moment: float | None = None) -> float:
        """Return the seconds from the beginning to a moment of the run's clock, or to now, with millisecond precision."""
        return round((self._system.clock.now() if moment is None else moment) - self.beginning, 3)

    def record(self, event: records.EventRecord) -> None:
        """Keep a record of something that happened now, and pass it to the listeners."""
        self._take(event.kind, event.plain())

    def _take(self, event: str, data: Mapping[str, Any]) -> None:
        # As `t`, but inlined: most records of a recording are made here.
        t = round((self._system.clock.now() - self.beginning) * 1e3) / 1e3
        events = self.events
        if len(events) == self._kept:
            _, kind, forgotten = events[0]
            self._lasting.take(kind, forgotten, events[0])
        events.append(tuple.__new__(Happening, (t, event, data)))
        for listener in tuple(self._listeners):
            listener(t, event, data)

    def all(self) -> list[Happening]:
        """Return the records that a new listener needs: those that describe what lasts, and the newest `events`."""
        return [*sorted(self._lasting, key=itemgetter(0)), *self.events]

    def _observe_world(self, world: "World") -> None:
        self._ends.callback(world.ground_truth.listen_to_events(self._hear_world))

    def _hear_world(self, record: "JsonRecord") -> None:
        if record["event"] != "battery":  # each percent of each robot, which is also in the frames
            self._take(record["event"], {"robot": record["robot"], **record["data"]})


class AgentRecords:
    """Records the agents of a run.

    Args:
        system: the run.
        links: creates the links of causal chains.
        t: returns times.
        tell: takes the records.
    """

    def __init__(self, system: ObservedSystem, links: CauseRecords, t: Moments, tell: RecordSink) -> None:
        self._system, self._tell = system, tell
        self._looks = Looks(system.clock)
        self._goals = GoalRecords(tell)
        messages = MessageRecords(links, self._cause, tell)
        examinations = RateLimit(t, IN_ALL)
        self._shared = Shared(tell, t, links, examinations, ProgramRecords(tell), messages, self._looks)
        self._minds: dict[str, MindRecords] = {}
        self._ends: dict[str, ExitStack] = {}

    def start(self, ends: ExitStack) -> None:
        """Observe all agents, including future ones, until *ends* is closed."""
        ends.callback(self._end)
        for host in self._system.directory:
            self._began(host)
        ends.callback(self._system.directory.watch(self._changed))
        self._system.mailboxes.observer = self._shared.messages.sent

    def _end(self) -> None:
        self._system.mailboxes.observer = None
        self._looks.look()
        self._looks.stop()
        for name in list(self._ends):
            self._ends.pop(name).close()

    def look(self) -> None:
        """Record programs and intentions that have changed."""
        for mind in self._minds.values():
            mind.had_turn()
        self._looks.look()

    def run_ended(self) -> None:
        """Record the final state of the agents. Open goals are dropped."""
        self._looks.look()
        self._goals.drop()

    def _changed(self, name: str, present: bool) -> None:
        host = self._system.directory.find(name)
        if present and host is not None:
            self._began(host)
        elif not present:
            self._ended(name)

    def _began(self, host: AgentHost) -> None:
        mind = host.mind
        what = "asl" if isinstance(mind, Mind) else "python"
        self._tell(records.AgentRecord(host.name, "began", what))
        self._goals.listen(host)
        ends = self._ends[host.name] = ExitStack()
        if isinstance(mind, Mind):
            seen = self._minds[host.name] = MindRecords(mind, self._shared)
            seen.had_turn()
            ends.callback(seen.end)
            ends.callback(observe_turns(host, seen.had_turn))
            return
        from jacaros.runtime.mas.agents.python_agents import PythonAgentHost

        if isinstance(host, PythonAgentHost):
            host.mail.when_read = self._shared.messages.read
            ends.callback(setattr, host.mail, "when_read", None)

    def _ended(self, name: str) -> None:
        self._minds.pop(name, None)
        self._ends.pop(name, ExitStack()).close()
        self._goals.drop(name)
        self._tell(records.AgentRecord(name, "ended", ""))

    def _cause(self, sender: str) -> Cause | None:
        mind = self._minds.get(sender)
        return None if mind is None else mind.cause()


def observe_turns(host: AgentHost, had_turn: Callable[[], None]) -> Callable[[], None]:
    """Call *had_turn* after each turn of an agent. Return a function that ends this."""
    run = host.run

    def observed(fuel: int) -> bool:
        more = run(fuel)
        had_turn()
        return more

    host.run = observed

    def end() -> None:
        if host.run is observed:
            host.run = run

    return end
