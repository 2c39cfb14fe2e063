"""One operation on its way: waiting, running, paused, cancelled or ended."""

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
    """What an execution needs of the artifact that it belongs to."""

    clock: Clock

    def cancel(self, execution: "OperationExecution") -> None:
        """End *execution* without an outcome."""

    def reconsider(self) -> None:
        """See whether somebody who waits may go on now."""

    def complain(self, what: str, error: BaseException) -> None:
        """Log an error of the artifact's code that harms nobody."""

    def hold(self, execution: "OperationExecution", uses: tuple[Use, ...]) -> Holding:
        """Let an operation use something; it has to enter and to leave."""


class OperationExecution:
    """One operation on its way; the handle of its caller, and `Artifact.current` of its code.

    Attributes:
        request: what was asked for.
        declared: the operation that serves it, None when it was refused.
        arguments: what the operation receives.
        asked_for: step boundaries that it may have forgotten to await.
        cause: what led to it.
        begun: True once its code has run.
        cancelled: True when it was dropped; nobody is told its outcome.
        verdict: what its caller is told however it ends now: its artifact is gone, or its time is up; None while
            it ends by itself.
        told: True once its caller knows the outcome, though it may not have ended (a thread cannot be stopped).
        limit: rings when its time is up, None without a limit.
        thread: the thread in which it runs, None when that is the loop's.
        ended: True when all is over, code in ``finally`` included.
        holding: what it holds of the resources that it uses, None when it uses none.
        suspended: its caller has paused it; it may be paused without that, because it waits for a resource.
        task: the task of a coroutine that has been given its first turn.
        linked: executions in other artifacts that it waits for now.
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
        """True when it has been cancelled, its artifact disposed, or its time is up."""
        return self.cancelled or self.verdict is not None

    def cancel(self) -> None:
        """Drop it: a coroutine is cancelled and its ``finally`` runs, a waiting operation is forgotten.

        The outcome is not told.  What the step in progress changed is undone; what ``finally`` changes is
        published.  An operation in a thread runs to its end.
        """
        if self._turns is not None:
            self._turns.cancel(self)

    def pause(self) -> None:
        """Ask it to stop for a while; obeyed by pausable operations, and passed on through links.

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
        """Pause or continue, as its caller and the resources that it uses allow."""
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
        """Let it go on after `pause`."""
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
        """True once its code has begun, or its task has been made."""
        return self.begun or self.task is not None

    def hold(self, uses: tuple[Use, ...]) -> Holding:
        """What it holds; of *uses* if it has not declared any, and then it has to enter and to leave itself."""
        if self.holding is None:
            assert self._turns is not None
            self._turns.hold(self, uses)
        assert self.holding is not None
        return self.holding

    @property
    def claims(self) -> tuple[Claim, ...]:
        """What operations are within that it asks for."""
        if self.holding is None or not self.holding.entered:
            return self.request.within
        return (*self.request.within, self.holding.claim)

    @property
    def waits_for_others(self) -> bool:
        """True while it waits for linked operations."""
        return bool(self.linked)

    @property
    def pausable(self) -> bool:
        """True when it obeys `pause`."""
        return self.declared is not None and self.declared.pausable

    @property
    def paused(self) -> bool:
        """True between `pause` and `resume`."""
        return self._pause is not None and self._pause.since is not None

    def on_pause(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call *callback* at the moment of every `pause` from now on, at once if it is paused already.

        It runs outside of the steps of the artifact: it may stop a motor, not change properties.  Call what this gives
        when it is to be called no more; without that it is called until the operation ends.
        """
        if self._turns is None:
            return lambda: None
        callbacks = self._pauses(self._turns).callbacks
        callbacks.append(callback)
        if self.paused:
            callback()
        return lambda: callbacks.remove(callback) if callback in callbacks else None

    def on_resume(self, callback: Callable[[], None]) -> None:
        """Call *callback* at the end of every pause from now on; like that of `on_pause`, it must not change properties."""
        if self._turns is not None:
            self._pauses(self._turns).resumers.append(callback)

    async def resumed(self) -> None:
        """Wait until it is not paused; to be awaited through `Artifact.pause_point` or `Artifact.step`."""
        while self._pause is not None and self._pause.since is not None:
            await self._rest(self._pause)

    async def _rest(self, pause: "Pause") -> None:
        """Wait for the end of the pause; nothing moves, so others may have what it holds."""
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
        """Seconds that it has been paused since this was last asked."""
        return self._pause.take() if self._pause is not None else 0.0

    def _pauses(self, turns: Turns) -> "Pause":
        if self._pause is None:
            self._pause = Pause(turns.clock)
        return self._pause


class Pause:
    """The pauses of one execution.

    Attributes:
        since: when the present pause began, None while there is none.
        callbacks: called when one begins.
        resumers: called when one ends.
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
        """End the present pause and wake who waits for that; False when there is none."""
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
        """Wait for the end of the present pause."""
        future: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._waiting.append(future)
        await future

    def take(self) -> float:
        """Seconds of pause not taken before."""
        spent, self._spent = self._spent, 0.0
        return spent
