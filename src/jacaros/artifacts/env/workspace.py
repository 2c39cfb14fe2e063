"""Workspaces: create, find, focus, link, use and dispose artifacts."""

from collections.abc import Callable, Collection, Iterator, Sequence
from functools import partial

from jacaros.artifacts.env import ports
from jacaros.artifacts.env.artifact import Artifact
from jacaros.artifacts.env.creation import (
    FindType,
    OperationIndex,
    artifact_type_of,
    attach,
    init_failed,
    init_of,
    refused,
)
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, UnknownArtifact
from jacaros.artifacts.env.execution import OperationExecution
from jacaros.artifacts.env.operation import (
    LINK,
    OPERATION,
    SUCCEEDED,
    OperationOutcome,
    OperationRequest,
    ignore_outcome,
    marks_of,
)
from jacaros.artifacts.env.ports import ENDED, OnMade, OnOutcome, UnderWay, ignore_made
from jacaros.artifacts.env.property import ObservableProperty, Observer
from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.kernel import faults
from jacaros.artifacts.kernel.declaration import Interface
from jacaros.artifacts.kernel.publication import Setting
from jacaros.artifacts.kernel.registry import Registry
from jacaros.artifacts.kernel.steps import Steps
from jacaros.files.texts import aside
from jacaros.runtime.trace import Cause

Watcher = Callable[[ArtifactId, bool], None]
"""Called with an artifact that is added (True) or removed (False)."""


class Workspace(ports.Workspace):
    """A named place for artifacts, created by `Environment.create_workspace`.

    Ids are valid in the whole environment: methods that take an id accept artifacts of other workspaces, too.

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
        self._watchers: dict[object, Watcher] = {}
        self._watchers_of_all: dict[object, Watcher] = {}
        self._telling: tuple[Iterator[Watcher], ArtifactId, bool] | None = None

    # ---- artifacts come and go

    def offer(
        self, name: str, artifact_type: type[Artifact], args: Sequence[object] = (), personal: bool = False
    ) -> ArtifactId:
        """Add an artifact of JaCaROS itself. It is created at its first use or focus.

        Args:
            name: unique in the workspace.
            artifact_type: its ``init`` is a plain ``def``.
            args: arguments of ``init``.
            personal: it belongs to one agent: it can be looked up by name, but serves only actions that name it.
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
        # Add it first: its ``init`` may look up artifacts.
        self._registry.add(steps, self._forget)
        request = OperationRequest(artifact_id, "init", args)
        steps.initialise(init_of(artifact_type, request), request)
        steps.initialised = True
        return steps

    def take_back(self, artifact_id: ArtifactId) -> None:
        """Dispose an artifact that was added with `offer`, if it still exists."""
        name = artifact_id.name
        if artifact_id in (self._artifacts.get(name), self._personal.get(name)):
            self.dispose_artifact(artifact_id)

    def create(
        self,
        name: str,
        type_name: str | type[Artifact],
        args: Sequence[object] = (),
        creator: str | None = None,
        on_done: OnMade = ignore_made,
        cause: Cause | None = None,
    ) -> UnderWay:
        """Create an artifact like `make_artifact`, and report to *on_done*.

        An ``init`` that is a plain ``def`` has ended when this returns. Cancelling the returned execution abandons the
        creation, and nothing remains of the artifact.
        """
        name = str.__str__(name)
        request = OperationRequest(
            self._new_id(name, type_name, creator), "init", tuple(args), creator, cause
        )
        try:
            artifact_type, steps = self._prepare(request.artifact, type_name)
            declared = init_of(artifact_type, request)
        except OperationFailed as failure:
            on_done(None, OperationOutcome.of(failure))
            return ENDED
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
                "artifact_already_present", name, f"artifact `{name}` already exists in workspace {self.path}"
            )
        artifact_type = artifact_type_of(type_name, self._find_type, self._setting)
        return artifact_type, attach(artifact_type, artifact_id, self, self._setting)

    def _made(self, steps: Steps, on_done: OnMade, outcome: OperationOutcome) -> None:
        name = steps.id.name
        if self._making.get(name) is steps:
            del self._making[name]
        if not outcome.ok or steps.disposed:
            self._registry.dispose(steps)
            failure = init_failed(steps.id, outcome.message or "its init disposed it")
            on_done(None, OperationOutcome.of(failure))
            return
        steps.initialised = True
        self._artifacts[name] = steps.id
        self._changed(steps.id, True)
        on_done(steps.id, SUCCEEDED)

    def dispose_artifact(self, artifact_id: ArtifactId, on_done: OnOutcome = ignore_outcome) -> None:
        """Dispose an artifact: its observers lose its properties, and its operations fail.

        `Artifact.dispose` runs when the last operation has ended, possibly after this returns.

        Raises:
            UnknownArtifact: it is gone.
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
        """Dispose all artifacts, the newest first, and wait until they have released everything."""
        for steps in tuple(self._making.values()):
            self._registry.dispose(steps)
        for artifact_id in reversed((*self.artifacts(), *self.personal_artifacts())):
            self.dispose_artifact(artifact_id)
        await self._registry.ended()

    # ---- artifacts are found

    def artifacts(self) -> tuple[ArtifactId, ...]:
        """Return all artifacts, the oldest first. The standard artifacts come first."""
        return tuple(self._artifacts.values())

    def personal_artifacts(self) -> tuple[ArtifactId, ...]:
        """Return the artifacts that represent agents in this workspace."""
        return tuple(self._personal.values())

    def lookup(self, name: str) -> ArtifactId:
        """Return the artifact with this name.

        Raises:
            UnknownArtifact: it does not exist, or its ``init`` has not ended.
        """
        found = self._artifacts.get(name) or self._personal.get(name)
        if found is None:
            help = aside(name, self._artifacts)
            message = f"unknown artifact `{name}` in workspace {self.path}{help}"
            raise UnknownArtifact(message, Structure("artifact_not_available", (str.__str__(name),)))
        return found

    def watch(self, watcher: Watcher, personal: bool = False) -> Callable[[], None]:
        """Call *watcher* with every artifact that is added (True) or removed (False). Return a function that ends this.

        Args:
            watcher: called immediately, in the same turn of the event loop.
            personal: include `personal_artifacts`.
        """
        watchers = self._watchers_of_all if personal else self._watchers
        watch = object()
        watchers[watch] = watcher
        return lambda: watchers.pop(watch, None) and None

    def providers(self, operation: str, arity: int) -> tuple[ArtifactId, ...]:
        """Return the artifacts that offer *operation* with *arity* arguments to agents, the oldest first."""
        index = self._indexes.get((operation, arity))
        if index is None:
            index = self._indexes[operation, arity] = OperationIndex()
            for artifact_id in self._artifacts.values():
                self._offer_of(artifact_id, operation, arity, index)
        return index.providers()

    def _offer_of(self, artifact_id: ArtifactId, operation: str, arity: int, index: OperationIndex) -> None:
        """Add an artifact to the index of an operation, if it offers it."""
        declared = self.interface(artifact_id).operations.find(operation, arity)
        if declared is not None:
            index.add(artifact_id, not declared.common and declared.signature.rest is None)

    def offers(self, artifact_id: ArtifactId) -> Collection[str]:
        """Return the operations of an artifact for agents, such as ``inc/1`` and ``sum/any``.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self.interface(artifact_id).operations.keys()

    def artifact_type(self, type_name: str) -> type[Artifact]:
        """Return the class that `make_artifact` would use.

        Raises:
            OperationFailed: the type is unknown.
        """
        return artifact_type_of(type_name, self._find_type, self._setting)

    def operations_changed(self, artifact_id: ArtifactId) -> None:
        """Update the indexes after an artifact has changed its operations."""
        if self._artifacts.get(artifact_id.name) is artifact_id:
            self._indexes.clear()

    def interface(self, artifact_id: ArtifactId) -> Interface:
        """Return the operations of an artifact.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._registry.interface(artifact_id) or self._steps_of(artifact_id).interface

    def has_method(self, artifact_id: ArtifactId, name: str) -> bool:
        """Return whether the class of an artifact has a public user-defined method of this name that is not an operation.

        Raises:
            UnknownArtifact: it is gone.
        """
        method = vars(type(self._steps_of(artifact_id).artifact)).get(name)
        if name.startswith("_") or not callable(method):
            return False
        # `Artifact.remove_operation` has removed a method that is marked but not offered.
        return all(mark.kind != OPERATION or mark.name not in (None, name) for mark in marks_of(method))

    def properties(self, artifact_id: ArtifactId) -> tuple[ObservableProperty, ...]:
        """Return the observable properties of an artifact, as observers know them.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._steps_of(artifact_id).publication.committed()

    def observers(self, artifact_id: ArtifactId) -> tuple[Observer, ...]:
        """Return the observers that focus an artifact, in the order of focusing.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._steps_of(artifact_id).publication.observers

    def pending(self, artifact_id: ArtifactId) -> tuple[OperationExecution, ...]:
        """Return the operations of an artifact that run (including internal ones) or wait to begin.

        Raises:
            UnknownArtifact: it is gone.
        """
        return self._steps_of(artifact_id).pending()

    # ---- artifacts are used

    def execute(self, request: OperationRequest) -> UnderWay:
        """Run an operation for an agent.

        A plain ``def`` of a free artifact has ended when this returns: its changes are committed, observers have
        received them, and ``request.on_done`` has been called.
        """
        steps = self._registry.find(request.artifact)
        if steps is None:
            return self._gone(request)
        return steps.execute(request, OPERATION)

    def execute_linked(self, request: OperationRequest) -> UnderWay:
        """Run a linked operation for another artifact. See `Artifact.call_linked`."""
        steps = self._registry.find(request.artifact)
        if steps is None:
            return self._gone(request)
        return steps.execute(request, LINK)

    def _gone(self, request: OperationRequest) -> UnderWay:
        request.on_done(faults.not_available(request.artifact))
        return ENDED

    def focus(self, artifact_id: ArtifactId, observer: Observer, on_done: OnOutcome = ignore_outcome) -> None:
        """Let *observer* receive what an artifact publishes, beginning with all its properties.

        Focusing again has no effect.

        Raises:
            UnknownArtifact: it is gone.
        """
        self._steps_of(artifact_id).publication.add(observer)
        on_done(SUCCEEDED)

    def stop_focus(self, artifact_id: ArtifactId, observer: Observer) -> None:
        """Stop sending observations to *observer*. The last one removes all properties.

        Without effect if it does not focus the artifact, or the artifact is gone.
        """
        steps = self._registry.find(artifact_id)
        if steps is not None:
            steps.publication.remove(observer)

    def link(
        self, from_id: ArtifactId, port: str | None, to_id: ArtifactId, on_done: OnOutcome = ignore_outcome
    ) -> None:
        """Link an out port of an artifact to another artifact, in addition to present links. None means its first port.

        Raises:
            UnknownArtifact: one of them is gone.
            OperationFailed: *from_id* has no such port; reason ``unknown_port(Port)``.
        """
        ports = self._steps_of(from_id).ports
        self._steps_of(to_id)
        if port is None and ports:
            port = ports[0]
        if port is None or port not in ports:
            known = f"; its ports are {', '.join(ports)}" if ports else "; it has none"
            wanted = "any" if port is None else str.__str__(port)
            message = f"unknown out port `{wanted}` of artifact {from_id.name} ({from_id.type_name}){known}"
            raise OperationFailed(message, Structure("unknown_port", (wanted,)))
        self._registry.link(from_id, port, to_id)
        on_done(SUCCEEDED)

    def linked(self, from_id: ArtifactId, port: str) -> tuple[ArtifactId, ...]:
        """Return the artifacts that are linked to an out port, in the order of linking."""
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
        if self._setting.listener is not None:
            self._setting.listener.artifact(artifact_id, present)
        self._tell((*self._watchers.values(), *self._watchers_of_all.values()), artifact_id, present)

    def _tell(self, watchers: tuple[Watcher, ...], artifact_id: ArtifactId, present: bool) -> None:
        # A watcher may dispose the new artifact: notify the others of its creation first.
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
