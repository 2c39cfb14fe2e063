"""Workspaces of this member for another one: its operations, focuses and artifacts here."""

import sys
from collections.abc import Callable, Sequence
from functools import partial
from importlib.util import find_spec
from typing import Protocol

from jacaros.artifacts.env.environment import Environment, WorkspaceArtifact
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, UnknownWorkspace, resolve_path
from jacaros.artifacts.env.operation import SUCCEEDED, OperationOutcome, OperationRequest
from jacaros.artifacts.env.ports import OnOutcome, UnderWay, Workspace
from jacaros.artifacts.env.property import ObservableProperty, Observation
from jacaros.artifacts.env.values import Out, Structure
from jacaros.fleet import protocol
from jacaros.fleet.artifacts import ArtifactNames
from jacaros.fleet.causes import Causes
from jacaros.fleet.wire import ATOM, LIST, NotSendable, Wire
from jacaros.runtime.trace import Cause

_TYPES = {"makeArtifact": 1, "getManualContent": 0, "consultManual": 0}
"""Operations of standard artifacts that find a type: which argument names it."""
_SIGNALS = 1000
"""Signals of one observer that are kept meanwhile."""


class Line(Protocol):
    """The way to the other member."""

    @property
    def is_behind(self) -> bool:
        """Whether what is sent now would wait on its way."""

    def say(self, said: protocol.Said) -> bool:
        """Say something to it. Return False if it is too large."""

    def report(self, text: str) -> None:
        """Write a warning about it into the log."""


class _Watching:
    """Observes one artifact for an agent of the other member."""

    def __init__(self, served: "Served", number: int, agent: str, artifact: ArtifactId) -> None:
        self.agent = agent
        self.artifact = artifact
        self._served, self._number = served, number
        self.is_replaced = False
        self._whole = True
        self._properties: dict[int, ObservableProperty] = {}
        self._removed: dict[int, None] = {}
        self._signals: list[tuple[str, object]] = []
        self._cause: Cause | None = None

    def observe(self, observation: Observation) -> None:
        """Take in what was published, and send it. On a slow link it waits: only the newest values go then."""
        if self.is_replaced:
            return  # its observer has a new focus, and would take the end of this one for that of the properties
        self._cause = observation.cause
        for new in (*(after for _, after in observation.changed), *observation.added):
            self._properties[new.key] = new
        for old in observation.removed:
            self._properties.pop(old.key, None)
            self._removed[old.key] = None
        for signal in observation.signals:
            self._signals.append((signal.name, self._served.data(list(signal.arguments), signal.name)))
        if len(self._signals) > _SIGNALS:
            del self._signals[:-_SIGNALS]
            self._served.line.report(f"the link is too slow: signals of {self.artifact.path} were left out")
        if self._served.line.is_behind:
            self._served.late[self] = None
        else:
            self.flush()

    def begin(self) -> None:
        """Send the whole picture, even if it is empty."""
        if self._whole:
            self.flush()

    def flush(self) -> None:
        """Send what has been put together."""
        self._served.late.pop(self, None)
        if not (self._whole or self._properties or self._removed or self._signals):
            return
        data = self._served.data
        properties = [
            (each.key, each.name, data(list(each.values), each.name), data(list(each.annotations), each.name))
            for each in self._properties.values()
        ]
        cause, removed = self._served.causes.of(self._cause), list(self._removed)
        said = protocol.Observed(self._number, self._whole, self._signals, properties, removed, cause)
        self._whole = False
        self._properties, self._removed, self._signals, self._cause = {}, {}, [], None
        self._served.line.say(said)


class Served:
    """What another member does in the environment of this one.

    Args:
        environment: returns the environment of this member.
        names: names of artifacts.
        wire: converts values.
        line: the way to the other member.
        called: returns how an agent of that member is called here, so that none is taken for one of this member.
        causes: describes what led to something.

    Attributes:
        late: observers whose observations wait until less is under way.
    """

    def __init__(
        self,
        environment: Callable[[], Environment],
        names: ArtifactNames,
        wire: Wire,
        line: Line,
        called: Callable[[str], str],
        causes: Causes,
    ) -> None:
        self.names, self.line, self.causes = names, line, causes
        self.late: dict[_Watching, None] = {}
        self._environment, self._wire, self._called = environment, wire, called
        self._begun: set[int] = set()
        self._calls: dict[int, UnderWay] = {}
        self._watching: dict[tuple[int, int], _Watching] = {}
        self._refused: set[str] = set()

    def data(self, value: object, what: str) -> object:
        """Return a value as data; an atom in its place if it cannot be sent, which is reported once."""
        try:
            return self._wire.from_value(value)
        except NotSendable as error:
            if what not in self._refused:
                self._refused.add(what)
                self.line.report(f"`{what}` cannot leave this system: {error}")
            if not isinstance(value, list):
                return [ATOM, "not_sendable"]
            return [LIST, *(self.data(each, what) for each in value)]

    def drained(self) -> None:
        """Send what has waited, as far as there is room."""
        while self.late and not self.line.is_behind:
            next(iter(self.late)).flush()

    def lost(self) -> None:
        """The other member is gone: end its operations and focuses."""
        self._begun.clear()
        calls, self._calls = self._calls, {}
        for call in calls.values():
            call.cancel()
        for each in self._watching.values():
            self._workspace_of(each.artifact).stop_focus(each.artifact, each)
        self._watching.clear()
        self.late.clear()

    def _workspace_of(self, artifact: ArtifactId) -> Workspace:
        return self._environment().workspace(artifact.workspace)

    # ---- what it asks for

    def on_execute(self, asked: protocol.Execute) -> None:
        """Run an operation."""
        artifact = self.names.own(asked.artifact)
        if artifact is None:
            self.fail(asked.call, _gone(asked.artifact))
            return
        outs: list[Out] = []
        arguments = tuple(self._wire.to_value(asked.arguments, outs))
        place = _TYPES.get(asked.operation, len(arguments))
        for type_name in arguments[place : place + 1]:
            _check_imports(str(type_name))
        if artifact.type_name == WorkspaceArtifact.__name__:
            self._check_places(artifact.workspace, asked.operation, arguments)
        self._begun.add(asked.call)

        def done(outcome: OperationOutcome) -> None:
            self._end(asked.call, outcome, outs)

        agent, cause = self._caller(asked.agent), self.causes.arrived(asked.cause)
        request = OperationRequest(artifact, asked.operation, arguments, agent, cause, done)
        request.timeout, request.urgency = asked.timeout, asked.urgency
        request.policy, request.yields = asked.policy, asked.yields  # type: ignore[assignment]
        self._keep(asked.call, self._environment().execute(request))

    def _check_places(self, here: str, operation: str, arguments: Sequence[object]) -> None:
        """Let no member change something at a third one with the rights of this one.

        Raises:
            UnknownWorkspace: it would, through the artifact ``workspace``.
        """
        places = [each.workspace for each in arguments if isinstance(each, ArtifactId)]
        if operation in ("makeArtifact", "createWorkspace"):
            places.append(resolve_path(here, str(arguments[0])).rpartition("/")[0] or here)
        own = {each.path for each in self._environment().own()}
        for place in places:
            if place not in own or (operation, len(arguments)) == ("createWorkspace", 2):
                raise _not_own(place)

    def _caller(self, agent: str | None) -> str | None:
        return None if agent is None else self._called(agent)

    def _keep(self, call: int, under_way: UnderWay) -> None:
        """Keep a call, unless it has ended already."""
        if call in self._begun:
            self._calls[call] = under_way

    def _end(
        self, call: int, outcome: OperationOutcome, outs: list[Out] | None = None, made: int | None = None
    ) -> None:
        if call not in self._begun:
            return
        self._begun.discard(call)
        self._calls.pop(call, None)
        try:
            results = [[self._wire.from_value(out.value)] if out.is_set else [] for out in outs or ()]
        except NotSendable as error:
            results, outcome = [], not_sendable(error)
        reason = self.data(outcome.reason, "a reason")
        if not self.line.say(protocol.Ended(call, outcome.ok, outcome.message, reason, results, made)):
            self.line.say(protocol.Ended(call, False, protocol.TOO_LARGE, None, [], made))

    def on_create(self, asked: protocol.Create) -> None:
        """Create an artifact of a type that this member knows."""

        def made(artifact: ArtifactId | None, outcome: OperationOutcome) -> None:
            self._end(asked.call, outcome, made=None if artifact is None else self.names.number(artifact))

        environment = self._environment()
        workspace = environment.workspace(asked.workspace)
        if workspace not in environment.own():
            raise _not_own(asked.workspace)  # members do not use the rights that this one has at others
        _check_imports(asked.type_name)
        arguments, creator = self._wire.to_value(asked.arguments), self._caller(asked.creator)
        self._begun.add(asked.call)
        self._keep(asked.call, workspace.create(asked.name, asked.type_name, arguments, creator, made))

    def fail(self, call: int, outcome: OperationOutcome) -> None:
        """Answer that a call has failed."""
        self._begun.add(call)
        self._end(call, outcome)

    def on_create_workspace(self, asked: protocol.CreateWorkspace) -> None:
        """Create a workspace."""

        def create(done: OnOutcome) -> None:
            self._environment().create_workspace(asked.path)
            done(SUCCEEDED)

        self._request(asked.call, create)

    def on_dispose(self, asked: protocol.Dispose) -> None:
        """Dispose an artifact."""
        self._on_artifact(
            asked.call, asked.artifact, lambda a, done: self._workspace_of(a).dispose_artifact(a, done)
        )

    def on_link(self, asked: protocol.Link) -> None:
        """Link two artifacts."""
        target = self.names.own(asked.to)
        if target is None:
            self.fail(asked.call, _gone(asked.to))
            return
        self._on_artifact(
            asked.call,
            asked.artifact,
            lambda a, done: self._workspace_of(a).link(a, asked.port, target, done),
        )

    def on_focus(self, asked: protocol.Focus) -> None:
        """Let an agent observe an artifact."""

        def focus(artifact: ArtifactId, done: OnOutcome) -> None:
            key = (asked.observer, asked.artifact)
            workspace = self._workspace_of(artifact)
            if (former := self._watching.pop(key, None)) is not None:
                former.is_replaced = True
                workspace.stop_focus(artifact, former)
                self.late.pop(former, None)
            watching = _Watching(self, asked.observer, self._called(asked.agent), artifact)

            def begun(outcome: OperationOutcome) -> None:
                watching.begin()
                done(outcome)

            workspace.focus(artifact, watching, begun)
            self._watching[key] = watching

        self._on_artifact(asked.call, asked.artifact, focus)

    def _on_artifact(
        self, call: int, number: int, request: Callable[[ArtifactId, OnOutcome], object]
    ) -> None:
        artifact = self.names.own(number)
        if artifact is None:
            self.fail(call, _gone(number))
            return
        self._request(call, lambda done: request(artifact, done))

    def _request(self, call: int, request: Callable[[OnOutcome], object]) -> None:
        self._begun.add(call)
        request(partial(self._end, call))

    def on_stop_focus(self, asked: protocol.StopFocus) -> None:
        """End an observer."""
        watching = self._watching.pop((asked.observer, asked.artifact), None)
        if watching is not None:
            self._workspace_of(watching.artifact).stop_focus(watching.artifact, watching)
            watching.flush()
            self.late.pop(watching, None)

    def on_handle(self, asked: protocol.Handle) -> None:
        """Cancel, pause or resume a call."""
        call = self._calls.get(asked.call)
        if call is None:
            return
        if asked.what == "cancel":
            del self._calls[asked.call]
            self._begun.discard(asked.call)
            call.cancel()
        elif asked.what == "pause":
            call.pause()
        elif asked.what == "resume":
            call.resume()


def _check_imports(type_name: str) -> None:
    """Check that no installed module is imported to find a type: another member would choose which code runs here."""
    module = type_name.rpartition(".")[0]
    top = module.partition(".")[0]
    if top not in ("", "jacaros") and module not in sys.modules and find_spec(top) is not None:
        reason = Structure("makeArtifactFailure", ("unknown_artifact_template", type_name))
        raise OperationFailed(
            f"cannot create a {type_name}: this system does not use {module} itself", reason
        )


def _not_own(path: str) -> UnknownWorkspace:
    """Return the failure of a request for a workspace of another member."""
    return UnknownWorkspace(
        f"workspace `{path}` is not of this system", Structure("unknown_workspace", (path,))
    )


def _gone(number: int) -> OperationOutcome:
    reason = Structure("artifact_not_available", (number,))
    return OperationOutcome(False, "the artifact is gone", reason)


def not_sendable(error: NotSendable) -> OperationOutcome:
    """Return the outcome of an operation whose values cannot be sent."""
    return OperationOutcome(False, str(error), Structure("not_sendable", (type(error.value).__name__,)))
