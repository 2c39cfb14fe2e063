"""The execution of one operation: waiting, running, paused, cancelled or ended."""

import asyncio
from collections.abc import Callable, Sequence
from typing import Protocol

from jacaros.clock import Clock, Timer
from jacaros.env.kernel.declaration import DeclaredOperation
from jacaros.env.kernel.faults import is_interruption
from jacaros.env.kernel.holding import Holding
from jacaros.env.kernel.unawaited import AskedFor
from jacaros.env.operation import OperationOutcome, OperationRequest
from jacaros.env.resources.claim import Claim
from jacaros.env.resources.resource import Use
from jacaros.trace import Cause


class Turns(Protocol):
    """The part of an artifact that an execution needs."""

    clock: Clock

    def cancel(self, execution: "OperationExecution") -> None:
        """End *execution* without an outcome."""

    def reconsider(self) -> None:
        """Check whether a waiting operation can continue."""

    def complain(self, what: str, error: BaseException) -> None:
        """Log an error of the artifact's code that does not fail an operation."""

    def hold(self, execution: "OperationExecution", uses: tuple[Use, ...]) -> Holding:
        """Return a claim of an operation, which the operation enters and leaves."""


class OperationExecution:
    """The execution of one operation: the handle of its caller, and `Artifact.current` of its code.

    Attributes:
        request: the request of the caller.
        declared: the operation that serves it. None if it was refused.
        arguments: the converted arguments.
        asked_for: step boundaries that may not have been awaited.
        cause: what led to it.
        begun: True once its code has run.
        cancelled: True if it was cancelled. Its outcome is not reported.
        verdict: the outcome that its caller gets however it ends, because its artifact is gone or its time limit has
            passed. None while it ends normally.
        told: True once the caller has the outcome. The operation may still run (a thread cannot be stopped).
        limit: timer of its time limit. None without a limit.
        thread: the thread in which it runs. None if it runs on the event loop.
        ended: True when everything has ended, including code in ``finally``.
        holding: the resources that it holds. None if it uses none.
        suspended: its caller has paused it. It may also be paused because it waits for a resource.
        task: the task of a coroutine that has begun.
        linked: executions in other artifacts that it is waiting for.
    """

    __slots__ = (
        "_pause",
        "_turns",
        "arguments",
        "asked_for",
        "begun",
        "cancelled",
        "cause",
        "declared",
        "ended",
        "holding",
        "limit",
        "linked",
        "request",
        "suspended",
        "task",
        "thread",
        "told",
        "verdict",
    )

    def __init__(
        self,
        turns: Turns | None,
        request: OperationRequest,
        declared: DeclaredOperation | None = None,
        arguments: tuple[object, ...] = (),
        cause: Cause | None = None,
    ) -> None:
        self._turns = turns
        self.request, self.declared, self.arguments, self.cause = request, declared, arguments, cause
        self.begun = self.cancelled = self.told = self.suspended = False
        self.holding: Holding | None = None
        self.asked_for: Sequence[AskedFor] = ()
        self.ended = declared is None
        self.verdict: OperationOutcome | None = None
        self.limit: Timer | None = None
        self.thread: int | None = None
        self.task: asyncio.Task[None] | None = None
        self.linked: list[OperationExecution] = []
        self._pause: Pause | None = None

    @property
    def stopped(self) -> bool:
        """Whether it has been cancelled, its artifact disposed, or its time limit has passed."""
        return self.cancelled or self.verdict is not None

    def cancel(self) -> None:
        """Cancel it: a coroutine is cancelled and runs its ``finally`` blocks; a waiting operation is removed.

        The outcome is not reported. Changes of the step in progress are rolled back; changes in ``finally`` are
        published. An operation in a thread runs to its end.
        """
        if self._turns is not None:
            self._turns.cancel(self)

    def pause(self) -> None:
        """Ask it to pause. Pausable operations obey, and linked operations get the request, too.

        An operation that has not begun does not begin before `resume`.
        """
        for each in self.linked:
            each.pause()
        waits = self.holding is not None and not self.active
        if self.suspended or self.ended or not (self.pausable or waits):
            return
        self.suspended = True
        self.adapt()
        if self.holding is not None:
            self.holding.suspended()

    def adapt(self) -> None:
        """Pause or continue, depending on its caller and the resources it uses."""
        if self._turns is None:
            return
        barred = self.suspended or (self.holding is not None and self.holding.barred)
        if barred and not self.paused and not self.ended:
            pause = self._pauses(self._turns)
            pause.since = self._turns.clock.elapsed
            self._call(pause.callbacks, self._turns)
            self._turns.reconsider()
        elif not barred and self._pause is not None and self._pause.end():
            self._call(self._pause.resumers, self._turns)
            self._turns.reconsider()

    def _call(self, callbacks: list[Callable[[], None]], turns: Turns) -> None:
        for callback in list(callbacks):
            try:
                callback()
            except BaseException as error:
                if is_interruption(error):
                    raise
                turns.complain(f"a pause callback of {self.request.operation} failed", error)

    def resume(self) -> None:
        """Let it continue after `pause`."""
        for each in self.linked:
            each.resume()
        if not self.suspended:
            return
        self.suspended = False
        if self.holding is not None:
            self.holding.resumed()
        self.adapt()

    @property
    def active(self) -> bool:
        """Whether its code has begun, or its task exists."""
        return self.begun or self.task is not None

    def hold(self, uses: tuple[Use, ...]) -> Holding:
        """Return its claim. If it has declared none, return one of *uses*, which it enters and leaves itself."""
        if self.holding is None:
            assert self._turns is not None
            self._turns.hold(self, uses)
        assert self.holding is not None
        return self.holding

    @property
    def claims(self) -> tuple[Claim, ...]:
        """Return the claims that operations called by it are part of."""
        if self.holding is None or not self.holding.entered:
            return self.request.within
        return (*self.request.within, self.holding.claim)

    @property
    def waits_for_others(self) -> bool:
        """Whether it is waiting for linked operations."""
        return bool(self.linked)

    @property
    def pausable(self) -> bool:
        """Whether it obeys `pause`."""
        return self.declared is not None and self.declared.pausable

    @property
    def paused(self) -> bool:
        """Whether it is between `pause` and `resume`."""
        return self._pause is not None and self._pause.since is not None

    def on_pause(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call *callback* at every `pause`, immediately if it is paused. Return a function that ends this.

        The callback runs outside of the artifact's steps: it may stop a motor, but must not change properties. Without
        a call of the returned function, it is called until the operation ends.
        """
        if self._turns is None:
            return lambda: None
        callbacks = self._pauses(self._turns).callbacks
        callbacks.append(callback)
        if self.paused:
            callback()
        return lambda: callbacks.remove(callback) if callback in callbacks else None

    def on_resume(self, callback: Callable[[], None]) -> None:
        """Call *callback* at the end of every pause. As with `on_pause`, it must not change properties."""
        if self._turns is not None:
            self._pauses(self._turns).resumers.append(callback)

    async def resumed(self) -> None:
        """Wait until it is not paused. Await it through `Artifact.pause_point` or `Artifact.step`."""
        while self._pause is not None and self._pause.since is not None:
            await self._rest(self._pause)

    async def _rest(self, pause: "Pause") -> None:
        """Wait for the end of the pause. Nothing moves, so others may use its resources."""
        if self.holding is None:
            await pause.wait()
            return
        self.holding.resting = True
        try:
            self.holding.rest()
            if pause.since is not None:
                await pause.wait()
        finally:
            self.holding.resting = False

    def take_paused_time(self) -> float:
        """Return the seconds that it has been paused since the last call."""
        return self._pause.take() if self._pause is not None else 0.0

    def _pauses(self, turns: Turns) -> "Pause":
        if self._pause is None:
            self._pause = Pause(turns.clock)
        return self._pause


class Pause:
    """The pauses of one execution.

    Attributes:
        since: begin of the current pause, or None.
        callbacks: called when a pause begins.
        resumers: called when a pause ends.
    """

    __slots__ = ("_clock", "_spent", "_waiting", "callbacks", "resumers", "since")

    def __init__(self, clock: Clock) -> None:
        self._clock = clock
        self.since: float | None = None
        self.callbacks: list[Callable[[], None]] = []
        self.resumers: list[Callable[[], None]] = []
        self._spent = 0.0
        self._waiting: list[asyncio.Future[None]] = []

    def end(self) -> bool:
        """End the current pause and wake the waiting tasks. Return False without a pause."""
        if self.since is None:
            return False
        self._spent += self._clock.elapsed - self.since
        self.since = None
        waiting, self._waiting = self._waiting, []
        for future in waiting:
            if not future.done():
                future.set_result(None)
        return True

    async def wait(self) -> None:
        """Wait for the end of the current pause."""
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiting.append(future)
        await future

    def take(self) -> float:
        """Return the seconds of pause that have not been taken before."""
        spent, self._spent = self._spent, 0.0
        return spent
