"""Records of the environment: artifacts, focus, properties, signals and operations."""

from collections.abc import Callable, Iterable, Mapping

from msgspec.structs import replace

from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.execution import OperationExecution
from jacaros.artifacts.env.operation import OperationOutcome
from jacaros.artifacts.env.property import ObservableProperty, Observation
from jacaros.artifacts.env.workspace import Workspace
from jacaros.look.records import records
from jacaros.look.records.records import RecordSink
from jacaros.look.records.words import call_text, json_values, limited, output_texts, request_text
from jacaros.runtime.clock import Clock

PERIOD = 0.5
"""Seconds between two records of a property that changes continuously. The last value is always recorded."""

_Key = tuple[ArtifactId, int]


class EnvironmentRecords:
    """Observes an environment and records its events.

    Args:
        clock: clock of the run.
        tell: takes the records.
        robot_of: returns the robot that an artifact drives or senses, or None.
    """

    def __init__(self, clock: Clock, tell: RecordSink, robot_of: Callable[[object], str | None]) -> None:
        self._clock, self._tell, self._robot_of = clock, tell, robot_of
        self._environment: Environment | None = None
        self._known: set[ArtifactId] = set()
        self._recorded: dict[_Key, float] = {}
        """Time of the last record of each property."""
        self._held: dict[_Key, tuple[ObservableProperty, int | None]] = {}
        """Values that came too soon after the last record, and their causes."""
        self._running: dict[OperationExecution, records.OperationRecord] = {}

    def observe(self, environment: Environment) -> None:
        """Observe *environment*, and record its current state."""
        self._environment = environment
        environment.listener = self
        environment.arbiter.listen(self._owned)
        for workspace in environment.workspaces():
            if isinstance(workspace, Workspace):
                for artifact in workspace.artifacts():
                    self.artifact(artifact, True)

    def end(self) -> None:
        """Stop observing, and record the newest values that were held back."""
        self.flush(all_of_them=True)
        if self._environment is not None:
            self._environment.listener = None
            self._environment.arbiter.listen(None)
            self._environment = None

    # ---- called by the environment

    def artifact(self, artifact: ArtifactId, present: bool) -> None:
        """Record that an artifact is created or disposed."""
        made = self._environment.artifact(artifact) if present and self._environment is not None else None
        state, robot = "made" if present else "disposed", self._robot_of(made) if made is not None else None
        self._tell(records.ArtifactRecord(artifact.path, artifact.type_name, state, robot))
        if present:
            self._known.add(artifact)
            if made is not None:
                self._introduce(artifact)
        else:
            self._known.discard(artifact)
            for key in [key for key in self._recorded if key[0] is artifact]:
                del self._recorded[key]
                self._held.pop(key, None)

    def _introduce(self, artifact: ArtifactId) -> None:
        workspace = self._environment.workspace(artifact.workspace) if self._environment is not None else None
        if isinstance(workspace, Workspace):
            for observer in workspace.observers(artifact):
                self.focused(artifact, observer.agent, True)
            for each in workspace.properties(artifact):
                self._property(artifact, each, None)

    def focused(self, artifact: ArtifactId, agent: str, on: bool) -> None:
        """Record that an agent focuses an artifact, or stops focusing it."""
        if artifact in self._known:
            self._tell(records.FocusRecord(agent, artifact.path, on))

    def published(self, observation: Observation) -> None:
        """Record new values and signals."""
        artifact, cause = observation.artifact, observation.cause
        if artifact not in self._known:
            return  # it represents an agent, or is being created: its properties are recorded afterwards
        number = cause.id if cause is not None else None
        for signal in observation.signals:
            written = call_text(signal.name, signal.arguments)
            self._tell(records.SignalRecord(artifact.path, written, number))
        for _, new in observation.changed:
            self._property(artifact, new, number)
        for added in observation.added:
            self._property(artifact, added, number)
        for gone in observation.removed:
            self._property_gone(artifact, gone, number)

    def began(self, execution: OperationExecution) -> None:
        """Record that an operation begins."""
        request = execution.request
        if request.artifact not in self._known:
            return
        cause, parent = execution.cause, request.cause
        self._running[execution] = began = records.OperationRecord(
            cause.id if cause is not None else 0,
            request.artifact.path,
            request_text(request),
            "began",
            request.agent,
            parent.id if parent is not None else 0,
        )
        self._tell(began)

    def ended(self, execution: OperationExecution, outcome: OperationOutcome | None) -> None:
        """Record how an operation ended. A cancelled one has failed."""
        began = self._running.pop(execution, None)
        if began is None:
            return
        if outcome is not None and outcome.ok:
            outputs = output_texts(execution.request) or None
            self._tell(replace(began, state="done", outputs=outputs))
            return
        term = None if outcome is None or outcome.reason is None else limited(str(outcome.reason))
        reason = "cancelled" if outcome is None else limited(outcome.message or str(outcome.reason or ""))
        self._tell(replace(began, state="failed", reason=reason, term=term or None))

    def _owned(self, resource: str, holder: str | None) -> None:
        self._tell(records.ResourceRecord(resource, holder))

    # ---- properties

    def _property(self, artifact: ArtifactId, new: ObservableProperty, cause: int | None) -> None:
        key, now = (artifact, new.key), self._clock.elapsed
        # Not recorded yet: most values of a sensor are replaced before they are read.
        if now - self._recorded.get(key, -PERIOD) < PERIOD:
            self._held[key] = (new, cause)
            return
        self._record(key, new, cause, now)

    def _record(self, key: _Key, new: ObservableProperty, cause: int | None, now: float) -> None:
        self._recorded[key] = now
        self._held.pop(key, None)
        self._tell(records.PropertyRecord(key[0].path, new.name, new.key, json_values(new.values), cause))

    def _property_gone(self, artifact: ArtifactId, old: ObservableProperty, cause: int | None) -> None:
        self._recorded.pop((artifact, old.key), None)
        self._held.pop((artifact, old.key), None)
        self._tell(records.PropertyRecord(artifact.path, old.name, old.key, None, cause))

    def flush(self, all_of_them: bool = False) -> None:
        """Record the newest values that were held back for `PERIOD` seconds. Call it a few times a second."""
        now = self._clock.elapsed
        for key, held in list(self._held.items()):
            if all_of_them or now - self._recorded.get(key, -PERIOD) >= PERIOD:
                self._record(key, *held, now)


def robot_finder(robots: Callable[[], Mapping[str, str]]) -> Callable[[object], str | None]:
    """Return a function that finds the robot of an artifact by the ROS names it uses.

    Args:
        robots: returns the names of known robots by topic prefix, such as ``/robot_0``; empty for the only robot.
    """

    def robot_of(artifact: object) -> str | None:
        prefix = getattr(artifact, "robot_prefix", None)
        if not isinstance(prefix, str):
            return None
        known = robots()
        if prefix and prefix in known:
            return known[prefix]
        names: Iterable[str] = getattr(artifact, "ros_names", ())
        own = [name for name in names if not name.lstrip("/").startswith(_NOT_OF_A_ROBOT)]
        spaces = [space for space in known if any(name.startswith(f"{space}/") for name in own)]
        return known[max(spaces, key=len)] if spaces else prefix.strip("/") or None

    return robot_of


_NOT_OF_A_ROBOT = ("map", "door", "fault")
