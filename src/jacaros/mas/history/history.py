"""The history of a run: the events of its agents and their environment, as records of plain data."""

from collections import deque
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from jacaros.mas.history.agents import AgentRecords
from jacaros.mas.history.run_environment import ObservedSystem, RunEnvironmentRecords
from jacaros.version import VERSION

if TYPE_CHECKING:
    from jacaros.sim.data.ground_truth import Record
    from jacaros.sim.physics.world import World

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


Listener = Callable[[float, str, Mapping[str, Any]], None]
"""Called with ``t``, ``event`` and ``data`` of a record. See `Happening`."""

_LASTING: Mapping[str, tuple[str, ...]] = {
    "run": (),
    "source": ("file",),
    "agent": ("agent",),
    "program": ("agent",),
    "artifact": ("artifact",),
}
"""Records that describe a state: the newest of each is kept while the state lasts, identified by these fields."""


def run_data(system: ObservedSystem) -> dict[str, Any]:
    """Return the data of the record ``run``."""
    clock, options = system.clock, system.options
    return {
        "name": system.deployment.name,
        "clock": "fast" if clock.virtual else "ros" if options.ros_clock else "real",
        "ros": options.ros,
        "seed": options.seed,
        "jacaros": VERSION,
    }


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
        self._lasting: dict[tuple[object, ...], Happening] = {}
        self._listeners: tuple[Listener, ...] = ()
        self._message_listeners: tuple[Callable[[float, str, Any], None], ...] = ()
        self._ends: list[Callable[[], None]] = []
        self._starts = 0
        self._agents: AgentRecords | None = None

    def listen(self, listener: Listener) -> Callable[[], None]:
        """Call *listener* with every record from now on. Return a function that ends this."""
        self._listeners = (*self._listeners, listener)

        def end() -> None:
            self._listeners = tuple(each for each in self._listeners if each is not listener)

        return end

    def listen_to_messages(self, listener: Callable[[float, str, Any], None]) -> Callable[[], None]:
        """Call *listener* with time, topic and ROS message of each message that has an effect. Return a function that
        ends this.

        Effects are, for example, a belief change that a plan handles, or a command of an operation.
        """
        self._message_listeners = (*self._message_listeners, listener)

        def end() -> None:
            self._message_listeners = tuple(each for each in self._message_listeners if each is not listener)

        return end

    def _hear_message(self, t: float, topic: str, message: Any) -> None:
        for listener in self._message_listeners:
            listener(t, topic, message)

    def start(self) -> None:
        """Begin to observe. Each `start` needs a `stop`, and the last `stop` ends the observation."""
        self._starts += 1
        if self._starts > 1:
            return
        self.record("run", run_data(self._system))
        self.environment_records = RunEnvironmentRecords(self._system, self.beginning, self.record)
        self.environment_records.causes.with_effect = self._hear_message
        self._agents = AgentRecords(self._system, self.environment_records.causes, self.t, self.record)
        self._ends += [self.environment_records.start(), self._agents.start(), self._observe_world()]

    def stop(self) -> None:
        """End the observation, unless it was started several times. The records are kept."""
        self._starts = max(0, self._starts - 1)
        if not self._starts:
            while self._ends:
                self._ends.pop()()

    def look(self) -> None:
        """Record the current state of the agents: while the run is paused, no timer does so."""
        if self._starts and self._agents is not None:
            self._agents.look()

    def run_ended(self, code: int) -> None:
        """Record the end of the run. Open goals are dropped."""
        if self._starts and self._agents is not None:
            self._agents.run_ended()
            self.record("ended", {"code": code})

    def t(self, moment: float | None = None) -> float:
        """Return the seconds from the beginning to a moment of the run's clock, or to now, with millisecond precision."""
        return round((self._system.clock.now() if moment is None else moment) - self.beginning, 3)

    def record(self, event: str, data: Mapping[str, Any]) -> None:
        """Keep a record of something that happened now, and pass it to the listeners."""
        # As `t`, but inlined: most records of a recording are made here.
        t = round((self._system.clock.now() - self.beginning) * 1e3) / 1e3
        events = self.events
        if len(events) == self._kept:
            self._keep(events[0])
        events.append(tuple.__new__(Happening, (t, event, data)))
        for listener in self._listeners:
            listener(t, event, data)

    def _keep(self, forgotten: Happening) -> None:
        event, data = forgotten.event, forgotten.data
        fields = _LASTING.get(event)
        if fields is None:
            return
        key = tuple(data.get(field) for field in fields)
        if data.get("state") in ("ended", "disposed"):
            for each in ("agent", "program", "artifact"):
                self._lasting.pop((each, *key), None)
        else:
            self._lasting[event, *key] = forgotten

    def all(self) -> list[Happening]:
        """Return the records that a new listener needs: those that describe agents, programs and artifacts, and the
        newest `events`.
        """
        return [*self._lasting.values(), *self.events]

    def _observe_world(self) -> Callable[[], None]:
        ends: list[Callable[[], None]] = []

        def listen(world: "World") -> None:
            ends.append(world.ground_truth.listen_to_events(self._hear_world))

        ends.append(self._system.ros.watch_world(listen))

        def end() -> None:
            for each in ends:
                each()

        return end

    def _hear_world(self, record: "Record") -> None:
        if record["event"] != "battery":  # each percent of each robot, which is also in the frames
            self.record(record["event"], {"robot": record["robot"], **record["data"]})
