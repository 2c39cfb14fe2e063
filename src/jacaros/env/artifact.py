"""Artifacts: what authors of environments write."""

from collections.abc import Awaitable, Callable, Mapping, Sequence
from typing import Any, ClassVar, NoReturn, Protocol, TypeVar, overload

from jacaros.clock import Clock
from jacaros.env.errors import InvalidArtifact, OperationFailed
from jacaros.env.execution import OperationExecution
from jacaros.env.ids import ArtifactId
from jacaros.env.kernel.declaration import declare_function
from jacaros.env.kernel.external import ExternalSession
from jacaros.env.kernel.faults import text_of
from jacaros.env.kernel.interface import Interface, interface_of
from jacaros.env.kernel.linked_call import call_all
from jacaros.env.kernel.steps import Steps
from jacaros.env.kernel.unawaited import step_boundary, watch_operations
from jacaros.env.operation import (
    OPERATION,
    Mark,
    OperationRequest,
    common_operation,
    initializer,
    internal_operation,
    link,
    marks_of,
    operation,
)
from jacaros.env.property import ObservableProperty, PropertySnapshot, plain_annotations
from jacaros.env.values import Atom, Out, Structure, plain
from jacaros.trace import Cause

__all__ = ["Artifact", "Host", "Out", "initializer", "internal_operation", "link", "operation"]

T = TypeVar("T")


class Host(Protocol):
    """The workspace of an artifact, as far as the artifact may use it."""

    @property
    def path(self) -> str:
        """Full path, such as ``/main``."""

    @property
    def name(self) -> str:
        """Last part of the path."""

    async def make_artifact(
        self,
        name: str,
        type_name: "str | type[Artifact]",
        args: Sequence[object] = (),
        creator: str | None = None,
    ) -> ArtifactId:
        """Make an artifact."""

    def lookup(self, name: str) -> ArtifactId:
        """Find an artifact by its name."""

    def dispose_artifact(self, artifact_id: ArtifactId) -> None:
        """Dispose an artifact."""

    def link(self, from_id: ArtifactId, port: str | None, to_id: ArtifactId) -> None:
        """Link the out port of an artifact to another artifact; None for its first port."""

    def linked(self, from_id: ArtifactId, port: str) -> tuple[ArtifactId, ...]:
        """The artifacts behind an out port."""

    def execute_linked(self, request: OperationRequest) -> OperationExecution:
        """Run a linked operation."""

    def operations_changed(self, artifact_id: ArtifactId) -> None:
        """Be told that an artifact has other operations from now on."""


class Artifact:
    """One thing of the environment: observable properties, signals and operations.

    Authors derive from it and mark methods with `operation`, `internal_operation` and `link`.  A class has
    no constructor; a method ``init`` (``def`` or ``async def``) prepares the artifact and has the
    parameters given to ``makeArtifact`` (without arguments, an ``init`` that wants some does not run).
    All that changes properties or sends signals happens within operations, ``init`` included; a callback
    from elsewhere uses `start`.

    Attributes:
        ports: names of the out ports, through which it calls linked operations of other artifacts.
        name: name of the artifact in its workspace.
        id: identity of the artifact.
        workspace: where it lives.
        clock: where it takes time from.
        resources: what the host lends to artifacts, by name.
    """

    ports: ClassVar[tuple[str, ...]] = ()
    name: str
    id: ArtifactId
    workspace: Host
    clock: Clock
    resources: Mapping[str, object]
    interface: ClassVar[Interface]
    _steps: Steps

    def __init_subclass__(cls, **keywords: object) -> None:
        super().__init_subclass__(**keywords)
        for attribute in vars(cls):
            if attribute in _RESERVED:
                raise InvalidArtifact(
                    f"{cls.__qualname__}.{attribute} would replace a part of Artifact; call it otherwise, "
                    f'such as @operation(name="{attribute}") def {attribute}_it(self)'
                )
        if isinstance(cls.ports, str) or not all(isinstance(port, str) for port in cls.ports):
            raise InvalidArtifact(
                f'{cls.__qualname__}.ports is {cls.ports!r}: write a tuple of names, such as ports = ("out",)'
            )
        cls.interface = interface_of(cls)
        watch_operations(cls)

    def __setattr__(self, name: str, value: object) -> None:
        if name in _RESERVED:
            raise InvalidArtifact(
                f"self.{name} = ... would replace a part of Artifact: call the attribute otherwise, such as self.its_{name}"
            )
        object.__setattr__(self, name, value)

    def _join(self, steps: Steps, host: Host) -> None:
        """Be joined with the kernel; called once, before ``init``."""
        self.__dict__.update(
            name=steps.id.name,
            id=steps.id,
            workspace=host,
            clock=steps.setting.clock,
            resources=steps.setting.resources,
            _steps=steps,
        )
        steps.ending.hook = self.dispose

    def dispose(self) -> None:
        """Give back what the artifact holds; called when all its operations have ended.

        Not called when ``init`` failed: see `on_dispose`.
        """

    def on_dispose(self, callback: Callable[[], object]) -> None:
        """Call *callback* when the artifact ends, also when its ``init`` fails; the last one first."""
        self._steps.ending.cleanups.append(callback)

    # ---- observable properties

    def define_property(
        self, name: str, *values: object, annotations: tuple[object, ...] | None = None
    ) -> None:
        """Add an observable property; a focusing agent believes ``name(values)``.

        Several properties may have one name.

        Args:
            name: begins with a lower-case letter.
            values: made plain values (see `plain`).
            annotations: further annotations of the belief, atoms and structures.
        """
        self._steps.current("defining property", name)
        self._steps.publication.properties.define(name, values, annotations)

    def update_property(
        self,
        name: str,
        *values: object,
        annotations: tuple[object, ...] | None = None,
        if_new: bool = False,
        where: tuple[object, ...] = (),
    ) -> None:
        """Give the first (oldest) property called *name* new values; equal values are a change too, as in CArtAgO.

        Args:
            name: name of the property.
            values: all its values.
            annotations: None keeps those it has.
            if_new: do nothing when it has these values (and annotations) already: observers hear nothing then.
            where: values that the property has now, None for any value: the first that has them is updated.

        Raises:
            UnknownProperty: there is none.
        """
        steps = self._steps
        holder = steps.turns.holder
        if holder is None or holder.task is not None or steps.turns.asking:
            steps.current("updating property", name)
        steps.publication.properties.update(name, values, annotations, if_new, where)

    def update_value(self, name: str, index: int, value: object, where: tuple[object, ...] = ()) -> None:
        """Give the first property called *name* another value at *index* (from 0); the others stay.

        Args:
            name: name of the property.
            index: which of its values.
            value: the new one.
            where: as for `update_property`.

        Raises:
            UnknownProperty: there is none.
            IndexError: it has fewer values.
        """
        self._steps.current("updating property", name)
        store = self._steps.publication.properties
        values = list(store.first(name, where).values)
        if not -len(values) <= index < len(values):
            has = f"{len(values)} value{'' if len(values) == 1 else 's'}"
            raise IndexError(f"property {name} has {has}, and none at index {index}: the first is at 0")
        values[index] = value
        store.update(name, tuple(values), None, False, where)

    def annotate_property(self, name: str, *annotations: object, where: tuple[object, ...] = ()) -> None:
        """Add annotations to the first property called *name*; its values and the annotations that it has stay.

        Args:
            name: name of the property.
            annotations: atoms and structures; those that it has already are not added again.
            where: as for `update_property`.

        Raises:
            UnknownProperty: there is none.
        """
        self._steps.current("annotating property", name)
        store = self._steps.publication.properties
        found = store.first(name, where)
        kept = found.annotations
        new = tuple(each for each in plain_annotations(annotations) if each not in kept)
        store.update(name, found.values, (*kept, *new), False, where)

    def remove_property(self, name: str, *values: object) -> None:
        """Remove the first property called *name*, with *values* the first that has these values.

        Args:
            name: name of the property.
            values: as many as the property has, None for any value.

        Raises:
            UnknownProperty: there is none.
        """
        self._steps.current("removing property", name)
        self._steps.publication.properties.remove(name, values)

    def has_property(self, name: str, *values: object) -> bool:
        """True when there is a property called *name*, with *values* one that has these values."""
        return self._steps.publication.properties.has(name, values)

    @overload
    def value(self, name: str, index: int = 0) -> Any: ...

    @overload
    def value(self, name: str, index: int = 0, *, kind: type[T]) -> T: ...

    def value(self, name: str, index: int = 0, *, kind: type | None = None) -> Any:
        """A value of the first property called *name*; of a list or dictionary a copy.

        Args:
            name: name of the property.
            index: which of its values.
            kind: the class that it has, for type checkers as well: ``self.value("free", kind=int) > 0`` is a `bool`.

        Raises:
            UnknownProperty: there is none.
            IndexError: it has fewer values.
            TypeError: the value is not of that class.
        """
        value = plain(self._steps.publication.properties.first(name).values[index])
        if kind is not None and not isinstance(value, kind):
            raise TypeError(
                f"property {name} has {value!r} at index {index}, which is no {kind.__qualname__}"
            )
        return value

    def values(self, name: str) -> tuple[Any, ...]:
        """All values of the first property called *name*.

        Raises:
            UnknownProperty: there is none.
        """
        return tuple(map(plain, self._steps.publication.properties.first(name).values))

    def find_properties(self, name: str, *values: object) -> tuple[ObservableProperty, ...]:
        """The properties called *name*, with *values* those that have these values (None for any); oldest first."""
        return self._steps.publication.properties.all(name, values)

    @common_operation("observeProperty")
    def observe_property(self, name: str, snapshot: Out) -> None:
        """Give a property as it is now, as an object, to an agent that does not focus the artifact.

        Fails with ``unknown_property(Name)``.
        """
        found = self.find_properties(name)
        if not found:
            self.fail(f"Property not found {name}", "unknown_property", str(name))
        snapshot.set(PropertySnapshot(found[0]))

    def has_untaken(self, name: str) -> bool:
        """Whether an observer has still to take up what it was told about properties called *name*.

        A sensor that changes faster than its observers think asks this first; see `jacaros.artifacts.kit.reading`.
        """
        return self._steps.publication.has_untaken(name)

    # ---- signals, failure, log

    def signal(self, name: str, *arguments: object) -> None:
        """Signal to all observers that something happened; changes made so far in the step go with it."""
        self._steps.signal(name, arguments, None)

    def signal_to(self, agent: str | None, name: str, *arguments: object) -> None:
        """Signal to one observer; changes made so far in the step go to all.

        Raises:
            InvalidArtifact: *agent* is None, as `caller` is in an internal operation.
        """
        if agent is None:
            raise InvalidArtifact(
                f"signal_to: no agent is given for {name}; self.caller is None in internal operations, so hand the "
                "agent on: self.start(self.go, self.caller)"
            )
        self._steps.signal(name, arguments, agent)

    def fail(self, message: str, functor: str | None = None, *arguments: object) -> NoReturn:
        """End the operation as failed; its step is undone.

        Args:
            message: text for people.
            functor: functor of the reason term, None for no reason.
            arguments: arguments of the reason term; without any it is an atom.

        Raises:
            OperationFailed: always.
        """
        message = message if isinstance(message, str) else text_of(message)
        if functor is None:
            raise OperationFailed(message)
        if not isinstance(functor, str) or not functor:
            raise InvalidArtifact(
                f"fail({message!r}, {functor!r}): the reason begins with a name, such as too_many"
            )
        raise OperationFailed(
            message, Structure(functor, tuple(map(plain, arguments))) if arguments else Atom(functor)
        )

    def log(self, text: str) -> None:
        """Write a line for people."""
        self._steps.setting.log(f"[{self.name}] {text}")

    # ---- the operation in progress

    @property
    def current(self) -> OperationExecution:
        """The operation in progress: its request, its pauses.

        Raises:
            InvalidArtifact: there is none.
        """
        return self._steps.current("asking for the current operation", changes=False)

    @property
    def caller(self) -> Atom | None:
        """The agent on whose behalf the operation in progress runs, an atom as agents know their names.

        Through links it is the agent at the beginning of the chain, in ``init`` the creator, in internal
        operations None.
        """
        holder = self._steps.turns.holder
        if holder is None or holder.request.agent is None or not self._steps.inside():
            return None
        return Atom(holder.request.agent)

    def commit(self) -> None:
        """Publish what the step has changed so far; from here on it cannot be undone."""
        holder = self._steps.current("a commit")
        if holder.declared is None or not holder.declared.threaded:
            self._steps.commit()

    @step_boundary
    async def sleep(self, delay: float) -> None:
        """Wait for *delay* seconds; a step boundary, others may use the artifact meanwhile."""
        await self._steps.leave(self.clock.sleep(delay), "sleeping")

    @step_boundary
    async def until(self, guard: Callable[[], bool]) -> None:
        """Wait until *guard* is true; a step boundary, *guard* is evaluated whenever a step has ended."""
        await self._steps.until(guard)

    @step_boundary
    async def step(self, awaitable: Awaitable[T]) -> T:
        """Wait for anything else, such as a service call; a step boundary.

        Awaiting without `step` keeps the artifact for oneself.
        """
        return await self._steps.leave(awaitable, "waiting for something")

    @step_boundary
    async def pause_point(self, on_pause: Callable[[], None] | None = None) -> float:
        """Wait here while the operation is paused; a step boundary only if it is.

        Args:
            on_pause: called before the waiting, within the operation.  To stop at the very moment of the
                pause, register a callback with ``self.current.on_pause`` too.

        Returns:
            Seconds that the operation has been paused since the last pause point, 0.0 mostly.
        """
        return await self._steps.pause_point(on_pause)

    # ---- further operations

    def start(
        self, operation: str | Callable[..., object], *arguments: object, cause: Cause | None = None
    ) -> None:
        """Run an internal operation as a process of its own; its failure is logged and harms nobody.

        Within an operation it begins when the step has ended well; from a callback at once if the artifact
        is free.  This is the way to change properties from a callback.

        Args:
            operation: a method marked `internal_operation` (or `operation`), or its name.
            arguments: given as they are.
            cause: what led to it, such as the sample of a sensor; None for that of the operation in progress.

        Raises:
            InvalidArtifact: there is no such operation.
        """
        declared = self._steps.interface.own(operation, len(arguments))
        if declared is None:
            raise InvalidArtifact(self._cannot_start(operation, len(arguments)))
        self._steps.start(declared, OperationRequest(self.id, declared.name, arguments, None, cause))

    def _cannot_start(self, operation: str | Callable[..., object], count: int) -> str:
        wanted = operation if isinstance(operation, str) else str(getattr(operation, "__name__", operation))
        method = getattr(type(self), wanted, None)
        if method is not None and not marks_of(method):
            return f"{wanted} is no operation of artifact {self.name}: put @internal_operation above def {wanted}"
        return f"artifact {self.name} has no internal operation {wanted} with {count} arguments"

    @step_boundary
    async def call_linked(self, port: str | ArtifactId | None, operation: str, *arguments: object) -> None:
        """Call a linked operation of all artifacts behind *port*, and wait for all; a step boundary.

        Args:
            port: one of `ports`, None for the first of them; or one artifact, which need not be linked.
            operation: name of the linked operation.
            arguments: inputs, and `Out` objects for its outputs.

        Raises:
            OperationFailed: the class has no such port, nothing is linked to it, or a linked operation failed (with
                its reason).
        """
        targets = (port,) if isinstance(port, ArtifactId) else self._behind(port)
        call = call_all(self.workspace.execute_linked, targets, operation, arguments, self.current)
        await self._steps.leave(call, f"calling {operation}")

    def _behind(self, port: str | None) -> tuple[ArtifactId, ...]:
        if not self.ports or (port is not None and port not in self.ports):
            offered = f"its ports are {', '.join(self.ports)}" if self.ports else "it has none"
            self._fail_call(f"{type(self).__qualname__} has no out port {port!r}; {offered}")
        port = port if port is not None else self.ports[0]
        targets = self.workspace.linked(self.id, port)
        if not targets:
            self._fail_call(f"nothing is linked to port {port} of artifact {self.name}")
        return targets

    def _fail_call(self, message: str) -> NoReturn:
        # The reason of CArtAgO, in which every call that comes to nothing is an error of the operation.
        request = self.current.request
        self.fail(message, "operation_error", f"{request.operation}/{len(request.arguments)}")

    def external_session(self, cause: Cause | None = None) -> ExternalSession:
        """Have the artifact for oneself from elsewhere: ``with`` in another thread, ``async with`` in another task.

        It waits for its turn, as an operation does.  At its end the changes are published together; if it ends with
        an exception they are undone.  A callback of the loop, which cannot wait, uses `start`.

        Args:
            cause: what led to it, such as the sample of a sensor.

        Raises:
            InvalidArtifact: (on entering) ``with`` was used in the thread of the loop, or within an operation.
            OperationFailed: (on entering) the artifact is disposed; reason ``artifact_not_available(Name)`` or
                ``artifact_disposed(Name)``.
        """
        return ExternalSession(self._steps, cause)

    def define_operation(
        self,
        name: str,
        function: Callable[..., object],
        *,
        guard: Callable[..., object] | None = None,
        pausable: bool = False,
        threaded: bool = False,
    ) -> None:
        """Add an operation to this one artifact, such as one read from a file.

        Args:
            name: what agents call it.
            function: gets the arguments (not the artifact); its signature counts as that of a method.
            guard: gets the same, or nothing; the operation waits until it is true.
            pausable: see `operation`.
            threaded: see `operation`.
        """
        mark = Mark(OPERATION, name, None, pausable, threaded)
        self._own_interface().operations.add(declare_function(mark, name, function, guard))

    def remove_operation(self, name: str) -> None:
        """Take away all operations called *name* from this one artifact."""
        self._own_interface().operations.remove(name)

    def _own_interface(self) -> Interface:
        if self._steps.interface is type(self).interface:
            self._steps.interface = self._steps.interface.copy()
        self.workspace.operations_changed(self.id)
        return self._steps.interface


_RESERVED = frozenset(
    name
    for name in (*vars(Artifact), "interface", "name", "id", "workspace", "clock", "resources", "_steps")
    if not name.startswith("__") and name not in ("ports", "dispose")
)

Artifact.interface = interface_of(Artifact)
