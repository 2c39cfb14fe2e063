"""Working sessions, for scripts, behaviour trees and Python agents."""

import asyncio
from collections.abc import Callable, Generator, Iterator, Sequence
from functools import partial
from types import TracebackType
from typing import Any, TypedDict, TypeVar, Unpack

from jacaros.artifacts.env.artifact import Artifact
from jacaros.artifacts.env.environment import Environment
from jacaros.artifacts.env.errors import ArtifactId, OperationFailed, WorkspaceError
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest
from jacaros.artifacts.env.ports import ENDED, UnderWay, Workspace, awaited
from jacaros.artifacts.env.property import Observation
from jacaros.artifacts.env.values import Atom, Out, plain, text
from jacaros.artifacts.env.workspace import artifact_named
from jacaros.artifacts.presence.presence import (
    ANYWHERE,
    Account,
    Conditions,
    Direction,
    Observed,
    ObservedProperty,
    OperationObserver,
    Presence,
    PropertyChange,
    ReceivedSignal,
    changes_of,
)
from jacaros.runtime.clock import Clock

# An operation that a session has requested, from begin to end.


class SessionOperation:
    """The handle of an operation. It can be awaited, also by several tasks.

    It ends once: it succeeds, fails, exceeds its time limit or is cancelled. As with asyncio's tasks, cancelling a task
    that awaits the operation cancels the operation.

    Args:
        operation: name of the operation.
        arguments: its arguments.
        complain: called when a callback raises.

    Attributes:
        operation: name of the operation.
        outcome: its outcome. None while it runs.
        paused: whether its caller has paused it.
    """

    def __init__(
        self, operation: str, arguments: Sequence[object], complain: Callable[[str, Exception], None]
    ) -> None:
        self.operation = operation
        self._complain = complain
        self.outcome: OperationOutcome | None = None
        self._outs = tuple(each for each in arguments if isinstance(each, Out))
        self._execution: UnderWay = ENDED
        self.paused = False
        self._on_end: list[Callable[[SessionOperation], object]] = []
        self._waiting: list[asyncio.Future[None]] = []

    @property
    def done(self) -> bool:
        """Whether it has ended."""
        return self.outcome is not None

    @property
    def result(self) -> Any:
        """Return the values of the `Out` arguments: None without any, the value of a single one, a tuple of several.

        An output that the operation has not set is None.

        Raises:
            OperationFailed: it failed, exceeded its time limit, or was cancelled.
            asyncio.InvalidStateError: it has not ended.
        """
        if self.outcome is None:
            raise asyncio.InvalidStateError(f"operation {self.operation} has not ended")
        if not self.outcome.ok:
            raise self.outcome.failure
        values = tuple(out.value if out.is_set else None for out in self._outs)
        return values if len(values) > 1 else values[0] if values else None

    def cancel(self) -> None:
        """End it with the reason ``cancelled``: its ``finally`` blocks run, a motion ends. No effect after its end."""
        if not self.done:
            self._execution.cancel()
            self.end(OperationOutcome(False, f"operation {self.operation} was cancelled", Atom("cancelled")))

    def pause(self) -> None:
        """Pause it, if it is pausable."""
        self.paused = True
        if not self.done:
            self._execution.pause()

    def resume(self) -> None:
        """Let it continue after `pause`."""
        self.paused = False
        if not self.done:
            self._execution.resume()

    def on_end(self, callback: "Callable[[SessionOperation], object]") -> None:
        """Call *callback* with this handle at the end, immediately if it has ended. The callback should return soon."""
        if self.done:
            self._call(callback)
        else:
            self._on_end.append(callback)

    def __await__(self) -> Generator[Any, None, Any]:
        if not self.done:
            ended = asyncio.get_running_loop().create_future()
            self._waiting.append(ended)
            try:
                yield from ended
            except asyncio.CancelledError:
                self.cancel()
                raise
        return self.result

    # ---- called by the session

    def began(self, execution: UnderWay) -> None:
        """Set the execution."""
        if not self.done:
            self._execution = execution

    def end(self, outcome: OperationOutcome) -> None:
        """Set the outcome. Later outcomes are ignored."""
        if self.done:
            return
        self.outcome = outcome
        waiting, self._waiting = self._waiting, []
        for ended in waiting:
            if not ended.done():
                ended.set_result(None)
        callbacks, self._on_end = self._on_end, []
        for callback in callbacks:
            self._call(callback)

    def _call(self, callback: "Callable[[SessionOperation], object]") -> None:
        try:
            callback(self)
        except Exception as error:
            self._complain(f"an on_end callback of operation {self.operation} raised:", error)

    def __repr__(self) -> str:
        state = "under way" if self.outcome is None else "succeeded" if self.outcome.ok else "failed"
        return f"<operation {self.operation}: {state}>"


T = TypeVar("T")
_REQUIRED: Any = object()


class ActOptions(TypedDict, total=False):
    """The options of `Session.act`. See `Session.begin`."""

    artifact: ArtifactId | str | None
    workspace: str | None
    timeout: float | None
    urgency: int


class Session:
    """A working session in an environment (CArtAgO's term): it joins workspaces, focuses artifacts and acts.

    It must be used on the event loop of the environment, and takes plain values (see `jacaros.artifacts.env.values`). An
    artifact is given as its id, its name (looked up in the joined workspaces) or its path. As a context manager, it is
    closed at the end.

    Args:
        environment: the environment.
        name: its name as creator of artifacts, caller of operations and addressee of signals.
        home: full path of the workspace that it joins first.
        account: counts waits.

    Attributes:
        presence: its joined workspaces and focused artifacts.
        observer: receives the operations that begin from now on, or None.

    Raises:
        UnknownWorkspace: the workspace *home* does not exist.
    """

    def __init__(
        self, environment: Environment, name: str, home: str = "/main", account: Account | None = None
    ) -> None:
        self.environment, self.name = environment, name
        self._account = account if account is not None else Account()
        self._observed = Observed(name, self._tell)
        self._conditions = Conditions()
        self._on_change: list[Callable[[PropertyChange], object]] = []
        self._on_signal: list[Callable[[ReceivedSignal], object]] = []
        self._closed = False
        self.presence = Presence(environment, name, home, self._observed)
        self._under_way: dict[SessionOperation, None] = {}
        self._held: list[SessionOperation] | None = None
        self.observer: OperationObserver | None = None

    @property
    def clock(self) -> Clock:
        """The clock of the environment."""
        return self.environment.clock

    # ---- workspaces

    @property
    def joined(self) -> tuple[str, ...]:
        """Full paths of the joined workspaces, in the order of joining. The current one comes last."""
        return tuple(workspace.path for workspace in self.presence.workspaces.joined())

    def join(self, path: str) -> str:
        """Join a workspace and make it the current one. Joining again only makes it the current one.

        Args:
            path: full, or relative to the current workspace.

        Returns:
            The full path.

        Raises:
            UnknownWorkspace: the workspace does not exist.
        """
        self._check()
        workspace = self.presence.workspaces.find(path)
        self.presence.join(workspace)
        return workspace.path

    def quit(self, workspace: str) -> None:
        """Leave a workspace, given by path or name, and stop focusing its artifacts.

        Raises:
            OperationFailed: it is not joined; reason ``workspace_not_joined(Name)``.
        """
        self.presence.quit(self.presence.workspaces.named(workspace))

    @property
    def _here(self) -> Workspace:
        return self.presence.workspaces.current()

    # ---- artifacts

    async def make_artifact(
        self, name: str, artifact_type: str | type[Artifact], arguments: Sequence[object] = ()
    ) -> ArtifactId:
        """Create an artifact, and wait until its ``init`` has ended.

        Args:
            name: its name in the current workspace, or a path.
            artifact_type: the class, or the name of a type.
            arguments: arguments of ``init``.

        Raises:
            OperationFailed: see `Workspace.make_artifact`.
        """
        self._check()
        workspace, plain_name = self.environment.place(self._here, name)
        self._account.begin()
        try:
            return await workspace.make_artifact(
                plain_name, artifact_type, [plain(each) for each in arguments], self.name
            )
        finally:
            self._account.end()

    def lookup(self, name: str) -> ArtifactId:
        """Return an artifact by name, in the joined workspaces, or by path.

        Raises:
            OperationFailed: it does not exist; reason ``artifact_not_available(Name)``.
        """
        if "/" in name:
            workspace, name = self.environment.place(self._here, name)
            return workspace.lookup(name)
        return artifact_named(self.presence.workspaces.in_order(), name)

    def _artifact(self, wanted: ArtifactId | str) -> ArtifactId:
        self._check()
        return wanted if isinstance(wanted, ArtifactId) else self.lookup(wanted)

    # ---- focus

    def focus(self, artifact: ArtifactId | str) -> ArtifactId:
        """Focus an artifact. Its properties are available when this returns.

        Focusing again has no effect.

        Raises:
            OperationFailed: it does not exist, or its workspace is not joined.
        """
        found = self._artifact(artifact)
        self._observed.begin(self.presence.workspaces.at(found.workspace), found)
        return found

    async def focus_when_available(self, name: str) -> ArtifactId:
        """Wait until an artifact of this name exists in the current workspace (or at a path), and focus it.

        Raises:
            OperationFailed: its workspace does not exist, is not joined, or was quit meanwhile.
        """
        self._check()
        with self._account.waiting():
            return await awaited(partial(self.presence.focus_when_available, self._here, name))

    def stop_focus(self, artifact: ArtifactId | str) -> None:
        """Stop focusing an artifact. Without effect if it is not focused.

        Raises:
            OperationFailed: no artifact has this name.
        """
        if isinstance(artifact, str):
            named = [each for each in self.focused if artifact in (each.name, each.path)]
            artifact = named[0] if named else self.lookup(artifact)
        self._observed.end(artifact)

    # ---- perception

    @property
    def focused(self) -> tuple[ArtifactId, ...]:
        """The focused artifacts, in the order of focusing."""
        return self._observed.in_order()

    def value(
        self,
        name: str,
        index: int = 0,
        artifact: ArtifactId | str | None = None,
        default: Any = _REQUIRED,
    ) -> Any:
        """Return a value of the first property called *name* of the focused artifacts.

        Args:
            name: name of the property. Those of the artifact focused first come first, among them the oldest.
            index: index of the value, from 0.
            artifact: only properties of this artifact.
            default: returned if there is no such property.

        Raises:
            UnknownProperty: there is no such property, and no default.
        """
        if default is not _REQUIRED and not self.has_property(name, artifact=artifact):
            return default
        return self.values(name, artifact)[index]

    def values(self, name: str, artifact: ArtifactId | str | None = None) -> tuple[Any, ...]:
        """Return all values of the first property called *name* of the focused artifacts. See `value`.

        Raises:
            UnknownProperty: there is no such property.
        """
        found = next(self._find(name, (), artifact), None)
        if found is None:
            raise self._observed.unknown(name, self._narrowed(artifact))
        return found.values

    def has_property(self, name: str, *values: object, artifact: ArtifactId | str | None = None) -> bool:
        """Return whether a focused artifact has a property called *name*, with *values* (None for any) if given."""
        return next(self._find(name, values, artifact), None) is not None

    def properties(
        self, name: str, *values: object, artifact: ArtifactId | str | None = None
    ) -> tuple[ObservedProperty, ...]:
        """Return all properties called *name* of the focused artifacts, with *values* (None for any) if given."""
        return tuple(self._find(name, values, artifact))

    def _find(
        self, name: str, values: tuple[object, ...], artifact: ArtifactId | str | None
    ) -> Iterator[ObservedProperty]:
        return self._observed.find(name, values, self._narrowed(artifact))

    def _narrowed(self, artifact: ArtifactId | str | None) -> ArtifactId | None:
        if isinstance(artifact, str):
            named = (each for each in self.focused if artifact in (each.name, each.path))
            return next(named, None) or self.lookup(artifact)
        return artifact

    def on_change(self, callback: Callable[[PropertyChange], object]) -> Callable[[], None]:
        """Call *callback* with every change of a property of the focused artifacts. Return a function that ends this.

        By then, the session shows everything that was published together. The callback runs within the step of the
        artifact, so it should return soon.
        """
        return _enter(self._on_change, callback)

    def on_signal(self, callback: Callable[[ReceivedSignal], object]) -> Callable[[], None]:
        """Call *callback* with every signal of the focused artifacts. Return a function that ends this. See `on_change`."""
        return _enter(self._on_signal, callback)

    async def until(self, condition: Callable[[], T], timeout: float | None = None) -> T:
        """Wait until *condition* is true.

        It is evaluated now, and whenever a focused artifact publishes something, so a condition that holds for only one
        step is not missed.

        Args:
            condition: a function without arguments. An exception in it is raised here.
            timeout: time limit in seconds.

        Returns:
            The value of the condition.

        Raises:
            TimeoutError: the time limit has passed.
            WorkspaceError: the session was closed.
        """
        self._check()
        value = condition()
        if value:
            return value
        if timeout is None:
            with self._account.waiting():
                return await self._conditions.wait(condition)
        self._account.begin()
        try:
            return await self._conditions.wait(condition, self.clock, timeout)
        finally:
            self._account.end()

    def _tell(self, observation: Observation) -> None:
        for name, arguments in observation.signals:
            signal = ReceivedSignal(name, tuple(map(plain, arguments)), observation.artifact)
            for on_signal in tuple(self._on_signal):
                self._call(on_signal, signal, "an on_signal callback raised:")
        if self._on_change:
            for change in changes_of(observation):
                for on_change in tuple(self._on_change):
                    self._call(on_change, change, "an on_change callback raised:")
        self._conditions.evaluate()

    def _call(self, callback: Callable[[T], object], told: T, what: str) -> None:
        try:
            callback(told)
        except Exception as error:
            self._complain(what, error)

    def _complain(self, what: str, error: Exception) -> None:
        """Log that the session's own code failed, where no caller can receive the exception."""
        self.environment.log_error(self.name, what, error)

    # ---- operations

    async def act(self, operation: str, *arguments: object, **options: Unpack[ActOptions]) -> Any:
        """Run an operation, and wait for its end. The arguments are those of `begin`.

        Cancelling the waiting task cancels the operation.

        Returns:
            The values of the `Out` arguments: None without any, the value of a single one, a tuple of several.

        Raises:
            OperationFailed: with message and reason.
        """
        return await self.begin(operation, *arguments, **options)

    def begin(
        self,
        operation: str,
        *arguments: object,
        artifact: ArtifactId | str | None = None,
        workspace: str | None = None,
        timeout: float | None = None,
        urgency: int = 0,
    ) -> SessionOperation:
        """Begin an operation.

        Args:
            operation: name of the operation.
            arguments: values, and `Out` objects for results.
            artifact: the artifact. Default: searched in the joined workspaces (the current one, home, the others). Of
                several artifacts that offer the operation, one that this session created is preferred, then one that it
                focuses.
            workspace: path or name of the workspace of the artifact.
            timeout: time limit in seconds. Afterwards the operation fails with
                ``operation_timeout(Operation,Milliseconds)``.
            urgency: decides who gets the resources that it uses, such as the wheels of a robot. The greater one wins.

        Returns:
            Its handle. An operation that cannot begin, for example because no artifact offers it, has failed already.
        """
        self._check()
        if any(each is Out for each in arguments):
            raise WorkspaceError(
                f"expected an Out object as argument of {operation}, found the class Out; write Out()"
            )
        given = tuple(map(plain, arguments))
        handle = SessionOperation(operation, given, self._complain)
        self._under_way[handle] = None
        self._account.begin()
        handle.on_end(self._ended)
        if self.observer is not None:
            self._observe(handle, given)
        try:
            directed = artifact is not None or workspace is not None
            direction = Direction(artifact, workspace) if directed else ANYWHERE
            target = self.presence.artifact_for(operation, len(given), direction)
        except OperationFailed as failure:
            handle.end(OperationOutcome.of(failure))
            return handle
        request = OperationRequest(target, operation, given, self.name, None, handle.end, timeout)
        request.urgency = urgency
        handle.began(self.environment.execute(request))
        if self._held is not None:
            self._held.append(handle)
            handle.pause()
        return handle

    def hold(self) -> None:
        """Pause all operations, also those that begin meanwhile, until `release`."""
        if self._held is None:
            self._held = [each for each in self._under_way if not each.paused]
            for each in self._held:
                each.pause()

    def release(self) -> None:
        """Let the operations continue that `hold` has paused."""
        held, self._held = self._held, None
        for each in held or ():
            each.resume()

    def cancel_operations(self) -> None:
        """Cancel all running operations."""
        for handle in tuple(self._under_way):
            handle.cancel()

    def _observe(self, handle: SessionOperation, given: tuple[object, ...]) -> None:
        def tell(state: str, why: str = "") -> None:
            if self.observer is not None:
                self.observer(state, call, handle, why)

        shown = ", ".join("_" if isinstance(each, Out) else text(each, quoted=True) for each in given)
        call = f"{handle.operation}({shown})" if given else handle.operation

        def ended(handle: SessionOperation) -> None:
            outcome = handle.outcome
            assert outcome is not None
            if outcome.ok:
                tell("achieved")
            elif outcome.reason == Atom("cancelled"):
                tell("dropped")
            else:
                tell("failed", outcome.message or "")

        tell("executing")
        handle.on_end(ended)

    def _ended(self, handle: SessionOperation) -> None:
        del self._under_way[handle]
        self._account.end()

    # ---- the end

    def close(self) -> None:
        """Cancel the running operations and stop focusing. Closing again has no effect."""
        if self._closed:
            return
        self._closed = True
        self.cancel_operations()
        self._on_change.clear()
        self._on_signal.clear()
        self._conditions.close(self._is_closed())
        self.presence.leave()

    def _check(self) -> None:
        if self._closed:
            raise self._is_closed()

    def _is_closed(self) -> WorkspaceError:
        return WorkspaceError(f"session {self.name} has been closed")

    def __enter__(self) -> "Session":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<session {self.name} in {', '.join(self.joined[-1:]) or 'no workspace'}>"


def _enter(callbacks: list[T], callback: T) -> Callable[[], None]:
    callbacks.append(callback)
    return lambda: callbacks.remove(callback) if callback in callbacks else None
