"""Action clients apart from the middleware: goals under way, who waits for them, and servers that go away.

`GoalSender` is a whole action client; a backend gives it a `GoalWire` that sends, and tells it what has come in.
Everything here happens on the loop.
"""

import asyncio
import math
from collections.abc import Awaitable, Callable, Coroutine, Iterable
from contextlib import suppress
from typing import Any, Protocol

from jacaros.clock import Clock, Timer
from jacaros.ros.action import SERVER_LOST_AFTER, Outcome
from jacaros.ros.calling import RETRY, settle
from jacaros.ros.errors import (
    CallFailed,
    CallTimedOut,
    GoalRejected,
    ServerLost,
    ServerUnavailable,
    ServiceError,
)
from jacaros.ros.message import MessageFactory
from jacaros.ros.names import goal_type
from jacaros.ros.orphans import Orphans
from jacaros.ros.pending_goal import ENDING, LeavingGoals, PendingGoal
from jacaros.ros.serving import checked_message
from jacaros.ros.waiting import Absence, Waiting, within


class GoalWire(Protocol):
    """What a middleware does for one action client.

    Nothing here waits.  What comes back is told to the `GoalSender`: `accepted` or `rejected` for each goal sent, then
    `feedback` and `ended`; `cancel_answered` for each `cancel_goal`; `server_present` whenever that changes.
    """

    @property
    def offered(self) -> bool:
        """Whether a server offers the action, as far as is known."""

    def new_id(self) -> str:
        """Make up the id of a new goal."""

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Send a goal message.

        Raises:
            CallFailed: the server there cannot take it; the text says why.
        """

    def cancel_goal(self, goal_id: str) -> None:
        """Ask the server to cancel a goal, accepted or not yet."""

    def adopt_goal(self, goal_id: str) -> None:
        """Follow a goal that was accepted from an earlier run of this node, as if it had been sent here."""

    def forget_goal(self, goal_id: str) -> None:
        """The goal is over for this client: nothing more about it needs to be told."""

    def close(self) -> None:
        """Leave; what was sent just before is still to reach the server."""


class GoalSender:
    """An action client, whatever the middleware.

    Args:
        clock: measures the time-outs.
        log: takes one line about waiting, and about callbacks that failed.
        factory: makes the goal messages.
        name: absolute name of the action.
        type_name: action type in full form.
        leaving: by action, the goals of all clients of the node that were asked to be cancelled and have not ended;
            None: of this client alone.
        orphans: decides about goals of earlier runs; None: they are left alone.
    """

    wire: GoalWire
    """To be set by whoever makes this, before the first goal."""

    def __init__(
        self,
        clock: Clock,
        log: Callable[[str], None],
        factory: MessageFactory,
        name: str,
        type_name: str,
        leaving: LeavingGoals | None = None,
        orphans: Orphans | None = None,
    ) -> None:
        self.clock = clock
        self.name = name
        self.type_name = type_name
        self._log = log
        self._factory = factory
        self._goal_type = goal_type(type_name)
        self._goals: dict[str, PendingGoal] = {}
        self._leaving: LeavingGoals = {} if leaving is None else leaving
        self._orphans = orphans
        self._heard_of_goals = False
        self._abandoning: set[asyncio.Task[None]] = set()
        self._arrivals: list[asyncio.Future[None]] = []
        self._losing: Timer | None = None
        self._absence = Absence()
        self._closed = False

    @property
    def ready(self) -> bool:
        """Whether a server offers the action, as far as is known."""
        return not self._closed and self.wire.offered

    @property
    def busy(self) -> bool:
        """Whether a goal is under way or somebody waits for the server: a wire that has to ask, asks while this is so."""
        return bool(self._goals or self._arrivals)

    def wants(self, goal_id: str) -> bool:
        """Whether somebody still waits for a goal; one that was given up must not be sent again."""
        pending = self._goals.get(goal_id)
        return pending is not None and not pending.abandoned

    def goal(self, **fields: Any) -> Any:
        """Make a goal message."""
        return self._factory.make(self._goal_type, fields)

    async def send(
        self, goal: Any = None, on_feedback: Callable[[Any], None] | None = None, timeout: float | None = None
    ) -> PendingGoal:
        """Send a goal and wait until the server has accepted it."""
        message = checked_message(self._factory, self._goal_type, goal)
        deadline = None if timeout is None else self.clock.elapsed + timeout
        while True:
            await self._server(deadline, timeout)
            waited = await self._predecessors()
            if deadline is not None:
                deadline += waited
            try:
                return await self._attempt(message, on_feedback, deadline, timeout)
            except (
                ServerUnavailable
            ):  # it was seen a moment ago, but has gone, or is not known everywhere yet
                if deadline is not None and self.clock.elapsed + RETRY > deadline:
                    raise self._nobody(timeout) from None
            await self.clock.sleep(RETRY)

    def close(self) -> None:
        """Give the client up: its goals are cancelled, waiting callers fail."""
        if self._closed:
            return
        self._closed = True
        for goal_id in list(self._goals):
            # Also where the server seems to have gone: it may be quiet, and the robot drive on.
            with suppress(ServiceError):  # there is no way to anybody
                self.wire.cancel_goal(goal_id)
        problem = CallFailed(f"the client of action {self.name} was closed")
        for goal_id in list(self._goals):
            self._finish(goal_id, problem)
        for arrival in list(self._arrivals):
            settle(arrival, None, problem)
        self.wire.close()

    def ask_to_cancel(self, pending: PendingGoal) -> None:
        """Send a request for cancelling; `cancel_answered` brings the answer.

        Raises:
            ServiceError: the server cannot be reached.
        """
        self._leaves(pending)
        self.wire.cancel_goal(pending.goal_id)

    def abandon(
        self, pending: PendingGoal, afterwards: Callable[[], Awaitable[object]] | None = None
    ) -> None:
        """Cancel a goal that nobody wants any more: now if it was accepted, else when it is.

        It stays a goal of this client until it has ended: newer goals of the action wait for that.

        Args:
            pending: the goal.
            afterwards: awaited when it has ended.
        """
        if pending.end is not None:
            return
        pending.abandoned = True
        self._leaves(pending)
        if pending.accepted:
            with suppress(ServiceError):  # the server cannot be reached, so that the goal is lost soon
                self.wire.cancel_goal(pending.goal_id)
        self._keep(self._see_off(pending, afterwards))

    def _keep(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._abandoning.add(task)
        task.add_done_callback(self._abandoning.discard)

    def goals_under_way(self, goal_ids: Iterable[str]) -> None:
        """Look for orphans among the goals that the server pursues: only once, among those from before we joined."""
        if self._heard_of_goals or self._orphans is None or self._closed:
            return
        self._heard_of_goals = True
        for goal_id in goal_ids:
            if goal_id not in self._goals and self._orphans.newly_found(goal_id):
                pending = PendingGoal(self, goal_id, None)
                pending.accepted = pending.abandoned = True
                self._goals[goal_id] = pending
                pending.leaves_by = math.inf  # newer goals wait for the decision
                self._leaving.setdefault(self.name, {})[pending] = None
                self.wire.adopt_goal(goal_id)
                self._keep(self._decide(pending, self._orphans))

    async def _decide(self, pending: PendingGoal, orphans: Orphans) -> None:
        if not await orphans.may_cancel(self.name):
            self.has_left(pending)
            self._forget(pending.goal_id)
        elif pending.end is None:
            pending.leaves_by = None
            self.abandon(pending)

    def has_left(self, pending: PendingGoal) -> None:
        """A goal has ended, or its server refuses to cancel it: newer goals wait for it no longer."""
        self._leaving.get(self.name, {}).pop(pending, None)
        pending.no_longer_leaves()

    # What the wire tells:

    def accepted(self, goal_id: str) -> None:
        """The server has accepted a goal."""
        self._sign()
        pending = self._goals.get(goal_id)
        if pending is None or pending.accepted:
            return
        pending.accepted = True
        if pending.abandoned:
            self.wire.cancel_goal(goal_id)
        else:
            settle(pending.acceptance, None, None)

    def rejected(self, goal_id: str, text: str = "") -> None:
        """The server has refused a goal."""
        self._sign()
        because = f": {text}" if text else ""
        self._finish(goal_id, GoalRejected(f"the server of action {self.name} refused the goal{because}"))

    def feedback(self, goal_id: str, message: Any) -> None:
        """Feedback of a goal has come."""
        self._sign()
        pending = self._goals.get(goal_id)
        if pending is None or pending.abandoned or pending.on_feedback is None:
            return
        try:
            pending.on_feedback(message)
        except Exception as problem:  # one bad callback must not stop the news of the others
            self._log(
                f"the feedback callback of action {self.name} failed: {type(problem).__name__}: {problem}"
            )

    def ended(self, goal_id: str, outcome: Outcome) -> None:
        """A goal is over."""
        self._sign()
        self._finish(goal_id, outcome)

    def cancel_answered(self, goal_id: str, agreed: bool) -> None:
        """The server has answered a request for cancelling."""
        self._sign()
        pending = self._goals.get(goal_id)
        if pending is not None:
            if not agreed:
                self.has_left(pending)
            pending.cancel_answered(agreed)

    def fail(self, goal_id: str, problem: ServiceError) -> None:
        """Something between us and the server broke for good: the end of a goal will not be told."""
        self._finish(goal_id, problem)

    def server_present(self, present: bool, same: bool = True) -> None:
        """A server has come or gone.

        Args:
            present: whether one is there now.
            same: the one that is there now may know the goals; False: it is another, which does not.
        """
        if present:
            if not same:
                self._lose("was replaced by another")
            self._sign()
            for arrival in list(self._arrivals):
                settle(arrival, None, None)
        elif self._losing is None and self._goals:
            self._losing = self._expect_loss()

    # Within:

    async def _attempt(
        self,
        message: Any,
        on_feedback: Callable[[Any], None] | None,
        deadline: float | None,
        timeout: float | None,
    ) -> PendingGoal:
        """Send a goal once; raises `ServerUnavailable` when it turns out that nobody is there."""
        pending = PendingGoal(self, self.wire.new_id(), on_feedback)
        self._goals[pending.goal_id] = pending
        try:
            self.wire.send_goal(pending.goal_id, message)
            await within(
                self.clock, pending.acceptance, None if deadline is None else deadline - self.clock.elapsed
            )
        except TimeoutError:
            self.abandon(pending)
            raise CallTimedOut(
                f"the server of action {self.name} did not say within {timeout:g} s whether it accepts the goal"
            ) from None
        except asyncio.CancelledError:
            self.abandon(pending)
            raise
        except ServiceError:
            self._forget(pending.goal_id)
            raise
        return pending

    def _nobody(self, timeout: float | None) -> ServerUnavailable:
        return ServerUnavailable(f"nobody offered {self._described} within {timeout:g} s")

    @property
    def _described(self) -> str:
        return f"action {self.name} ({self.type_name})"

    async def _server(self, deadline: float | None, timeout: float | None) -> None:
        """Wait for the server."""
        if self._closed:
            raise CallFailed(f"the client of action {self.name} was closed")
        if self.wire.offered:
            self._absence.end(self._log, self._described)
            return
        help = "Is the node that offers it running?"
        with Waiting(self.clock, self._log, self._described, help, absence=self._absence):
            while not self.wire.offered:
                arrival: asyncio.Future[None] = asyncio.get_running_loop().create_future()
                self._arrivals.append(arrival)
                try:
                    await within(
                        self.clock, arrival, None if deadline is None else deadline - self.clock.elapsed
                    )
                except TimeoutError:
                    raise self._nobody(timeout) from None
                finally:
                    self._arrivals.remove(arrival)

    def _leaves(self, pending: PendingGoal) -> None:
        if pending.end is None and pending.leaves_by is None:
            pending.leaves_by = self.clock.elapsed + ENDING
            self._leaving.setdefault(self.name, {})[pending] = None

    async def _predecessors(self) -> float:
        """Wait for the ends of cancelled goals of the action, each at most `ENDING` seconds; return the seconds waited.

        A server that takes a newer goal before it has dealt with the request ends the older one as it likes, and one
        that takes no second goal refuses the newer one.
        """
        began = self.clock.elapsed
        for pending in list(self._leaving.get(self.name, ())):
            if not await pending.gone():
                self.has_left(pending)
                self._log(
                    f"warning: action {self.name}: a cancelled goal has not ended within {ENDING:g} s; "
                    "sending the next one all the same"
                )
        return self.clock.elapsed - began

    async def _see_off(
        self, pending: PendingGoal, afterwards: Callable[[], Awaitable[object]] | None
    ) -> None:
        try:
            await pending.outcome(ENDING)
        except CallTimedOut:
            if pending.accepted:
                self._log(
                    f"warning: action {self.name}: an abandoned goal has not ended {ENDING:g} s after it was cancelled; "
                    "the robot may still be moving"
                )
            return
        except (
            ServiceError
        ):  # lost with its server, refused, or its client was closed: nobody is left to tell
            return
        if afterwards is not None:
            await afterwards()

    def _finish(self, goal_id: str, end: Outcome | ServiceError) -> None:
        pending = self._goals.get(goal_id)
        if pending is not None:
            self._forget(goal_id)
            pending.finish(end)

    def _forget(self, goal_id: str) -> None:
        if self._goals.pop(goal_id, None) is not None:
            self.wire.forget_goal(goal_id)
        if not self._goals:
            self._sign()

    def _sign(self) -> None:
        """Something was heard of the server: it is not lost, or not yet if it may have been said before the server went."""
        if self._losing is not None:
            self._losing.cancel()
            self._losing = self._expect_loss() if self._goals and not self.wire.offered else None

    def _expect_loss(self) -> Timer:
        return self.clock.call_later(SERVER_LOST_AFTER, lambda: self._lose("went away"))

    def _lose(self, how: str) -> None:
        if self._losing is not None:
            self._losing.cancel()
            self._losing = None
        for goal_id in list(self._goals):
            text = f"the server of action {self.name} {how} during goal {goal_id}; whether it goes on is not known"
            self._finish(goal_id, ServerLost(text))
