"""Workspaces of another member, as this one sees them.

While their member is lost, their artifacts cannot be found, operations fail, and observers see no properties. The focus
of an agent lasts: when the member returns, its properties do.
"""

from collections.abc import Callable, Collection, Mapping, Sequence
from functools import partial
from types import MappingProxyType
from typing import Any

from jacaros.artifacts.env import ports
from jacaros.artifacts.env.errors import ArtifactId, UnknownArtifact
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest, ignore_outcome
from jacaros.artifacts.env.ports import ENDED, OnMade, OnOutcome, UnderWay, ignore_made
from jacaros.artifacts.env.property import ObservableProperty, Observation, Observer, Signal
from jacaros.artifacts.env.values import Out, Structure
from jacaros.artifacts.kernel.faults import not_available
from jacaros.fleet import protocol
from jacaros.fleet.artifacts import ArtifactNames
from jacaros.fleet.causes import Causes
from jacaros.fleet.served import Line, not_sendable
from jacaros.fleet.wire import NotSendable, Wire
from jacaros.runtime.files.texts import aside
from jacaros.runtime.trace import Cause

_NONE: Mapping[Any, Any] = MappingProxyType({})


class _Call:
    """The handle of a call."""

    def __init__(self, calls: "Calls", number: int) -> None:
        self._calls, self._number = calls, number

    def cancel(self) -> None:
        """Cancel it."""
        self._calls.handle(self._number, "cancel")

    def pause(self) -> None:
        """Pause it."""
        self._calls.handle(self._number, "pause")

    def resume(self) -> None:
        """Let it continue."""
        self._calls.handle(self._number, "resume")


class Calls:
    """What this member has asked another one for, and waits for.

    Args:
        line: the way to it.
        member: its name, for failures.
    """

    def __init__(self, line: Line, member: str) -> None:
        self._line, self._member = line, member
        self._count = 0
        self._waiting: dict[int, Callable[[protocol.Ended], None]] = {}

    def ask(self, said: Callable[[int], protocol.Said], done: Callable[[protocol.Ended], None]) -> UnderWay:
        """Ask for something. *said* gets the number of the call."""
        self._count += 1
        self._waiting[self._count] = done
        call = _Call(self, self._count)
        if not self._line.say(said(self._count)):
            self.ended(protocol.Ended(self._count, False, protocol.TOO_LARGE, None, [], None))
        return call

    def handle(self, call: int, what: str) -> None:
        """Cancel, pause or resume a call, unless it has ended."""
        if call in self._waiting:
            if what == "cancel":
                del self._waiting[call]
            self._line.say(protocol.Handle(call, what))

    def ended(self, ended: protocol.Ended) -> None:
        """Take in the outcome of a call."""
        done = self._waiting.pop(ended.call, None)
        if done is not None:
            done(ended)

    def lost(self) -> None:
        """End all calls: the other member is gone, and what became of them is unknown."""
        waiting, self._waiting = self._waiting, {}
        for call, done in waiting.items():
            self._line.say(protocol.Handle(call, "cancel"))  # if it was only this member that was not heard
            done(protocol.Ended(call, False, *gone(self._member), [], None))


def gone(member: str) -> tuple[str, Any]:
    """Return message and reason (as data) of what failed because a member is gone."""
    return f"the system {member} does not answer", [1, "member_lost", [0, member]]


class _Focus:
    """One observer of one artifact, and what it knows."""

    def __init__(self, number: int, artifact: ArtifactId, observer: Observer) -> None:
        self.number, self.artifact, self.observer = number, artifact, observer
        self.properties: dict[int, ObservableProperty] = {}

    def clear(self) -> None:
        """Let the observer lose all properties."""
        if self.properties:
            removed = tuple(self.properties.values())
            self.properties.clear()
            self.observer.observe(Observation(self.artifact, removed=removed))


class RemoteWorkspaces:
    """All workspaces of one run of another member.

    Args:
        run: that run.
        names: names of artifacts.
        wire: converts values.
        line: the way to the member.
        calls: calls to it.
        causes: describes what led to something.

    Attributes:
        present: whether the member answers.
    """

    def __init__(
        self, run: str, names: ArtifactNames, wire: Wire, line: Line, calls: Calls, causes: Causes
    ) -> None:
        self.run, self.names, self.wire, self.line, self.calls = run, names, wire, line, calls
        self.causes = causes
        self.present = True
        self.focuses: dict[tuple[ArtifactId, Observer], _Focus] = {}
        self._by_number: dict[int, _Focus] = {}
        self._count = 0

    # ---- focuses

    def focus(self, artifact: ArtifactId, observer: Observer, on_done: OnOutcome) -> None:
        """Begin to observe an artifact."""
        known = self.focuses.get((artifact, observer))
        focus = known or self._begin(artifact, observer)

        def done(ended: protocol.Ended) -> None:
            if not ended.ok and known is None and self.focuses.get((artifact, observer)) is focus:
                self.stop_focus(artifact, observer)
            on_done(self.outcome(ended))

        self.calls.ask(partial(self._focus, focus), done)

    def _begin(self, artifact: ArtifactId, observer: Observer) -> _Focus:
        self._count += 1
        focus = _Focus(self._count, artifact, observer)
        self.focuses[artifact, observer] = self._by_number[focus.number] = focus
        return focus

    def _focus(self, focus: _Focus, call: int) -> protocol.Focus:
        return protocol.Focus(call, self.names.number(focus.artifact), focus.number, focus.observer.agent)

    def stop_focus(self, artifact: ArtifactId, observer: Observer) -> None:
        """End it."""
        focus = self.focuses.pop((artifact, observer), None)
        if focus is not None:
            del self._by_number[focus.number]
            self.line.say(protocol.StopFocus(self.names.number(artifact), focus.number))
            focus.clear()

    def observed(self, seen: protocol.Observed) -> None:
        """Pass on what an artifact published."""
        focus = self._by_number.get(seen.observer)
        if focus is None:
            return
        known, value = focus.properties, self.wire.to_value
        signals = tuple(Signal(name, tuple(value(arguments))) for name, arguments in seen.signals)
        gone = seen.removed
        if seen.whole:
            gone = list(known.keys() - {key for key, _, _, _ in seen.properties})
        removed = tuple(known.pop(key) for key in gone if key in known)
        changed: list[tuple[ObservableProperty, ObservableProperty]] = []
        added: list[ObservableProperty] = []
        for key, name, values, annotations in seen.properties:
            new = ObservableProperty(name, tuple(value(values)), tuple(value(annotations)), key)
            old = known.get(key)
            if old is None:
                added.append(new)
            elif not seen.whole or old != new:  # a renewed focus repeats what is known
                changed.append((old, new))
            known[key] = new
        if signals or removed or changed or added:
            observation = Observation(focus.artifact, signals, tuple(changed), tuple(added), removed)
            focus.observer.observe(self.causes.observed(observation, seen.cause))

    def lose(self) -> None:
        """The member does not answer: nothing is known of its artifacts."""
        self.present = False
        for focus in list(self.focuses.values()):
            focus.clear()

    def find(self) -> None:
        """The member answers again: observe what was observed before."""
        self.present = True
        for focus in list(self.focuses.values()):
            self.calls.ask(partial(self._focus, focus), lambda ended: None)

    def forget(self, artifact: ArtifactId) -> None:
        """Forget an artifact that is gone."""
        for of, observer in [each for each in self.focuses if each[0] is artifact]:
            self.stop_focus(of, observer)

    # ---- values

    def outcome(self, ended: protocol.Ended) -> OperationOutcome:
        """Return the outcome of a call."""
        return OperationOutcome(ended.ok, ended.message, self.wire.to_value(ended.reason))


class RemoteWorkspace(ports.Workspace):
    """A workspace of another member.

    Args:
        path: where it is visible here.
        its_path: its path there.
        member: name of its member.
        all: all workspaces of its member.
    """

    def __init__(self, path: str, its_path: str, member: str, all: RemoteWorkspaces) -> None:
        self.path, self.its_path = path, its_path
        self.name = path.rpartition("/")[2]
        self.member, self._all = member, all
        self._offers: dict[ArtifactId, Collection[str]] = {}
        self._watchers: dict[object, Callable[[ArtifactId, bool], None]] = {}

    # ---- lookups

    def artifacts(self) -> tuple[ArtifactId, ...]:
        return tuple(self._offers) if self._all.present else ()

    def lookup(self, name: str) -> ArtifactId:
        for artifact in self.artifacts():
            if artifact.name == name:
                return artifact
        lost = "" if self._all.present else f": {gone(self.member)[0]}"
        help = aside(name, [each.name for each in self.artifacts()])
        reason = Structure("artifact_not_available", (name,))
        raise UnknownArtifact(f"unknown artifact `{name}` in workspace {self.path}{help}{lost}", reason)

    def watch(
        self, watcher: Callable[[ArtifactId, bool], None], personal: bool = False
    ) -> Callable[[], None]:
        key = object()
        self._watchers[key] = watcher
        return lambda: self._watchers.pop(key, None) and None

    def providers(self, operation: str, arity: int) -> tuple[ArtifactId, ...]:
        wanted = {f"{operation}/{arity}", f"{operation}/any"}
        return tuple(each for each in self.artifacts() if not wanted.isdisjoint(self._offers[each]))

    def offers(self, artifact_id: ArtifactId) -> Collection[str]:
        self._check(artifact_id)
        return self._offers[artifact_id]

    def has_method(self, artifact_id: ArtifactId, name: str) -> bool:
        return False

    def _check(self, artifact_id: ArtifactId) -> None:
        if artifact_id not in self._offers or not self._all.present:
            missing = not_available(artifact_id)
            raise UnknownArtifact(missing.message or "", missing.reason)

    # ---- requests

    def create(
        self,
        name: str,
        type_name: str | type[Any],
        args: Sequence[object] = (),
        creator: str | None = None,
        on_done: OnMade = ignore_made,
        cause: Cause | None = None,
    ) -> UnderWay:
        type_name = type_name if isinstance(type_name, str) else type_name.__name__
        try:
            arguments = self._all.wire.from_value(list(args))
        except NotSendable as error:
            on_done(None, not_sendable(error))
            return ENDED

        def done(ended: protocol.Ended) -> None:
            made = self._with_number(ended.artifact) if ended.artifact is not None else None
            on_done(made, self._all.outcome(ended))

        its_path = self.its_path
        return self._ask(
            lambda call: protocol.Create(call, its_path, name, type_name, arguments, creator), done
        )

    def _ask(self, said: Callable[[int], protocol.Said], done: Callable[[protocol.Ended], None]) -> UnderWay:
        if not self._all.present:
            done(protocol.Ended(0, False, *gone(self.member), [], None))
            return ENDED
        return self._all.calls.ask(said, done)

    def _with_number(self, number: int) -> ArtifactId | None:
        return next((each for each in self._offers if self._all.names.number(each) == number), None)

    def dispose_artifact(self, artifact_id: ArtifactId, on_done: OnOutcome = ignore_outcome) -> None:
        self._check(artifact_id)
        number = self._all.names.number(artifact_id)
        self._ask(lambda call: protocol.Dispose(call, number), self._reporting(on_done))

    def _reporting(self, on_done: OnOutcome) -> Callable[[protocol.Ended], None]:
        return lambda ended: on_done(self._all.outcome(ended))

    def take_back(self, artifact_id: ArtifactId) -> None:
        """Do nothing: what `offer` returned exists here only."""

    def execute(self, request: OperationRequest) -> UnderWay:
        outs: list[Out] = []
        wire = self._all.wire
        try:
            arguments = wire.from_value(list(request.arguments), outs)
        except NotSendable as error:
            request.on_done(not_sendable(error))
            return ENDED
        if request.artifact not in self._offers:
            request.on_done(not_available(request.artifact))
            return ENDED

        def done(ended: protocol.Ended) -> None:
            for out, result in zip(outs, ended.results, strict=False):
                if result:
                    out.set(wire.to_value(result[0]))
            request.on_done(self._all.outcome(ended))

        def said(call: int) -> protocol.Execute:
            number, cause = self._all.names.number(request.artifact), self._all.causes.of_request(request)
            return protocol.Execute(
                call,
                number,
                request.operation,
                arguments,
                request.agent,
                request.timeout,
                request.urgency,
                request.policy,
                request.yields,
                cause,
            )

        return self._ask(said, done)

    def focus(self, artifact_id: ArtifactId, observer: Observer, on_done: OnOutcome = ignore_outcome) -> None:
        self._check(artifact_id)
        self._all.focus(artifact_id, observer, on_done)

    def stop_focus(self, artifact_id: ArtifactId, observer: Observer) -> None:
        self._all.stop_focus(artifact_id, observer)

    def link(
        self, from_id: ArtifactId, port: str, to_id: ArtifactId, on_done: OnOutcome = ignore_outcome
    ) -> None:
        for each in (from_id, to_id):
            self._check(each)
        name, to = self._all.names.number(from_id), self._all.names.number(to_id)
        self._ask(lambda call: protocol.Link(call, name, port, to), self._reporting(on_done))

    # ---- what its member says

    def told(self, number: int, data: protocol.ArtifactData | None) -> None:
        """Hear that an artifact was created, has other operations, or is gone."""
        if data is None:
            artifact = self._with_number(number)
            if artifact is not None:
                self._remove(artifact)
            return
        _, name, type_name, creator, offers = data
        found = self._all.names.announced((self._all.run, number, name, type_name, self.its_path), creator)
        is_new = found not in self._offers
        self._offers[found] = frozenset(offers)
        if is_new:
            self._tell(found, True)

    def data(self) -> list[protocol.ArtifactData]:
        """Return what is known of all artifacts, as its member said it."""
        return [
            (self._all.names.number(each), each.name, each.type_name, each.creator, list(offers))
            for each, offers in self._offers.items()
        ]

    def told_all(self, artifacts: Sequence[protocol.ArtifactData]) -> None:
        """Hear of all artifacts."""
        numbers = {data[0] for data in artifacts}
        for artifact in [each for each in self._offers if self._all.names.number(each) not in numbers]:
            self._remove(artifact)
        for data in artifacts:
            self.told(data[0], data)

    def _remove(self, artifact: ArtifactId) -> None:
        del self._offers[artifact]
        self._all.forget(artifact)
        self._tell(artifact, False)
        self._all.names.forget(artifact)

    def remove_all(self) -> None:
        """Its member will not return."""
        for artifact in tuple(self._offers):
            self._remove(artifact)

    def _tell(self, artifact: ArtifactId, present: bool) -> None:
        for watcher in tuple(self._watchers.values()):
            watcher(artifact, present)
