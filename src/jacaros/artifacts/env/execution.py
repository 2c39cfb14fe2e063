"""The execution of one operation: waiting, running, paused, cancelled or ended, and the resources that it holds."""

import asyncio
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from typing import Protocol

from jacaros.artifacts.env.arbiter import Arbiter, Claim, ClaimState, local_name
from jacaros.artifacts.env.errors import ArtifactId
from jacaros.artifacts.env.operation import OperationOutcome, OperationRequest, WhenPreempted
from jacaros.artifacts.env.ports import UnderWay
from jacaros.artifacts.env.property import Observation
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.kernel.declaration import NOTHING, DeclaredOperation
from jacaros.artifacts.kernel.faults import is_interruption
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.trace import Cause

Stop = Callable[[Structure | Atom], None]
"""Fails the operation with a reason."""


class Turns(Protocol):
    """The part of an artifact that an execution needs: keeps the kernel out of `env`."""

    clock: Clock

    def cancel(self, execution: "OperationExecution") -> None:
        """End *execution* without an outcome."""

    def reconsider(self) -> None:
        """Check whether a waiting operation can continue."""

    def complain(self, what: str, error: BaseException) -> None:
        """Log an error of the artifact's code that does not fail an operation."""

    def hold(self, execution: "OperationExecution", uses: tuple[str, ...]) -> "Holding":
        """Return a claim of an operation, which the operation enters and leaves."""


@dataclass(slots=True, eq=False, repr=False)
class OperationExecution:
    """The execution of one operation: the handle of its caller, and `Artifact.current` of its code.

    Attributes:
        turns: the operations of its artifact.
        request: the request of the caller.
        declared: the operation that serves it.
        arguments: the converted arguments.
        cause: what led to it.
        begun: True once its code has run.
        cancelled: True if it was cancelled. Its outcome is not reported.
        verdict: the outcome that its caller gets however it ends, because its artifact is gone or its time limit has
            passed. None while it ends normally.
        limit: timer of its time limit. None without a limit.
        ended: True when everything has ended, including code in ``finally``.
        holding: the resources that it holds. None if it uses none.
        suspended: its caller has paused it. It may also be paused because it waits for a resource.
        task: the task of a coroutine that has begun.
        linked: executions in other artifacts that it is waiting for.
        pauses: its pauses. None if it has not been paused, and nothing waits for a pause.
    """

    turns: Turns
    request: OperationRequest
    declared: DeclaredOperation = NOTHING
    arguments: tuple[object, ...] = ()
    cause: Cause | None = None
    begun: bool = field(default=False, init=False)
    cancelled: bool = field(default=False, init=False)
    verdict: OperationOutcome | None = field(default=None, init=False)
    limit: Timer | None = field(default=None, init=False)
    ended: bool = field(default=False, init=False)
    holding: "Holding | None" = field(default=None, init=False)
    suspended: bool = field(default=False, init=False)
    task: "asyncio.Task[None] | None" = field(default=None, init=False)
    linked: Sequence[UnderWay] = field(default=(), init=False)
    pauses: "Pause | None" = field(default=None, init=False)

    @property
    def stopped(self) -> bool:
        """Whether it has been cancelled, its artifact disposed, or its time limit has passed."""
        return self.cancelled or self.verdict is not None

    def cancel(self) -> None:
        """Cancel it: a coroutine is cancelled and runs its ``finally`` blocks; a waiting operation is removed.

        The outcome is not reported. Changes of the step in progress are rolled back; changes in ``finally`` are
        published.
        """
        self.turns.cancel(self)

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
        barred = self.suspended or (self.holding is not None and self.holding.barred)
        if barred and not self.paused and not self.ended:
            pause = self._noted_pauses()
            pause.since = self.turns.clock.elapsed
            self._call(pause.callbacks)
            self.turns.reconsider()
        elif not barred and self.pauses is not None and self.pauses.end():
            self._call(self.pauses.resumers)
            self.turns.reconsider()

    def _call(self, callbacks: list[Callable[[], None]]) -> None:
        for callback in list(callbacks):
            try:
                callback()
            except BaseException as error:
                if is_interruption(error):
                    raise
                self.turns.complain(f"a pause callback of {self.request.operation} failed", error)

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

    def hold(self, uses: tuple[str, ...]) -> "Holding":
        """Return its claim. If it has declared none, return one of *uses*, which it enters and leaves itself."""
        if self.holding is None:
            self.holding = self.turns.hold(self, uses)
        return self.holding

    @property
    def claims(self) -> tuple[Claim, ...]:
        """Return the claims that operations called by it are part of."""
        if self.holding is None or not self.holding.entered:
            return self.request.within
        return (*self.request.within, self.holding.claim)

    @property
    def pausable(self) -> bool:
        """Whether it obeys `pause`."""
        return self.declared.pausable

    @property
    def paused(self) -> bool:
        """Whether it is between `pause` and `resume`."""
        return self.pauses is not None and self.pauses.since is not None

    def on_pause(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call *callback* at every `pause`, immediately if it is paused. Return a function that ends this.

        The callback runs outside of the artifact's steps: it may stop a motor, but must not change properties. Without
        a call of the returned function, it is called until the operation ends.
        """
        callbacks = self._noted_pauses().callbacks
        callbacks.append(callback)
        if self.paused:
            callback()
        return lambda: callbacks.remove(callback) if callback in callbacks else None

    def on_resume(self, callback: Callable[[], None]) -> None:
        """Call *callback* at the end of every pause. As with `on_pause`, it must not change properties."""
        self._noted_pauses().resumers.append(callback)

    async def resumed(self) -> None:
        """Wait until it is not paused. Await it through `Artifact.pause_point` or `Artifact.step`."""
        while self.pauses is not None and self.pauses.since is not None:
            await self._rest(self.pauses)

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
        return self.pauses.take() if self.pauses is not None else 0.0

    def _noted_pauses(self) -> "Pause":
        if self.pauses is None:
            self.pauses = Pause(self.turns.clock)
        return self.pauses


@dataclass(slots=True)
class Pause:
    """The pauses of one execution.

    Attributes:
        clock: clock of the run.
        since: begin of the current pause, or None.
        callbacks: called when a pause begins.
        resumers: called when a pause ends.
    """

    clock: Clock
    since: float | None = None
    callbacks: list[Callable[[], None]] = field(default_factory=list)
    resumers: list[Callable[[], None]] = field(default_factory=list)
    _spent: float = 0.0
    _waiting: list[asyncio.Future[None]] = field(default_factory=list)

    def end(self) -> bool:
        """End the current pause and wake the waiting tasks. Return False without a pause."""
        if self.since is None:
            return False
        self._spent += self.clock.elapsed - self.since
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


class Holding:
    """The claim of one operation.

    It may be entered and left several times. While it is entered and not granted, the operation is paused.

    Args:
        operation: the operation that uses resources.
        arbiter: arbiter of its environment.
        uses: the resources.
        when_preempted: what it does when a more urgent claim takes them away.
        stop: fails the operation.

    Attributes:
        claim: the claim at the arbiter.
        entered: whether the claim has been made and not released.
        resting: whether the operation waits for the end of its pause, so that nothing moves.
    """

    def __init__(
        self,
        operation: OperationExecution,
        arbiter: Arbiter,
        uses: tuple[str, ...],
        when_preempted: WhenPreempted,
        stop: Stop,
    ) -> None:
        request = operation.request
        self._operation, self._arbiter, self._stop = operation, arbiter, stop
        self._when_preempted = when_preempted
        agent = f"[{request.agent}] " if request.agent is not None else ""
        who = f"{agent}{request.operation}"
        blocks = request.agent if request.agent is not None and not request.yields else ""
        self.claim = Claim(uses, who, self, request.urgency, request.policy, request.within, blocks=blocks)
        self.entered = self.resting = self._entering = False
        self._told = False
        self._watchers: list[Callable[[], None]] = []

    @property
    def barred(self) -> bool:
        """Whether the operation has claimed its resources, and must not continue without them."""
        return self.entered and self.claim.state is not ClaimState.HELD

    def watch(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call *callback* whenever the claim is granted or preempted, or the caller pauses or resumes the operation.

        Return a function that ends this.
        """
        self._watchers.append(callback)
        return lambda: self._watchers.remove(callback)

    def enter(self) -> None:
        """Claim the resources, unless they are claimed."""
        if self.entered:
            return
        self.entered = self._entering = True
        if not self._operation.suspended:
            self._arbiter.enter(self.claim)
        self._entering = False
        self._operation.adapt()

    def leave(self) -> None:
        """Release the resources, or the place in the queue."""
        self.entered = False
        self._arbiter.leave(self.claim)
        self._tell(None)
        self._operation.adapt()

    # ---- the caller pauses and resumes the operation

    def suspended(self) -> None:
        """The caller has paused the operation: others may have its turn, as soon as nothing moves."""
        if self.entered and (
            self.resting or self.claim.state is ClaimState.WAITING or not self._operation.active
        ):
            self._arbiter.leave(self.claim)
        self._tell(None)
        self._changed()

    def resumed(self) -> None:
        """The caller has resumed the operation: it claims again what it has released."""
        if self.entered and self.claim.state is ClaimState.OUT:
            self._arbiter.enter(self.claim)
        self._changed()

    def rest(self) -> None:
        """Nothing moves: the operation yields."""
        if self._operation.suspended:
            self._arbiter.leave(self.claim)
        else:
            self._arbiter.gave_way(self.claim)

    # ---- the claimant of the arbiter

    @property
    def can_yield(self) -> bool:
        """Whether it may be preempted now."""
        if not self._operation.active:
            return True
        return self._when_preempted != "finish" and self._operation.request.yields

    def granted(self, claim: Claim) -> None:
        """Continue, or begin."""
        self._operation.adapt()
        self._tell(None)
        if not self._entering:
            self._changed()

    def preempted(self, claim: Claim, resource: str) -> None:
        """Yield: immediately before the operation has begun, after braking while it runs."""
        if not self._operation.active:
            self._operation.adapt()
            self._arbiter.gave_way(claim)
        elif self._when_preempted == "cancel":
            self._stop(Structure("preempted", (Atom(local_name(resource)),)))
        else:
            if not self._operation.suspended:
                self._tell(local_name(resource))
            self._operation.adapt()
            if self.resting or self._operation.linked:
                self.rest()
        self._changed()

    def refused(self, claim: Claim, reason: Structure | Atom) -> None:
        """Fail."""
        self.entered = False
        self._stop(reason)

    def _tell(self, resource: str | None) -> None:
        """Report to the caller that the operation is preempted, or no longer."""
        if self._told is not (resource is not None):
            self._told = resource is not None
            self._operation.request.on_preempted(resource)

    def _changed(self) -> None:
        for callback in list(self._watchers):
            callback()


# Call the linked operations behind an out port, and wait for all of them.


ExecuteOperation = Callable[[OperationRequest], UnderWay]


async def call_all(
    execute: ExecuteOperation,
    targets: tuple[ArtifactId, ...],
    operation: str,
    arguments: tuple[object, ...],
    execution: OperationExecution,
) -> None:
    """Call *operation* of all *targets* on behalf of *execution*, and wait for all of them.

    Cancelling or pausing *execution* meanwhile cancels or pauses them.

    Raises:
        OperationFailed: one of them failed, with the message and reason of the first one in the given order.
    """
    outcomes: list[OperationOutcome | None] = [None] * len(targets)
    all_done: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    def done(index: int, outcome: OperationOutcome) -> None:
        outcomes[index] = outcome
        if None not in outcomes and not all_done.done():
            all_done.set_result(None)

    agent, cause = execution.request.agent, execution.cause
    calls: list[UnderWay] = []
    for index, target in enumerate(targets):
        request = OperationRequest(target, operation, arguments, agent, cause, partial(done, index))
        request.urgency, request.on_preempted = execution.request.urgency, execution.request.on_preempted
        request.within, request.yields = execution.claims, execution.request.yields
        calls.append(execute(request))
        execution.linked = (*execution.linked, calls[-1])
        if execution.paused:
            calls[-1].pause()
    try:
        await all_done
    except asyncio.CancelledError:
        for call in calls:
            call.cancel()
        raise
    finally:
        execution.linked = tuple(each for each in execution.linked if each not in calls)
    for outcome in outcomes:
        if outcome is not None and not outcome.ok:
            raise outcome.failure


# The port through which a whole environment is observed. See `Environment.listener`.


class EnvironmentListener(Protocol):
    """Receives what happens in the artifacts of one environment, on the event loop.

    Without a listener, this costs nothing. A listener returns soon, does not raise and changes nothing.
    """

    def artifact(self, artifact: ArtifactId, present: bool) -> None:
        """An artifact has been created (True) or disposed. Artifacts that represent agents are left out."""

    def focused(self, artifact: ArtifactId, agent: str, on: bool) -> None:
        """An agent has begun to focus an artifact (True), or stopped."""

    def published(self, observation: Observation) -> None:
        """An artifact has changed properties or sent signals."""

    def began(self, execution: OperationExecution) -> None:
        """A requested operation begins, or waits for its turn."""

    def ended(self, execution: OperationExecution, outcome: OperationOutcome | None) -> None:
        """The operation has ended. None: it was cancelled."""
