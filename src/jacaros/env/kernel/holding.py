"""The resources that one operation holds, and how it yields to a more urgent claim."""

from collections.abc import Callable
from typing import Protocol

from jacaros.env.operation import OperationRequest, WhenPreempted
from jacaros.env.resources.arbiter import Arbiter
from jacaros.env.resources.claim import Claim, State
from jacaros.env.resources.resource import Use, local_name
from jacaros.env.values import Atom, Structure

Stop = Callable[[Structure | Atom], None]
"""Fails the operation with a reason."""


class Operation(Protocol):
    """The operation, as its claim sees it."""

    request: OperationRequest

    @property
    def active(self) -> bool:
        """Whether its code has begun."""

    @property
    def waits_for_others(self) -> bool:
        """Whether it only waits for operations that it has called."""

    @property
    def suspended(self) -> bool:
        """Whether its caller has paused it."""

    def adapt(self) -> None:
        """Pause or continue, after a change of its claim."""


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
        operation: Operation,
        arbiter: Arbiter,
        uses: tuple[Use, ...],
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
        return self.entered and self.claim.state is not State.HELD

    @property
    def holds(self) -> bool:
        """Whether no other claim can have the resources. Also true while the operation yields."""
        return self.claim.holds

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
        if self.entered and (self.resting or self.claim.state is State.WAITING or not self._operation.active):
            self._arbiter.leave(self.claim)
        self._tell(None)
        self._changed()

    def resumed(self) -> None:
        """The caller has resumed the operation: it claims again what it has released."""
        if self.entered and self.claim.state is State.OUT:
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
            if self.resting or self._operation.waits_for_others:
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
