"""The step in progress of one artifact: what it may do, and how it is published or rolled back."""

import asyncio
import inspect
import threading
from abc import ABC, abstractmethod
from collections.abc import Awaitable, Callable
from typing import TypeVar

from jacaros.clock import Clock
from jacaros.env.errors import InvalidArtifact, OperationFailed
from jacaros.env.execution import OperationExecution
from jacaros.env.ids import ArtifactId
from jacaros.env.kernel import faults
from jacaros.env.kernel.publication import Publication
from jacaros.env.kernel.setting import Setting
from jacaros.env.kernel.turns import Guard, TurnQueue
from jacaros.env.observation import Signal
from jacaros.env.property import check_name
from jacaros.env.values import plain

T = TypeVar("T")


class StepInProgress(ABC):
    """The current step of one artifact, if any.

    Attributes:
        id: the artifact.
        setting: what it shares with other artifacts.
        clock: clock of its operations.
        publication: its observable side.
        turns: the queue for its turn.
        disposed: whether it accepts no more operations.
    """

    def __init__(self, artifact_id: ArtifactId, setting: Setting) -> None:
        self.id, self.setting = artifact_id, setting
        self.clock: Clock = setting.clock
        self.publication = Publication(artifact_id, setting)
        self.turns = TurnQueue(self._begin)
        self.disposed = False
        self._started: list[OperationExecution] = []
        self._delayed: list[tuple[Signal, str | None]] = []

    @abstractmethod
    def _begin(self, execution: OperationExecution, error: BaseException | None) -> None:
        """Begin an operation, or fail it with the *error* of its guard. It has the turn."""

    @abstractmethod
    def _guard(self, execution: OperationExecution) -> Guard | None:
        """Return the condition for an operation to begin."""

    @abstractmethod
    def _claim(self, execution: OperationExecution) -> None:
        """Claim the resources of an operation."""

    def inside(self) -> bool:
        """Return whether the caller is the operation that has the turn, or its guard."""
        holder = self.turns.holder
        if holder is None or holder.task is None or self.turns.asking:
            return holder is not None
        if holder.thread is not None:
            return holder.thread == threading.get_ident()
        try:
            return asyncio.current_task() is holder.task
        except RuntimeError:
            return False

    def current(self, wanted: str, name: str = "", changes: bool = True) -> OperationExecution:
        """Return the operation whose step is in progress.

        Args:
            wanted: what the caller is about to do, for messages.
            name: the name it concerns.
            changes: whether this changes anything, which a guard must not.

        Raises:
            InvalidArtifact: the caller is not within a step, for example in a callback, or is a guard.
        """
        if changes and self.turns.asking:
            raise InvalidArtifact(
                f"artifact {self.id.name}: {wanted} {name} is not possible within a guard, which must not change anything"
            )
        holder = self.turns.holder
        if holder is not None and self.inside():
            return holder
        raise InvalidArtifact(
            f"artifact {self.id.name}: {wanted} {name} is only possible within an operation; from a callback, "
            "another task or a thread, run an internal operation with self.start(...), or use self.external_session()"
        )

    def commit(self) -> None:
        """Publish the changes of the step so far. Operations that it started may begin."""
        if self._delayed:
            self._publish_delayed()
        if self.publication.properties.changing:
            holder = self.turns.holder
            self.publication.publish(holder.cause if holder is not None else None)
        if self._started:
            started, self._started = self._started, []
            if not self.disposed:
                for each in started:
                    self._claim(each)
                self.turns.line_up(started, self._guard)

    def _publish_delayed(self) -> None:
        delayed, self._delayed = self._delayed, []
        holder = self.turns.holder
        cause = holder.cause if holder is not None else None
        self.publication.publish(cause, tuple(signal for signal, addressee in delayed if addressee is None))
        for signal, addressee in delayed:
            if addressee is not None:
                self.publication.publish(cause, (signal,), addressee)

    def _roll_back(self) -> None:
        """Undo what the step has changed, signalled (in a thread) and started since the last commit."""
        self.publication.properties.roll_back()
        self._started.clear()
        self._delayed.clear()

    def signal(self, name: str, arguments: tuple[object, ...], addressee: str | None) -> None:
        """Send a signal, together with the changes of the step so far."""
        holder = self.current("the signal", name)
        check_name(name)
        signal = Signal(name, tuple(map(plain, arguments)))
        if holder.declared is not None and holder.declared.threaded:
            self._delayed.append((signal, addressee))
            return
        self.publication.publish(holder.cause, (signal,), addressee)
        self.commit()

    def boundary(self, wanted: str) -> OperationExecution:
        """End the step of the calling coroutine, which still has the turn."""
        execution = self.current(wanted)
        if execution.task is None:
            raise InvalidArtifact(f"artifact {self.id.name}: {wanted} is only possible in an async def")
        self.commit()
        return execution

    async def leave(self, awaitable: Awaitable[T], wanted: str) -> T:
        """Await something while others may have the turn: end one step and begin another."""
        try:
            execution = self.boundary(wanted)
        except InvalidArtifact:
            if inspect.iscoroutine(awaitable):
                awaitable.close()
            raise
        self.turns.release()
        try:
            result = await awaitable
        except GeneratorExit:
            raise
        except BaseException:
            await self.turns.retake(execution)
            raise
        await self.turns.retake(execution)
        return result

    async def until(self, guard: Guard) -> None:
        """Continue as soon as *guard* is true. It is evaluated now and after every step."""
        execution = self.boundary("waiting for a condition")
        if not callable(guard):
            raise InvalidArtifact(
                f"artifact {self.id.name}: expected a function in until, such as a method or lambda: ..., found {guard!r}"
            )
        if not self.turns.ask(guard):
            if self.disposed:
                # Nothing else can make it true: only the operation that disposed its own artifact continues.
                gone = faults.disposed(execution.request)
                raise OperationFailed(gone.message or "", gone.reason)
            await self.turns.release_until(execution, guard)

    async def pause_point(self, on_pause: Callable[[], None] | None) -> float:
        """Wait while the operation is paused. Return the seconds that it has been paused since the last call."""
        execution = self.current("a pause point")
        while execution.paused:
            if on_pause is not None:
                on_pause()
            await self.leave(execution.resumed(), "a pause")
        return execution.take_paused_time()
