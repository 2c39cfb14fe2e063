"""The queue for the turn of an artifact: first come, first served, if guards permit."""

import asyncio
import inspect
from collections.abc import Callable
from dataclasses import dataclass

from jacaros.artifacts.env.errors import InvalidArtifact
from jacaros.artifacts.env.execution import OperationExecution
from jacaros.artifacts.env.operation import OperationOutcome
from jacaros.artifacts.kernel.faults import is_interruption

Guard = Callable[[], object]


@dataclass(slots=True, eq=False)
class QueuePlace:
    """A place in the queue.

    Attributes:
        execution: the waiting operation.
        guard: must be true before the turn is given. None without a guard.
        granted: set when a coroutine that continues gets the turn. None for an operation that begins.
        error: what the guard raised. The waiting operation handles it.
    """

    execution: OperationExecution
    guard: Guard | None
    granted: "asyncio.Future[None] | None" = None
    error: BaseException | None = None


class TurnQueue:
    """Gives the turn of one artifact to one execution at a time.

    Guards are evaluated when an operation arrives, and again after every step.

    Attributes:
        holder: the execution that has the turn. None while the artifact is free.
        asking: whether a guard is being evaluated, which must not change anything.
        places: the queue.
        serving: whether the turn is being given or ended.
    """

    __slots__ = ("_begin", "_changed", "asking", "holder", "places", "serving")

    def __init__(self, begin: Callable[[OperationExecution, BaseException | None], None]) -> None:
        self._begin = begin
        self.asking = False
        self.holder: OperationExecution | None = None
        self.places: list[QueuePlace] = []
        self._changed = False
        self.serving = False

    def enter(self, execution: OperationExecution, guard: Guard | None) -> None:
        """Begin an operation as soon as it has the turn, possibly immediately."""
        if self.holder is not None or self.serving or execution.paused:
            self.places.append(QueuePlace(execution, guard))
            return
        self.serving = True
        self._changed = False  # the guards of waiting operations have been evaluated since the last change
        try:
            if guard is None:
                self.holder = execution
                self._begin(execution, None)
            else:
                self._enter_guarded(QueuePlace(execution, guard))
        finally:
            self.serving = False
            if self.places:
                self.serve()

    def _enter_guarded(self, place: QueuePlace) -> None:
        if self._may_go(place):
            self._give(place)
        else:
            self.places.append(place)

    def line_up(
        self, executions: list[OperationExecution], guard: Callable[[OperationExecution], Guard | None]
    ) -> None:
        """Queue operations that the holder of the turn has started."""
        self.places.extend(QueuePlace(each, guard(each)) for each in executions)

    async def retake(self, execution: OperationExecution) -> None:
        """Wait until *execution* has the turn again.

        If it is cancelled while waiting, it continues to wait, before all others, so that its ``finally`` runs as an
        ordinary step. The cancellation then continues.
        """
        if self.holder is None:
            self.holder = execution
            return
        place = QueuePlace(execution, None, asyncio.get_running_loop().create_future())
        self.places.insert(0 if execution.stopped else len(self.places), place)
        await self._granted(place)

    async def release_until(self, execution: OperationExecution, guard: Guard) -> None:
        """Release the turn of *execution*, and wait until it has it again with *guard* true."""
        place = QueuePlace(execution, guard, asyncio.get_running_loop().create_future())
        self.places.append(place)
        self.release()
        await self._granted(place)
        if place.error is not None:
            raise place.error

    async def _granted(self, place: QueuePlace) -> None:
        assert place.granted is not None
        try:
            await place.granted
        except asyncio.CancelledError:
            await self._retake_first(place)
            raise

    async def _retake_first(self, place: QueuePlace) -> None:
        place.guard = None
        while self.holder is not place.execution:
            self.places.remove(place)
            if self.holder is None:
                self.holder = place.execution
                return
            place.granted = asyncio.get_running_loop().create_future()
            self.places.insert(0, place)
            try:
                await place.granted
            except asyncio.CancelledError:
                continue

    def release(self) -> None:
        """End a step and give the turn to the next operation."""
        self.holder = None
        self.reconsider()

    def end(
        self,
        tell: Callable[[OperationExecution, OperationOutcome], None],
        execution: OperationExecution,
        outcome: OperationOutcome,
    ) -> None:
        """End the last step of *execution*. *tell* is called before another operation has the turn."""
        self.holder = None
        self._changed = True
        if self.serving:
            tell(execution, outcome)
            return
        self.serving = True
        try:
            tell(execution, outcome)
        finally:
            self.serving = False
            self.serve()

    def reconsider(self) -> None:
        """Evaluate the guards again, after a change."""
        self._changed = True
        self.serve()

    def serve(self) -> None:
        """Give the turn to all waiting operations that may have it, in order."""
        if self.serving:
            return
        self.serving = True
        try:
            while self._changed and self.holder is None and self.places:
                self._changed = False
                place = self._next()
                if place is not None:
                    self._give(place)
        finally:
            self.serving = False

    def withdraw(self, execution: OperationExecution) -> bool:
        """Remove an operation that has not begun. Return False if it is not waiting to begin."""
        for place in self.places:
            if place.execution is execution and place.granted is None:
                self.places.remove(place)
                return True
        return False

    def waiting_to_begin(self) -> list[OperationExecution]:
        """Return the operations that wait for their first turn, in order."""
        return [place.execution for place in self.places if place.granted is None]

    def _next(self) -> QueuePlace | None:
        for index, place in enumerate(self.places):
            if self._may_go(place):
                del self.places[index]
                return place
        return None

    def _may_go(self, place: QueuePlace) -> bool:
        if place.granted is None:
            if place.execution.paused:
                return False
        elif place.granted.done():
            return False
        if place.guard is None:
            return True
        self.holder = place.execution
        try:
            return self.ask(place.guard)
        except BaseException as error:
            if is_interruption(error):
                raise
            place.error = error
            return True
        finally:
            self.holder = None

    def ask(self, guard: Guard) -> bool:
        """Evaluate *guard* for the holder of the turn."""
        self.asking = True
        try:
            answer = guard()
        finally:
            self.asking = False
        if inspect.iscoroutine(answer):
            answer.close()
            raise InvalidArtifact("expected a plain def as guard, found an async def")
        return bool(answer)

    def _give(self, place: QueuePlace) -> None:
        self.holder = place.execution
        if place.granted is not None:
            place.granted.set_result(None)
        else:
            self._begin(place.execution, place.error)
