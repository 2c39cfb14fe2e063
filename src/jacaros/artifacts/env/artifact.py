"""Artifacts: the class that authors of environments derive from."""

from collections.abc import Awaitable, Callable, Mapping
from typing import Any, ClassVar, NoReturn, Protocol, TypeVar, overload

from jacaros.artifacts.env.errors import ArtifactId, InvalidArtifact, OperationFailed
from jacaros.artifacts.env.execution import OperationExecution, call_all
from jacaros.artifacts.env.operation import (
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
from jacaros.artifacts.env.ports import UnderWay, Workspace
from jacaros.artifacts.env.property import ObservableProperty, plain_annotations
from jacaros.artifacts.env.values import Atom, Out, Structure, plain
from jacaros.artifacts.kernel.declaration import UsageInterface, declare_function, interface_of
from jacaros.artifacts.kernel.faults import text_of
from jacaros.artifacts.kernel.publication import Publication
from jacaros.artifacts.kernel.steps import Steps
from jacaros.runtime.clock import Clock
from jacaros.runtime.trace import Cause

__all__ = ["Artifact", "ArtifactHost", "Out", "initializer", "internal_operation", "link", "operation"]

T = TypeVar("T")


class ArtifactHost(Workspace, Protocol):
    """The workspace of an artifact, as far as the artifact may use it."""

    def linked(self, from_id: ArtifactId, port: str) -> tuple[ArtifactId, ...]:
        """Return the artifacts that are linked to an out port."""

    def execute_linked(self, request: OperationRequest) -> UnderWay:
        """Run a linked operation."""

    def of_same_robot(self, artifact_id: ArtifactId) -> list[Publication]:
        """Return the artifacts of the same robot in this workspace, *artifact_id* first, as observers see them."""

    def operations_changed(self, artifact_id: ArtifactId) -> None:
        """Update the operations that an artifact offers."""


class Artifact:
    """An object of the environment with observable properties, signals and operations.

    Derive a class from it, and mark methods with `operation`, `internal_operation` and `link`. The class has no
    constructor: a method ``init`` (``def`` or ``async def``) initialises the artifact with the arguments of
    ``makeArtifact``. Without arguments, an ``init`` that requires some is not called.

    Properties change, and signals are sent, only within operations, including ``init``. From a callback, call `start`.

    Attributes:
        ports: names of the out ports, through which it calls linked operations of other artifacts.
        name: name of the artifact in its workspace.
        id: identity of the artifact.
        workspace: the workspace that it is in.
        clock: the clock of the run.
        resources: services of the host for artifacts, by name.
    """

    ports: ClassVar[tuple[str, ...]] = ()
    name: str
    id: ArtifactId
    workspace: ArtifactHost
    clock: Clock
    resources: Mapping[str, object]
    interface: ClassVar[UsageInterface]
    _steps: Steps

    def __init_subclass__(cls, **keywords: object) -> None:
        super().__init_subclass__(**keywords)
        for attribute in vars(cls):
            if attribute in _RESERVED:
                raise InvalidArtifact(
                    f"{cls.__qualname__}.{attribute} would replace a part of Artifact; choose another name, "
                    f'such as @operation(name="{attribute}") def {attribute}_it(self)'
                )
        if isinstance(cls.ports, str) or not all(isinstance(port, str) for port in cls.ports):
            raise InvalidArtifact(
                f'expected a tuple of names as {cls.__qualname__}.ports, found {cls.ports!r}; write ports = ("out",)'
            )
        cls.interface = interface_of(cls)

    def __setattr__(self, name: str, value: object) -> None:
        if name in _RESERVED:
            raise InvalidArtifact(
                f"self.{name} = ... would replace a part of Artifact; choose another name, such as self.its_{name}"
            )
        object.__setattr__(self, name, value)

    def _join(self, steps: Steps, host: ArtifactHost) -> None:
        """Connect the artifact with the kernel. Called once, before ``init``."""
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
        """Release what the artifact holds. Called when all its operations have ended.

        Not called if ``init`` failed: see `on_dispose`.
        """

    def on_dispose(self, callback: Callable[[], object]) -> None:
        """Call *callback* when the artifact ends, also if its ``init`` fails. The last callback runs first."""
        self._steps.ending.cleanups.append(callback)

    # ---- observable properties

    def define_property(
        self, name: str, *values: object, annotations: tuple[object, ...] | None = None
    ) -> None:
        """Add an observable property. Agents that focus the artifact believe ``name(values)``.

        Several properties may have the same name.

        Args:
            name: begins with a lower-case letter.
            values: converted to plain values (see `plain`).
            annotations: further annotations of the belief: atoms and structures.

        Raises:
            InvalidArtifact: the name is invalid, or the caller is not within an operation.
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
        """Update the first (oldest) property called *name*. Equal values count as a change, too, as in CArtAgO.

        Args:
            name: name of the property.
            values: all its new values.
            annotations: new annotations. None keeps the current ones.
            if_new: do nothing if values and annotations are unchanged. Observers then receive nothing.
            where: current values of the property, None for any value. The first property that matches is updated.

        Raises:
            UnknownProperty: no property matches.
        """
        steps = self._steps
        holder = steps.turns.holder
        if holder is None or holder.task is not None or steps.turns.asking:
            steps.current("updating property", name)
        steps.publication.properties.update(name, values, annotations, if_new, where)

    def update_value(self, name: str, index: int, value: object, where: tuple[object, ...] = ()) -> None:
        """Update one value of the first property called *name*. The other values do not change.

        Args:
            name: name of the property.
            index: index of the value, from 0.
            value: the new value.
            where: as for `update_property`.

        Raises:
            UnknownProperty: no property matches.
            IndexError: it has fewer values.
        """
        self._steps.current("updating property", name)
        store = self._steps.publication.properties
        values = list(store.first(name, where).values)
        if not -len(values) <= index < len(values):
            has = f"{len(values)} value{'' if len(values) == 1 else 's'}"
            raise IndexError(
                f"property {name} has {has}, so index {index} is out of range (the first index is 0)"
            )
        values[index] = value
        store.update(name, tuple(values), None, False, where)

    def annotate_property(self, name: str, *annotations: object, where: tuple[object, ...] = ()) -> None:
        """Add annotations to the first property called *name*. It keeps its values and its other annotations.

        Args:
            name: name of the property.
            annotations: atoms and structures. Present ones are not added again.
            where: as for `update_property`.

        Raises:
            UnknownProperty: no property matches.
        """
        self._steps.current("annotating property", name)
        store = self._steps.publication.properties
        found = store.first(name, where)
        kept = found.annotations
        new = tuple(each for each in plain_annotations(annotations) if each not in kept)
        store.update(name, found.values, (*kept, *new), False, where)

    def remove_property(self, name: str, *values: object) -> None:
        """Remove the first property called *name*; with *values*, the first one that has these values.

        Args:
            name: name of the property.
            values: as many as the property has, None for any value.

        Raises:
            UnknownProperty: no property matches.
        """
        self._steps.current("removing property", name)
        self._steps.publication.properties.remove(name, values)

    def has_property(self, name: str, *values: object) -> bool:
        """Return whether a property called *name* exists; with *values*, whether one has these values."""
        return self._steps.publication.properties.has(name, values)

    @overload
    def value(self, name: str, index: int = 0) -> Any: ...

    @overload
    def value(self, name: str, index: int = 0, *, kind: type[T]) -> T: ...

    def value(self, name: str, index: int = 0, *, kind: type | None = None) -> Any:
        """Return a value of the first property called *name*. Lists and dictionaries are copied.

        Args:
            name: name of the property.
            index: index of the value, from 0.
            kind: expected class, also for type checkers: ``self.value("free", kind=int) > 0`` is a `bool`.

        Raises:
            UnknownProperty: no property has this name.
            IndexError: it has fewer values.
            TypeError: the value is not of the expected class.
        """
        value = plain(self._steps.publication.properties.first(name).values[index])
        if kind is not None and not isinstance(value, kind):
            raise TypeError(
                f"expected {kind.__qualname__} at index {index} of property {name}, found {value!r}"
            )
        return value

    def values(self, name: str) -> tuple[Any, ...]:
        """Return all values of the first property called *name*.

        Raises:
            UnknownProperty: no property has this name.
        """
        return tuple(map(plain, self._steps.publication.properties.first(name).values))

    def find_properties(self, name: str, *values: object) -> tuple[ObservableProperty, ...]:
        """Return the properties called *name*, the oldest first; with *values* (None for any), those that have these
        values.
        """
        return self._steps.publication.properties.all(name, values)

    @common_operation("observeProperty")
    def observe_property(self, name: str, found: Out) -> None:
        """Return a property as it is now, as a term, to an agent that need not focus the artifact.

        Fails with ``unknown_property(Name)``.
        """
        if not self.has_property(name):
            self.fail(f"Property not found {name}", "unknown_property", str(name))
        now = self._steps.publication.properties.first(name)
        found.set(Structure(now.name, now.values, now.annotations) if now.values else Atom(now.name))

    def has_untaken(self, name: str) -> bool:
        """Return whether an observer has not yet processed an earlier change of properties called *name* (backpressure).

        For sensors that change faster than agents reason: see `jacaros.robots.kit.reading`.
        """
        return self._steps.publication.has_untaken(name)

    # ---- signals, failure, log

    def signal(self, name: str, *arguments: object) -> None:
        """Send a signal to all observers. Changes made so far in the step are published with it."""
        self._steps.signal(name, arguments, None)

    def signal_to(self, agent: str | None, name: str, *arguments: object) -> None:
        """Send a signal to one observer. Changes made so far in the step are published to all.

        Raises:
            InvalidArtifact: *agent* is None, as `caller` is in an internal operation.
        """
        if agent is None:
            raise InvalidArtifact(
                f"signal_to({name!r}): expected an agent, found None; self.caller is None in internal operations, so pass "
                "the agent as an argument: self.start(self.go, self.caller)"
            )
        self._steps.signal(name, arguments, agent)

    def fail(self, message: str, functor: str | None = None, *arguments: object) -> NoReturn:
        """Fail the operation. Its step is rolled back.

        Args:
            message: text for users.
            functor: functor of the reason term. None for no reason.
            arguments: arguments of the reason term. Without arguments, it is an atom.

        Raises:
            OperationFailed: always.
        """
        message = message if isinstance(message, str) else text_of(message)
        if functor is None:
            raise OperationFailed(message)
        if not isinstance(functor, str) or not functor:
            raise InvalidArtifact(
                f"fail({message!r}, {functor!r}): expected a functor as reason, such as too_many"
            )
        raise OperationFailed(
            message, Structure(functor, tuple(map(plain, arguments))) if arguments else Atom(functor)
        )

    def log(self, text: str) -> None:
        """Log a line."""
        self._steps.setting.log(f"[{self.name}] {text}")

    # ---- the operation in progress

    @property
    def current(self) -> OperationExecution:
        """The operation in progress, with its request and its pauses.

        Raises:
            InvalidArtifact: no operation is in progress.
        """
        return self._steps.current("asking for the current operation", changes=False)

    @property
    def caller(self) -> Atom | None:
        """The agent that called the operation in progress, as an atom.

        Through links it is the agent at the beginning of the chain, in ``init`` the creator, and None in internal
        operations.
        """
        holder = self._steps.turns.holder
        if holder is None or holder.request.agent is None or not self._steps.inside():
            return None
        return Atom(holder.request.agent)

    def commit(self) -> None:
        """Publish the changes of the step so far. They can no longer be rolled back."""
        self._steps.current("a commit")
        self._steps.commit()

    async def sleep(self, delay: float) -> None:
        """Wait for *delay* seconds. This is a step boundary: other operations may run meanwhile."""
        await self._steps.leave(self.clock.sleep(delay), "sleeping")

    async def until(self, guard: Callable[[], bool]) -> None:
        """Wait until *guard* is true. This is a step boundary. The guard is evaluated after every step."""
        await self._steps.until(guard)

    async def step(self, awaitable: Awaitable[T]) -> T:
        """Await anything else, such as a service call. This is a step boundary.

        Without `step`, an ``await`` blocks all other operations of the artifact. Code that blocks runs in a thread:
        ``await self.step(asyncio.to_thread(self.ask_server))``.
        """
        return await self._steps.leave(awaitable, "waiting for something")

    async def pause_point(self, on_pause: Callable[[], None] | None = None) -> float:
        """Wait here while the operation is paused. This is a step boundary only if it is paused.

        Args:
            on_pause: called before waiting, within the operation. To stop at the moment of the pause, also register a
                callback with ``self.current.on_pause``.

        Returns:
            Seconds that the operation has been paused since the last pause point, usually 0.0.
        """
        return await self._steps.pause_point(on_pause)

    # ---- further operations

    def start(
        self, operation: str | Callable[..., object], *arguments: object, cause: Cause | None = None
    ) -> None:
        """Run an internal operation as a process of its own. Its failure is logged and has no other effect.

        From within an operation, it begins after the step has succeeded; from a callback or another thread, as soon as
        the artifact is free. Use it to change properties from there.

        Args:
            operation: a method marked `internal_operation` (or `operation`), or its name.
            arguments: passed unchanged.
            cause: what led to it, such as a sensor sample. None for the cause of the operation in progress.

        Raises:
            InvalidArtifact: the artifact has no such operation.
        """
        declared = self._steps.interface.own(operation, len(arguments))
        if declared is None:
            raise InvalidArtifact(self._cannot_start(operation, len(arguments)))
        self._steps.start(declared, OperationRequest(self.id, declared.name, arguments, None, cause))

    def _cannot_start(self, operation: str | Callable[..., object], count: int) -> str:
        wanted = operation if isinstance(operation, str) else str(getattr(operation, "__name__", operation))
        method = getattr(type(self), wanted, None)
        if method is not None and not marks_of(method):
            return f"{wanted} is not an operation of artifact {self.name}: add @internal_operation above def {wanted}"
        return f"unknown internal operation `{wanted}/{count}` of artifact {self.name}"

    async def call_linked(self, port: str | ArtifactId | None, operation: str, *arguments: object) -> None:
        """Call a linked operation of all artifacts that are linked to *port*, and wait for all of them. This is a step
        boundary.

        Args:
            port: one of `ports`; None for the first one; or an artifact, which need not be linked.
            operation: name of the linked operation.
            arguments: inputs, and `Out` objects for outputs.

        Raises:
            OperationFailed: the port is unknown or not linked, or a linked operation failed (with its reason).
        """
        targets = (port,) if isinstance(port, ArtifactId) else self._behind(port)
        call = call_all(self.workspace.execute_linked, targets, operation, arguments, self.current)
        await self._steps.leave(call, f"calling {operation}")

    def _behind(self, port: str | None) -> tuple[ArtifactId, ...]:
        if not self.ports or (port is not None and port not in self.ports):
            known = f"its ports are {', '.join(self.ports)}" if self.ports else "it has none"
            self._fail_call(f"unknown out port `{port}` of {type(self).__qualname__}; {known}")
        port = port if port is not None else self.ports[0]
        targets = self.workspace.linked(self.id, port)
        if not targets:
            self._fail_call(f"port {port} of artifact {self.name} is not linked")
        return targets

    def _fail_call(self, message: str) -> NoReturn:
        # CArtAgO's reason: there, every failed call is an error of the operation.
        self.fail(message, "operation_error", self.current.request.key)

    def define_operation(
        self,
        name: str,
        function: Callable[..., object],
        *,
        guard: Callable[..., object] | None = None,
        pausable: bool = False,
    ) -> None:
        """Add an operation to this artifact at run time, such as one read from a file.

        Args:
            name: name of the operation for agents.
            function: gets the arguments without the artifact. Its signature counts as that of a method.
            guard: gets the same arguments, or none. The operation waits until it is true.
            pausable: see `operation`.
        """
        mark = Mark(OPERATION, name, None, pausable)
        self._own_interface().operations.add(declare_function(mark, name, function, guard))

    def remove_operation(self, name: str) -> None:
        """Remove all operations called *name* from this artifact."""
        self._own_interface().operations.remove(name)

    def _own_interface(self) -> UsageInterface:
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
