"""Whose turn it is to make a step in an artifact: first come first served, guards permitting."""

import asyncio
import inspect
from collections.abc import Callable

from jacaros.env.errors import InvalidArtifact
from jacaros.env.execution import OperationExecution
from jacaros.env.kernel.faults import is_interruption
from jacaros.env.operation import OperationOutcome

Guard = Callable[[], object]


class Place:
    """A place in the queue.

    Attributes:
        execution: who waits.
        guard: must be true before the turn is given, None when nothing must.
        granted: set when the turn is given to a coroutine that goes on; None for one that begins.
        error: what the guard raised; who waits is to deal with it.
    """

    __slots__ = ("error", "execution", "granted", "guard")

    def __init__(
        self, execution: OperationExecution, guard: Guard | None, granted: asyncio.Future[None] | None = None
    ) -> None:
        self.execution, self.guard, self.granted = execution, guard, granted
        self.error: BaseException | None = None


class TurnQueue:
    """Gives the turn of one artifact to one execution at a time.

    Guards are evaluated when an operation arrives and again whenever a step has ended.

    Attributes:
        holder: who has the turn, None while the artifact is free.
        asking: True while a guard is evaluated, which must not change anything.
        places: of those who wait.
        serving: True while the turn is being given to somebody, or ended.
    """

    __slots__ = ("_begin", "_changed", "asking", "holder", "places", "serving")

    def __init__(self, begin: Callable[[OperationExecution, BaseException | None], None]) -> None:
        self._begin = begin
        self.asking = False
        self.holder: OperationExecution | None = None
        self.places: list[Place] = []
        self._changed = False
        self.serving = False

    def enter(self, execution: OperationExecution, guard: Guard | None) -> None:
        """Let an operation begin as soon as its turn comes, which may be at once."""
        if self.holder is not None or self.serving or execution.paused:
            self.places.append(Place(execution, guard))
            return
        self.serving = True
        self._changed = False  # who waits while the artifact is free has been asked since the last change
        try:
            if guard is None:
                self.holder = execution
                self._begin(execution, None)
            else:
                self._enter_guarded(Place(execution, guard))
        finally:
            self.serving = False
            if self.places:
                self.serve()

    def _enter_guarded(self, place: Place) -> None:
        if self._may_go(place):
            self._give(place)
        else:
            self.places.append(place)

    def line_up(
        self, executions: list[OperationExecution], guard: Callable[[OperationExecution], Guard | None]
    ) -> None:
        """Queue operations that the holder of the turn has started."""
        self.places.extend(Place(each, guard(each)) for each in executions)

    async def retake(self, execution: OperationExecution) -> None:
        """Wait until *execution* has the turn again.

        Also when it is cancelled while waiting: it then waits on, in front of all others, so that its
        ``finally`` runs as a step like any other, and the cancellation goes on after that.
        """
        if self.holder is None:
            self.holder = execution
            return
        place = Place(execution, None, asyncio.get_running_loop().create_future())
        self.places.insert(0 if execution.stopped else len(self.places), place)
        await self._granted(place)

    async def release_until(self, execution: OperationExecution, guard: Guard) -> None:
        """Give up the turn of *execution*, and wait until it has it again with *guard* true."""
        place = Place(execution, guard, asyncio.get_running_loop().create_future())
        self.places.append(place)
        self.release()
        await self._granted(place)
        if place.error is not None:
            raise place.error

    async def _granted(self, place: Place) -> None:
        assert place.granted is not None
        try:
            await place.granted
        except asyncio.CancelledError:
            await self._retake_first(place)
            raise

    async def _retake_first(self, place: Place) -> None:
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
        """End a step: give the turn to who may have it now."""
        self.holder = None
        self.reconsider()

    def end(
        self,
        tell: Callable[[OperationExecution, OperationOutcome], None],
        execution: OperationExecution,
        outcome: OperationOutcome,
    ) -> None:
        """End the last step of *execution*: *tell* comes before anybody else has a turn."""
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
        """Evaluate the guards again, because something has changed."""
        self._changed = True
        self.serve()

    def serve(self) -> None:
        """Give the turn to all who may have it, one after the other."""
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
        """Forget an operation that has not begun; False when it is not waiting to begin."""
        for place in self.places:
            if place.execution is execution and place.granted is None:
                self.places.remove(place)
                return True
        return False

    def waiting_to_begin(self) -> list[OperationExecution]:
        """The operations that wait for their first turn, in their order."""
        return [place.execution for place in self.places if place.granted is None]

    def _next(self) -> Place | None:
        for index, place in enumerate(self.places):
            if self._may_go(place):
                del self.places[index]
                return place
        return None

    def _may_go(self, place: Place) -> bool:
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
            raise InvalidArtifact("a guard must be a plain def that is true or false, not async")
        return bool(answer)

    def _give(self, place: Place) -> None:
        self.holder = place.execution
        if place.granted is not None:
            place.granted.set_result(None)
        else:
            self._begin(place.execution, place.error)
