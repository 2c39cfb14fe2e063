"""A second implementation of the ports: two systems joined by a queue, over which nothing goes but lines of text.

What a network would do, in small: each side serves its agents, its services and some of its workspaces, and sees those of
the other one as its own.  Every line is JSON, and arrives some turns of the loop later.
"""

import asyncio
import json
from collections.abc import Callable, Collection, Sequence
from functools import partial
from typing import Any

from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.mind.state.act import Services, SpeechAct
from jacaros.agents.terms.text import text
from jacaros.artifacts.env import ports
from jacaros.artifacts.env.artifact import Artifact
from jacaros.artifacts.env.errors import ArtifactId, UnknownArtifact
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest, ignore_outcome
from jacaros.artifacts.env.ports import OnMade, OnOutcome, UnderWay, ignore_made
from jacaros.artifacts.env.property import ObservableProperty, Observation, Observer, Signal
from jacaros.artifacts.env.values import Atom, Out, Structure
from jacaros.runtime.mas.system import System
from jacaros.runtime.trace import Cause

HOPS = 3
"""Turns of the loop that a line takes."""


class Cable:
    """One direction: lines arrive in order, late."""

    def __init__(self) -> None:
        self.lines = 0
        self.receive: Callable[[str, list[Any]], None] = lambda kind, data: None

    def send(self, kind: str, *data: Any) -> None:
        """Send one line."""
        self.lines += 1
        self._hop(json.dumps([kind, *data]), HOPS)

    def _hop(self, line: str, left: int) -> None:
        if left:
            asyncio.get_running_loop().call_soon(self._hop, line, left - 1)
        else:
            kind, *data = json.loads(line)
            self.receive(kind, data)


class Ids:
    """The numbers by which two sides call an artifact: of the side that has it, and a number of that one's."""

    def __init__(self, side: str) -> None:
        self.side = side
        self._by_number: dict[tuple[str, int], ArtifactId] = {}
        self._numbers: dict[ArtifactId, tuple[str, int]] = {}

    def number(self, artifact: ArtifactId) -> tuple[str, int]:
        """How an artifact is described to the other side."""
        if artifact not in self._numbers:
            self.know((self.side, len(self._numbers)), artifact)
        return self._numbers[artifact]

    def know(self, number: tuple[str, int], artifact: ArtifactId) -> None:
        """Call an artifact so from now on."""
        self._numbers[artifact] = number
        self._by_number[number] = artifact

    def find(self, number: Sequence[Any]) -> ArtifactId:
        """The announced artifact."""
        return self._by_number[number[0], number[1]]

    def encode(self, value: object, outs: list[Out] | None = None) -> Any:
        """A plain value as JSON has it."""
        if isinstance(value, Atom):
            return {"atom": str.__str__(value)}
        if isinstance(value, Structure):
            return {"functor": value.functor, "arguments": self.encode(list(value.arguments), outs)}
        if isinstance(value, list):
            return [self.encode(each, outs) for each in value]
        if isinstance(value, ArtifactId):
            return {"artifact": self.number(value)}
        if isinstance(value, Out):
            if outs is None:
                return {"atom": "_"}
            if value not in outs:
                outs.append(value)
            return {"out": outs.index(value)}
        if value is None or isinstance(value, (bool, int, float, str)):
            return value
        raise TypeError(f"{value!r} does not go over a wire")

    def decode(self, value: Any, outs: list[Out] | None = None) -> Any:
        """What `encode` had."""
        if isinstance(value, list):
            return [self.decode(each, outs) for each in value]
        if not isinstance(value, dict):
            return value
        if "atom" in value:
            return Atom(value["atom"])
        if "functor" in value:
            return Structure(value["functor"], tuple(self.decode(value["arguments"], outs)))
        if "artifact" in value:
            return self.find(value["artifact"])
        assert outs is not None
        while len(outs) <= value["out"]:
            outs.append(Out())
        return outs[value["out"]]


# ---- workspaces


class _Reporting:
    """Observes on behalf of the other side."""

    def __init__(self, server: "WorkspaceServer", number: int, agent: str) -> None:
        self.agent = agent
        self._server, self._number = server, number

    def observe(self, observation: Observation) -> None:
        self._server.report(self._number, observation)


class WorkspaceServer:
    """Serves a workspace of this side."""

    def __init__(self, workspace: ports.Workspace, cable: Cable, ids: Ids) -> None:
        self.path = workspace.path
        self._workspace, self._cable, self._ids = workspace, cable, ids
        self._calls: dict[int, UnderWay] = {}
        self._observers: dict[int, _Reporting] = {}
        for artifact in workspace.artifacts():
            self._changed(artifact, True)
        workspace.watch(self._changed)

    def _changed(self, artifact: ArtifactId, present: bool) -> None:
        number = self._ids.number(artifact)
        if not present:
            self._send("gone", number)
            return
        offers = list(self._workspace.offers(artifact))
        self._send("present", number, artifact.name, artifact.type_name, artifact.creator, offers)

    def _send(self, kind: str, *data: Any) -> None:
        self._cable.send("to client", self.path, kind, *data)

    def report(self, observer: int, seen: Observation) -> None:
        """Send an observation."""
        parts = (seen.changed, [(each, each) for each in seen.added], [(each, each) for each in seen.removed])
        told = [[[self._property(a), self._property(b)] for a, b in part] for part in parts]
        signals = [[each.name, self._ids.encode(list(each.arguments))] for each in seen.signals]
        self._send("observed", observer, self._ids.number(seen.artifact), signals, *told)

    def _property(self, each: ObservableProperty) -> list[Any]:
        return [
            each.name,
            self._ids.encode(list(each.values)),
            self._ids.encode(list(each.annotations)),
            each.key,
        ]

    def receive(self, kind: str, data: list[Any]) -> None:
        """Do what the other side asks for."""
        getattr(self, f"_on_{kind}")(*data)

    def _end(self, call: int, outcome: OperationOutcome, *more: Any) -> None:
        self._calls.pop(call, None)
        reason = self._ids.encode(outcome.reason)
        self._send("ended", call, outcome.ok, outcome.message, reason, *more)

    def _on_execute(
        self, call: int, number: list[Any], operation: str, arguments: Any, agent: str | None, timeout: Any
    ) -> None:
        outs: list[Out] = []
        artifact = self._ids.find(number)

        def done(outcome: OperationOutcome) -> None:
            self._end(
                call,
                outcome,
                [[each.is_set, self._ids.encode(each.value if each.is_set else None)] for each in outs],
            )

        given = tuple(self._ids.decode(arguments, outs))
        request = OperationRequest(artifact, operation, given, agent, None, done)
        request.timeout = timeout
        self._keep(call, self._workspace.execute(request))

    def _keep(self, call: int, under_way: UnderWay) -> None:
        if not getattr(under_way, "ended", False):
            self._calls[call] = under_way

    def _on_create(self, call: int, name: str, type_name: str, arguments: Any, creator: str | None) -> None:
        def made(artifact: ArtifactId | None, outcome: OperationOutcome) -> None:
            self._end(call, outcome, self._ids.encode(artifact))

        self._keep(call, self._workspace.create(name, type_name, self._ids.decode(arguments), creator, made))

    def _on_handle(self, call: int, what: str) -> None:
        if call in self._calls:
            getattr(self._calls[call], what)()
            if what == "cancel":
                self._calls.pop(call, None)

    def _on_dispose(self, call: int, number: list[Any]) -> None:
        self._workspace.dispose_artifact(self._ids.find(number), lambda outcome: self._end(call, outcome))

    def _on_focus(self, call: int, number: list[Any], observer: int, agent: str) -> None:
        reporting = self._observers.setdefault(observer, _Reporting(self, observer, agent))
        self._workspace.focus(self._ids.find(number), reporting, lambda outcome: self._end(call, outcome))

    def _on_stop_focus(self, number: list[Any], observer: int) -> None:
        self._workspace.stop_focus(self._ids.find(number), self._observers[observer])

    def _on_link(self, call: int, source: list[Any], port: str, target: list[Any]) -> None:
        link = self._workspace.link
        link(self._ids.find(source), port, self._ids.find(target), lambda outcome: self._end(call, outcome))


class _Call:
    """The handle of something that is under way on the other side."""

    def __init__(self, client: "RemoteWorkspace", number: int) -> None:
        self._client, self._number = client, number

    def __getattr__(self, what: str) -> Callable[[], None]:
        return partial(self._client.handle, self._number, what)


class RemoteWorkspace(ports.Workspace):
    """A workspace of the other side, with a copy of what is there and what that offers."""

    def __init__(self, path: str, served: str, cable: Cable, ids: Ids) -> None:
        self.path = path
        self.name = path.rpartition("/")[2]
        self._served, self._cable, self._ids = served, cable, ids
        self._offers: dict[ArtifactId, Collection[str]] = {}
        self._watchers: list[Callable[[ArtifactId, bool], None]] = []
        self._ends: dict[int, Callable[..., None]] = {}
        self._calls = 0
        self._observers: dict[int, Observer] = {}

    # ---- looked up

    def artifacts(self) -> tuple[ArtifactId, ...]:
        return tuple(self._offers)

    def lookup(self, name: str) -> ArtifactId:
        for artifact in self._offers:
            if artifact.name == name:
                return artifact
        reason = Structure("artifact_not_available", (name,))
        raise UnknownArtifact(f"unknown artifact `{name}` in workspace {self.path}", reason)

    def watch(
        self, watcher: Callable[[ArtifactId, bool], None], personal: bool = False
    ) -> Callable[[], None]:
        self._watchers.append(watcher)
        return lambda: self._watchers.remove(watcher)

    def providers(self, operation: str, arity: int) -> tuple[ArtifactId, ...]:
        wanted = {f"{operation}/{arity}", f"{operation}/any"}
        return tuple(artifact for artifact, offers in self._offers.items() if wanted.intersection(offers))

    def offers(self, artifact_id: ArtifactId) -> Collection[str]:
        return self._offers[artifact_id]

    # ---- asked for

    def _ask(self, done: Callable[..., None], kind: str, *data: Any) -> _Call:
        self._calls += 1
        self._ends[self._calls] = done
        self._cable.send("to server", self._served, kind, self._calls, *data)
        return _Call(self, self._calls)

    def handle(self, call: int, what: str) -> None:
        """Cancel, pause or resume something."""
        if what == "cancel":
            self._ends.pop(call, None)
        self._cable.send("to server", self._served, "handle", call, what)

    def create(
        self,
        name: str,
        type_name: str | type[Artifact],
        args: Sequence[object] = (),
        creator: str | None = None,
        on_done: OnMade = ignore_made,
        cause: Cause | None = None,
    ) -> UnderWay:
        def made(outcome: OperationOutcome, artifact: Any = None) -> None:
            on_done(self._ids.decode(artifact), outcome)

        type_name = type_name if isinstance(type_name, str) else type_name.__name__
        return self._ask(made, "create", name, type_name, self._ids.encode(list(args)), creator)

    def dispose_artifact(self, artifact_id: ArtifactId, on_done: OnOutcome = ignore_outcome) -> None:
        self._ask(on_done, "dispose", self._ids.number(artifact_id))

    def execute(self, request: OperationRequest) -> UnderWay:
        outs: list[Out] = []
        arguments = self._ids.encode(list(request.arguments), outs)

        def done(outcome: OperationOutcome, results: Sequence[Any] = ()) -> None:
            for out, (is_set, value) in zip(outs, results, strict=False):
                if is_set:
                    out.set(self._ids.decode(value))
            request.on_done(outcome)

        number = self._ids.number(request.artifact)
        return self._ask(
            done, "execute", number, request.operation, arguments, request.agent, request.timeout
        )

    def focus(self, artifact_id: ArtifactId, observer: Observer, on_done: OnOutcome = ignore_outcome) -> None:
        self._observers[id(observer)] = observer
        self._ask(on_done, "focus", self._ids.number(artifact_id), id(observer), observer.agent)

    def stop_focus(self, artifact_id: ArtifactId, observer: Observer) -> None:
        self._cable.send("to server", self._served, "stop_focus", self._ids.number(artifact_id), id(observer))

    def link(
        self, from_id: ArtifactId, port: str, to_id: ArtifactId, on_done: OnOutcome = ignore_outcome
    ) -> None:
        self._ask(on_done, "link", self._ids.number(from_id), port, self._ids.number(to_id))

    # ---- what the other side tells

    def receive(self, kind: str, data: list[Any]) -> None:
        """Take note of what the other side tells."""
        getattr(self, f"_on_{kind}")(*data)

    def _on_present(
        self, number: list[Any], name: str, type_name: str, creator: str | None, offers: list[str]
    ) -> None:
        artifact = ArtifactId(name, type_name, self.path, number[1], creator)
        self._ids.know((number[0], number[1]), artifact)
        self._offers[artifact] = offers
        self._tell(artifact, True)

    def _on_gone(self, number: list[Any]) -> None:
        artifact = self._ids.find(number)
        del self._offers[artifact]
        self._tell(artifact, False)

    def _tell(self, artifact: ArtifactId, present: bool) -> None:
        for watcher in tuple(self._watchers):
            watcher(artifact, present)

    def _on_ended(self, call: int, ok: bool, message: str | None, reason: Any, *more: Any) -> None:
        done = self._ends.pop(call, None)
        if done is not None:
            done(OperationOutcome(ok, message, self._ids.decode(reason)), *more)

    def _on_observed(
        self, observer: int, number: list[Any], signals: Any, changed: Any, added: Any, removed: Any
    ) -> None:
        told = [
            [(self._property(before), self._property(after)) for before, after in part]
            for part in (changed, added, removed)
        ]
        seen = Observation(
            self._ids.find(number),
            tuple(Signal(name, tuple(self._ids.decode(arguments))) for name, arguments in signals),
            tuple(told[0]),
            tuple(after for _, after in told[1]),
            tuple(before for before, _ in told[2]),
        )
        self._observers[observer].observe(seen)

    def _property(self, written: list[Any]) -> ObservableProperty:
        name, values, annotations, key = written
        return ObservableProperty(
            name, tuple(self._ids.decode(values)), tuple(self._ids.decode(annotations)), key
        )


# ---- agents and services


class _RemoteMailbox:
    """Sends messages for agents of the other side over the cable."""

    def __init__(self, cable: Cable) -> None:
        self._cable = cable

    def receive(self, message: SpeechAct) -> None:
        self._cable.send("message", *_written(message))


def _written(message: SpeechAct) -> list[Any]:
    content = text(message.content)
    return [message.performative, message.sender, message.receiver, content, message.id, message.in_reply_to]


def _read(data: list[Any]) -> SpeechAct:
    performative, sender, receiver, content, number, in_reply_to = data
    return SpeechAct(performative, sender, receiver, lower_value(parse_term(content)), number, in_reply_to)


class RemoteAgents:
    """The agents of the other side, as far as it has told of them: `jacaros.runtime.mas.directory.Participants`."""

    def __init__(self, cable: Cable) -> None:
        self._mailbox = _RemoteMailbox(cable)
        self._names: dict[str, None] = {}

    def names(self) -> Sequence[str]:
        return tuple(self._names)

    def find(self, name: str) -> _RemoteMailbox | None:
        return self._mailbox if name in self._names else None

    def know(self, name: str, present: bool) -> None:
        """An agent came or went there."""
        if present:
            self._names[name] = None
        else:
            self._names.pop(name, None)


class RemoteServices:
    """The directory facilitator of the other side, with a copy of what it knows: a `Services`."""

    def __init__(self, cable: Cable) -> None:
        self._cable = cable
        self._providers: dict[str, list[str]] = {}

    def __getattr__(self, what: str) -> Callable[[str, str], None]:
        """What is asked of the other one: ``register``, ``deregister``, ``subscribe``."""
        return partial(self._cable.send, "service", what)

    def providers(self, service: str) -> Sequence[str]:
        return self._providers.get(service, [])

    def know(self, name: str, service: str, provides: bool) -> None:
        """An agent provides a service, or no longer does."""
        known = self._providers.setdefault(service, [])
        if provides and name not in known:
            known.append(name)
        elif not provides and name in known:
            known.remove(name)


class Side:
    """One end of the cables, with its system."""

    def __init__(self, name: str, system: System, out: Cable, into: Cable) -> None:
        self.system, self.out = system, out
        self.ids = Ids(name)
        self.agents = RemoteAgents(out)
        self.clients: dict[str, RemoteWorkspace] = {}
        self.servers: dict[str, WorkspaceServer] = {}
        into.receive = self._receive
        system.directory.join(self.agents)
        for host in system.directory:
            out.send("agent", host.name, True)
        system.directory.watch(lambda name, present: out.send("agent", name, present))

    def _receive(self, kind: str, data: list[Any]) -> None:
        if kind == "to server":
            self.servers[data[0]].receive(data[1], data[2:])
        elif kind == "to client":
            self.clients[data[0]].receive(data[1], data[2:])
        elif kind == "agent":
            self.agents.know(*data)
        elif kind == "message":
            if not self.system.deliver(_read(data)):
                self.out.send("returned", *data)
        elif kind == "returned":
            self.system.mailboxes.returned(_read(data))
        elif kind == "service":
            services: Services = self.system.services
            getattr(services, data[0])(*data[1:])
        elif kind == "provider":
            assert isinstance(self.system.services, RemoteServices)
            self.system.services.know(*data)


def join(first: System, second: System) -> tuple[Side, Side]:
    """Join two systems; the second one uses the directory facilitator of the first."""
    there, back = Cable(), Cable()
    sides = Side("first", first, there, back), Side("second", second, back, there)
    second.services = RemoteServices(back)
    first.services.watch(lambda *news: there.send("provider", *news))  # type: ignore[attr-defined]
    return sides


def share(server: Side, client: Side, path: str, seen_as: str | None = None) -> RemoteWorkspace:
    """Let a workspace of one side be seen on the other one, perhaps under another path."""
    environment = server.system.run_environment().environment
    remote = RemoteWorkspace(seen_as or path, path, client.out, client.ids)
    client.clients[path] = remote
    server.servers[path] = WorkspaceServer(environment.workspace(path), server.out, server.ids)
    client.system.run_environment().environment.mount(remote)
    return remote
