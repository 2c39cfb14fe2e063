"""One goal on the client's side: callers that wait for acceptance, outcome, or the answer to a request to cancel."""

import asyncio
import math
from collections.abc import Awaitable, Callable
from typing import Any, Protocol

from jacaros.ros.action import Outcome
from jacaros.ros.calling import settle
from jacaros.ros.errors import CallTimedOut, ServiceError
from jacaros.ros.waiting import within
from jacaros.runtime.clock import Clock

ENDING = 5.0
"""Seconds that a server has to end a goal after a request to cancel."""


class GoalOwner(Protocol):
    """The action client that a goal belongs to until it has ended."""

    clock: Clock
    name: str

    def ask_to_cancel(self, pending: "PendingGoal") -> None:
        """Send a request to cancel."""

    def abandon(
        self, pending: "PendingGoal", afterwards: Callable[[], Awaitable[object]] | None = None
    ) -> None:
        """Cancel a goal that is no longer needed."""

    def has_left(self, pending: "PendingGoal") -> None:
        """Let newer goals continue: this one has ended, or its server does not cancel it."""


class PendingGoal:
    """A goal on the client's side, a `GoalHandle`. It ends once, for all present and later callers."""

    def __init__(self, sender: GoalOwner, goal_id: str, on_feedback: Callable[[Any], None] | None) -> None:
        self.goal_id = goal_id
        self.on_feedback = on_feedback
        self.acceptance: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self.accepted = False
        self.abandoned = False
        self.end: Outcome | ServiceError | None = None
        self.leaves_by: float | None = None
        """Time of `Clock.elapsed` until which a goal that is being cancelled delays newer goals."""
        self._sender = sender
        self._waiting: list[asyncio.Future[Outcome]] = []
        self._asking: list[asyncio.Future[bool]] = []
        self._followers: list[asyncio.Future[None]] = []

    async def outcome(self, timeout: float | None = None) -> Outcome:
        """Wait for the goal's end."""
        if isinstance(self.end, Outcome):
            return self.end
        if self.end is not None:
            raise self.end.with_traceback(None)
        waiter: asyncio.Future[Outcome] = asyncio.get_running_loop().create_future()
        self._waiting.append(waiter)
        try:
            return await within(self._sender.clock, waiter, timeout)
        except TimeoutError:
            raise CallTimedOut(
                f"goal {self.goal_id} of action {self._sender.name} is still active after {timeout:g} s"
            ) from None
        finally:
            if waiter in self._waiting:
                self._waiting.remove(waiter)

    async def cancel(self, timeout: float | None = None) -> bool:
        """Ask the server to cancel the goal."""
        if isinstance(self.end, Outcome):
            return False
        if self.end is not None:
            raise self.end.with_traceback(None)
        answer: asyncio.Future[bool] = asyncio.get_running_loop().create_future()
        self._asking.append(answer)
        self._sender.ask_to_cancel(self)
        try:
            return await within(self._sender.clock, answer, timeout)
        except TimeoutError:
            raise CallTimedOut(
                f"the server of action {self._sender.name} did not answer within {timeout:g} s "
                f"whether it cancels goal {self.goal_id}"
            ) from None
        finally:
            if answer in self._asking:
                self._asking.remove(answer)

    def abandon(self, afterwards: Callable[[], Awaitable[object]] | None = None) -> None:
        """Cancel the goal and return immediately; the client owns it until it has ended."""
        self._sender.abandon(self, afterwards)

    async def gone(self) -> bool:
        """Wait until a goal that is being cancelled has ended or continues. Return False if that takes too long."""
        if self.leaves_by is None:
            return True
        follower: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self._followers.append(follower)
        try:
            left = self.leaves_by - self._sender.clock.elapsed
            await within(self._sender.clock, follower, None if left == math.inf else left)
        except TimeoutError:
            return False
        finally:
            if follower in self._followers:
                self._followers.remove(follower)
        return True

    def cancel_answered(self, agreed: bool) -> None:
        """Note whether the server has agreed to cancel."""
        for answer in self._asking:
            settle(answer, agreed, None)

    def no_longer_leaves(self) -> None:
        """Let newer goals continue: the goal has ended, or its server does not cancel it."""
        self.leaves_by = None
        for follower in self._followers:
            settle(follower, None, None)

    def finish(self, end: Outcome | ServiceError) -> None:
        """Note the goal's outcome and settle everything that waits for it."""
        if self.end is not None:
            return
        self.end = end
        self._sender.has_left(self)
        problem = None if isinstance(end, Outcome) else end
        settle(self.acceptance, None, problem)
        for waiter in self._waiting:
            settle(waiter, end, problem)
        for answer in self._asking:
            # The server's answer was lost or overtaken; the outcome implies it.
            settle(answer, isinstance(end, Outcome) and end.status == "canceled", problem)


LeavingGoals = dict[str, dict[PendingGoal, None]]
"""Goals of one node that are being cancelled, by action."""
