"""Workspaces: where artifacts are made, found, focused, linked, used and disposed."""

import asyncio
from collections.abc import Callable, Collection, Iterator, Mapping, Sequence
from functools import partial

from jacaros.env import ports
from jacaros.env.artifact import Artifact
from jacaros.env.creation import FindType, artifact_type_of, attach, init_failed, init_of, refused
from jacaros.env.errors import OperationFailed, UnknownArtifact, spelling_hint
from jacaros.env.execution import OperationExecution
from jacaros.env.ids import ArtifactId
from jacaros.env.kernel import faults
from jacaros.env.kernel.interface import Interface
from jacaros.env.kernel.registry import Registry
from jacaros.env.kernel.setting import Setting
from jacaros.env.kernel.steps import Steps
from jacaros.env.lookup import OperationIndex
from jacaros.env.manual import Manual, describe
from jacaros.env.observation import Observer
from jacaros.env.operation import (
    LINK,
    OPERATION,
    SUCCEEDED,
    OperationOutcome,
    OperationRequest,
    ignore_outcome,
    marks_of,
)
from jacaros.env.ports import Made, Told, nobody_waits
from jacaros.env.property import ObservableProperty, histories_of
from jacaros.env.values import Structure
from jacaros.trace import Cause

Watcher = Callable[[ArtifactId, bool], None]
"""Told of an artifact that comes (True) or goes (False)."""


class Workspace(ports.Workspace):
    """A named place for artifacts; made by `Environment.create_workspace`.

    Ids are good in the whole environment: what takes an id works for artifacts of other workspaces too.

    Attributes:
        path: full path, such as ``/main/lab``.
        name: last part of the path.
    """

    def __init__(self, path: str, registry: Registry, setting: Setting, find_type: FindType) -> None:
        self.path = path
        self.name = path.rpartition("/")[2]
        self._registry, self._setting, self._find_type = registry, setting, find_type
        self._artifacts: dict[str, ArtifactId] = {}
        self._personal: dict[str, ArtifactId] = {}
        self._making: dict[str, Steps] = {}
        self._indexes: dict[tuple[str, int], OperationIndex] = {}
        self._offers: dict[ArtifactId, dict[str, None]] = {}
        self._watchers: dict[object, Watcher] = {}
        self._watchers_of_all: dict[object, Watcher] = {}
        self._telling: tuple[Iterator[Watcher], ArtifactId, bool] | None = None

    # ---- artifacts come and go

    def offer(
        self, name: str, artifact_type: type[Artifact], args: Sequence[object] = (), personal: bool = False
    ) -> ArtifactId:
        """Have an artifact of JaCaROS itself, which is made when somebody first uses or perceives it.

        Args:
            name: unique in the workspace.
            artifact_type: its ``init`` is a plain ``def``.
            args: for ``init``.
            personal: it belongs to one agent: it is found by its name, and nobody's actions are done by it who
                does not name it.
        """
        artifact_id = self._new_id(name, artifact_type, None)
        make = partial(self._keep_promise, artifact_id, artifact_type, tuple(args))
        self._registry.promise(artifact_id, artifact_type.interface, make)
        if personal:
            self._personal[name] = artifact_id
            self._tell(tuple(self._watchers_of_all.values()), artifact_id, True)
        else:
            self._artifacts[name] = artifact_id
            self._changed(artifact_id, True)
        return artifact_id

    def _keep_promise(
        self, artifact_id: ArtifactId, artifact_type: type[Artifact], args: tuple[object, ...]
    ) -> Steps:
        steps = attach(artifact_type, artifact_id, self, self._setting)
        # Known at once: its ``init`` may look around.
        self._registry.add(steps, self._forget)
        request = OperationRequest(artifact_id, "init", args)
        steps.initialise(init_of(artifact_type, request), request)
        steps.initialised = True
        return steps

    def take_back(self, artifact_id: ArtifactId) -> None:
        """End an artifact that was offered, if it is still there."""
        name = artifact_id.name
        if artifact_id in (self._artifacts.get(name), self._personal.get(name)):
            self.dispose_artifact(artifact_id)

    def create(
        self,
        name: str,
        type_name: str | type[Artifact],
        args: Sequence[object] = (),
        creator: str | None = None,
        on_done: Made = nobody_waits,
        cause: Cause | None = None,
    ) -> OperationExecution:
        """Make an artifact like `make_artifact`, and tell *on_done*.

        An ``init`` that is a plain ``def`` has ended when this returns.  Cancelling what this gives
        ends the making, and nothing is left behind.
        """
        name = str.__str__(name)
        request = OperationRequest(
            self._new_id(name, type_name, creator), "init", tuple(args), creator, cause
        )
        try:
            artifact_type, steps = self._prepare(request.artifact, type_name)
            declared = init_of(artifact_type, request)
        except OperationFailed as failure:
            on_done(None, OperationOutcome(False, failure.message, failure.reason))
            return OperationExecution(None, request)
        self._making[name] = steps
        self._registry.add(steps, self._forget)
        steps.abandon = partial(self._registry.dispose, steps)
        request.on_done = partial(self._made, steps, on_done)
        return steps.initialise(declared, request)

    def _new_id(self, name: str, type_name: str | type[Artifact], creator: str | None) -> ArtifactId:
        kind = type_name if isinstance(type_name, str) else type_name.__name__
        return ArtifactId(name, str.__str__(kind), self.path, self._registry.next_number(), creator)

    def _prepare(
        self, artifact_id: ArtifactId, type_name: str | type[Artifact]
    ) -> tuple[type[Artifact], Steps]:
        name = artifact_id.name
        making = self._making.get(name)
        is_there = name in self._artifacts or name in self._personal
        if is_there or (making is not None and not making.disposed):
            raise refused(
                "artifact_already_present", name, f"workspace {self.path} has an artifact {name} already"
            )
        artifact_type = artifact_type_of(type_name, self._find_type, self._setting)
        return artifact_type, attach(artifact_type, artifact_id, self, self._setting)

    def _made(self, steps: Steps, on_done: Made, outcome: OperationOutcome) -> None:
        name = steps.id.name
        if self._making.get(name) is steps:
            del self._making[name]
        if not outcome.ok or steps.disposed:
            self._registry.dispose(steps)
            failure = init_failed(steps.id, outcome.message or "its init disposed it")
            on_done(None, OperationOutcome(False, failure.message, failure.reason))
            return
        steps.initialised = True
        self._artifacts[name] = steps.id
        self._changed(steps.id, True)
        on_done(steps.id, SUCCEEDED)

    def dispose_artifact(self, artifact_id: ArtifactId, on_done: Told = ignore_outcome) -> None:
        """End an artifact: observers are told that its properties are gone, its operations fail.

        Its `Artifact.dispose` runs when the last operation has ended, which may be after this returns.

        Raises:
            UnknownArtifact: it is gone already.
        """
        if self._registry.withdraw(artifact_id):
            self._forget(artifact_id)
        else:
            self._registry.dispose(self._steps_of(artifact_id))
        on_done(SUCCEEDED)

    def _forget(self, artifact_id: ArtifactId) -> None:
        if self._personal.get(artifact_id.name) is artifact_id:
            del self._personal[artifact_id.name]
            self._tell(tuple(self._watchers_of_all.values()), artifact_id, False)
        elif self._artifacts.get(artifact_id.name) is artifact_id:
            del self._artifacts[artifact_id.name]
            self._changed(artifact_id, False)

    async def close(self) -> None:
        """Dispose all artifacts, the last one made first, and wait until they have given back everything."""
        for steps in tuple(self._making.values()):
            self._registry.dispose(steps)
        for artifact_id in reversed((*self.artifacts(), *self.personal_artifacts())):
            self.dispose_artifact(artifact_id)
        await self._registry.ended()

    # ---- artifacts are found

    def artifacts(self) -> tuple[ArtifactId, ...]:
        """All artifacts, the oldest first; those that every workspace has are the first."""
        return tuple(self._artifacts.values())

    def personal_artifacts(self) -> tuple[ArtifactId, ...]:
        """The artifacts that stand for the agents in this workspace."""
        return tuple(self._personal.values())

    def lookup(self, name: str) -> ArtifactId:
        """Find an artifact by its name.

        Raises:
            UnknownArtifact: there is none, or its ``init`` has not ended.
        """
        found = self._artifacts.get(name) or self._personal.get(name)
        if found is None:
            help = spelling_hint(name, self._artifacts)
            message = f"workspace {self.path} has no artifact {name}{help}"
            raise UnknownArtifact(message, Structure("artifact_not_available", (str.__str__(name),)))
        return found

    async def available(self, name: str) -> ArtifactId:
        """Wait until there is an artifact of that name."""
        if name not in self._artifacts:
            found: asyncio.Future[None] = asyncio.get_running_loop().create_future()

            def look(artifact_id: ArtifactId, present: bool) -> None:
                if present and artifact_id.name == name and not found.done():
                    found.set_result(None)

            stop = self.watch(look)
            try:
                await found
            finally:
                stop()
        return self.lookup(name)

    def watch(self, watcher: Watcher, personal: bool = False) -> Callable[[], None]:
        """Call *watcher* with every artifact that comes (True) or goes (False); gives what ends that.

        Args:
            watcher: called at once, within the turn of the loop.
            personal: also with those of `personal_artifacts`.
        """
        watchers = self._watchers_of_all if personal else self._watchers
        watch = object()
        watchers[watch] = watcher
        return lambda: watchers.pop(watch, None) and None

    def providers(self, operation: str, arity: int) -> tuple[ArtifactId, ...]:
        """The artifacts that offer *operation* with *arity* arguments to agents, the oldest first."""
        index = self._indexes.get((operation, arity))
        if index is None:
            index = self._indexes[operation, arity] = OperationIndex()
            for artifact_id in self._artifacts.values():
                self._offer_of(artifact_id, operation, arity, index)
        return index.providers()

    def _offer_of(self, artifact_id: ArtifactId, operation: str, arity: int, index: OperationIndex) -> None:
        """Take an artifact into the index of an operation, if it offers it."""
        declared = self.interface(artifact_id).operations.find(operation, arity)
        if declared is not None:
            index.add(artifact_id, not declared.common and declared.signature.rest is None)

    def offers(self, artifact_id: ArtifactId) -> Collection[str]:
        """The operations of an artifact for agents, such as ``inc/1`` and ``sum/any``.

        Raises:
            UnknownArtifact: it is gone.
        """
        found = self._offers.get(artifact_id)
        if found is None:
            found = self._offers[artifact_id] = dict.fromkeys(self.interface(artifact_id).operations.keys())
        return found

    def artifact_type(self, type_name: str) -> type[Artifact]:
        """The class that `make_artifact` would make an artifact of.

        Raises:
            OperationFailed: there is none.
        """
        return artifact_type_of(type_name, self._find_type, self._setting)

    def manual(self, artifact_id: ArtifactId) -> Manual:
        """What an artifact offers, with the operations that it has defined for itself.

        Raises:
            UnknownArtifact: it is gone.
        """
        steps = self._steps_of(artifact_id)
        return describe(steps.artifact_type, steps.interface, steps.publication.committed())

    def operations_changed(self, artifact_id: ArtifactId) -> None:
        """Be told that an artifact has other operations from now on."""
        self._offers.pop(artifact_id, None)
        if self._artifacts.get(artifact_id.name) is artifact_id:
            self._indexes.clear()

    def interface(self, artifact_id: ArtifactId) -> Interface:
        """The operations of an artifact.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._registry.interface(artifact_id) or self._steps_of(artifact_id).interface

    def histories(self, artifact_id: ArtifactId) -> Mapping[str, float]:
        """For properties by name, the seconds for which those who focus an artifact keep past values.

        Raises:
            UnknownArtifact: it is gone.
        """
        return histories_of(self._steps_of(artifact_id).artifact_type)

    def has_method(self, artifact_id: ArtifactId, name: str) -> bool:
        """True when the author of an artifact's class wrote a public method of that name that is no operation of agents.

        Raises:
            UnknownArtifact: it is gone.
        """
        method = vars(self._steps_of(artifact_id).artifact_type).get(name)
        if name.startswith("_") or not callable(method):
            return False
        # One that is marked and not offered was taken away by `Artifact.remove_operation`.
        return all(mark.kind != OPERATION or mark.name not in (None, name) for mark in marks_of(method))

    def properties(self, artifact_id: ArtifactId) -> tuple[ObservableProperty, ...]:
        """The observable properties of an artifact, as observers know them.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._steps_of(artifact_id).publication.committed()

    def observers(self, artifact_id: ArtifactId) -> tuple[Observer, ...]:
        """Who focuses an artifact, in the order of focusing.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._steps_of(artifact_id).publication.observers

    def pending(self, artifact_id: ArtifactId) -> tuple[OperationExecution, ...]:
        """The operations of an artifact that run (its internal ones included) or wait to begin.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._steps_of(artifact_id).pending()

    # ---- artifacts are used

    def execute(self, request: OperationRequest) -> OperationExecution:
        """Run an operation for an agent.

        A plain ``def`` of a free artifact has ended when this returns: its changes are committed, observers
        have been told, then ``request.on_done``.
        """
        steps = self._registry.find(request.artifact)
        if steps is None:
            return self._gone(request)
        return steps.execute(request, OPERATION)

    def execute_linked(self, request: OperationRequest) -> OperationExecution:
        """Run a linked operation for another artifact; see `Artifact.call_linked`."""
        steps = self._registry.find(request.artifact)
        if steps is None:
            return self._gone(request)
        return steps.execute(request, LINK)

    def _gone(self, request: OperationRequest) -> OperationExecution:
        refused_execution = OperationExecution(None, request)
        request.on_done(faults.not_available(request.artifact))
        return refused_execution

    def focus(self, artifact_id: ArtifactId, observer: Observer, on_done: Told = ignore_outcome) -> None:
        """Let *observer* receive what an artifact publishes, beginning with all its properties.

        Focusing again has no effect.

        Raises:
            UnknownArtifact: it is gone.
        """
        self._steps_of(artifact_id).publication.add(observer)
        on_done(SUCCEEDED)

    def stop_focus(self, artifact_id: ArtifactId, observer: Observer) -> None:
        """Let *observer* receive nothing more, after the removal of all properties.

        Without effect when it does not focus the artifact, or the artifact is gone.
        """
        steps = self._registry.find(artifact_id)
        if steps is not None:
            steps.publication.remove(observer)

    def link(
        self, from_id: ArtifactId, port: str | None, to_id: ArtifactId, on_done: Told = ignore_outcome
    ) -> None:
        """Put an artifact behind an out port of another one, beside those that are there; None: its first port.

        Raises:
            UnknownArtifact: one of them is gone.
            OperationFailed: *from_id* has no such port; reason ``unknown_port(Port)``.
        """
        ports = self._steps_of(from_id).ports
        self._steps_of(to_id)
        if port is None and ports:
            port = ports[0]
        if port is None or port not in ports:
            offer = f"; its ports are {', '.join(ports)}" if ports else "; it has none"
            wanted = "any" if port is None else str.__str__(port)
            message = f"artifact {from_id.name} ({from_id.type_name}) has no out port {wanted}{offer}"
            raise OperationFailed(message, Structure("unknown_port", (wanted,)))
        self._registry.link(from_id, port, to_id)
        on_done(SUCCEEDED)

    def linked(self, from_id: ArtifactId, port: str) -> tuple[ArtifactId, ...]:
        """The artifacts behind an out port, in the order of linking."""
        return self._registry.linked(from_id, port)

    def _steps_of(self, artifact_id: ArtifactId) -> Steps:
        steps = self._registry.find(artifact_id)
        if steps is None:
            gone = faults.not_available(artifact_id)
            raise UnknownArtifact(gone.message or "", gone.reason)
        return steps

    def _changed(self, artifact_id: ArtifactId, present: bool) -> None:
        for (operation, arity), index in self._indexes.items():
            if present:
                self._offer_of(artifact_id, operation, arity, index)
            else:
                index.remove(artifact_id)
        self._offers.pop(artifact_id, None)
        if self._setting.listener is not None:
            self._setting.listener.artifact(artifact_id, present)
        self._tell((*self._watchers.values(), *self._watchers_of_all.values()), artifact_id, present)

    def _tell(self, watchers: tuple[Watcher, ...], artifact_id: ArtifactId, present: bool) -> None:
        # A watcher may end the artifact that has just come: the others hear of its coming first.
        self._tell_rest()
        self._telling = iter(watchers), artifact_id, present
        self._tell_rest()

    def _tell_rest(self) -> None:
        if self._telling is None:
            return
        untold, artifact_id, present = self._telling
        for watcher in untold:
            try:
                watcher(artifact_id, present)
            except Exception as error:
                self._setting.report(error)
        self._telling = None
