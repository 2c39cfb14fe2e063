"""Actions of the middleware, as client and server: long-running goals with feedback that can be cancelled.

Modelled on ROS 2's actions (design article "Actions") and on ROS 1's actionlib, whose states are mapped to the same
three outcomes. Everything here happens on the loop of the backend's clock.
"""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Protocol


class GoalStatus(StrEnum):
    """How a goal ended.

    ROS 2's numbers are 4, 5 and 6; on ROS 1 ``canceled`` stands for PREEMPTED and RECALLED, ``aborted`` for ABORTED.
    A rejected goal (ROS 2: not accepted; ROS 1: REJECTED) has no status: `ActionClient.send` raises `GoalRejected`.
    """

    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"


@dataclass(frozen=True, slots=True)
class Outcome:
    """The outcome of a goal.

    Attributes:
        status: how it ended.
        result: the result message; one with default values if the server sent none.
        text: the server's text (ROS 1's status text, a field ``error_msg`` or ``message``), or "".
    """

    status: GoalStatus
    result: Any
    text: str = ""


class GoalHandle(Protocol):
    """A goal that its server has accepted, seen by the client."""

    @property
    def goal_id(self) -> str:
        """Id of the goal in the graph."""

    async def outcome(self, timeout: float | None = None) -> Outcome:
        """Wait for the goal to end; any number of callers may wait, also after the end.

        Raises:
            CallTimedOut: the goal is still active after *timeout* seconds of the clock; it is not cancelled.
            ServerLost: the server disappeared, so the outcome will never be known (`SERVER_LOST_AFTER`).
        """

    async def cancel(self, timeout: float | None = None) -> bool:
        """Ask the server to cancel the goal. Return True if it agreed, False if it refused or the goal had ended.

        The goal has ended only when `outcome` returns.

        Raises:
            CallTimedOut: the server did not answer in time.
            ServerLost: the server disappeared.
        """

    def abandon(self, afterwards: Callable[[], Awaitable[object]] | None = None) -> None:
        """Cancel the goal and return immediately.

        Its client owns the goal until it has ended, and logs a warning if that takes more than 5 s.

        Args:
            afterwards: awaited when the goal has ended.
        """


class ActionClient(Protocol):
    """Sends goals to an action server."""

    @property
    def name(self) -> str:
        """Absolute name of the action."""

    @property
    def ready(self) -> bool:
        """Whether a server offers the action, as far as is known."""

    def goal(self, **fields: Any) -> Any:
        """Make a goal message; see `Backend.message`."""

    async def send(
        self, goal: Any = None, on_feedback: Callable[[Any], None] | None = None, timeout: float | None = None
    ) -> GoalHandle:
        """Send a goal and wait until the server has accepted it.

        Goals of this node that are being cancelled come first: the goal is sent when they have ended, at most 5 s
        after each request. That time does not count towards *timeout*.

        Args:
            goal: a goal message, a mapping of its fields, or None for the defaults.
            on_feedback: called on the loop with each feedback message of this goal, until its end.
            timeout: seconds to wait for the server and for its acceptance, in total; None: no limit.

        Raises:
            MessageMismatch: the goal does not match the type definition.
            GoalRejected: the server rejected it.
            ServerUnavailable: no server offered the action in time.
            CallTimedOut: the server neither accepted nor rejected the goal in time; if it accepts later, the goal is
                cancelled.

        Cancelling this coroutine cancels the goal if the server accepts it.
        """

    def close(self) -> None:
        """Close the client: its goals are cancelled if the server can be reached, and waiting callers fail."""


class ServerGoal(Protocol):
    """A goal that a server runs, seen by the server."""

    @property
    def goal_id(self) -> str:
        """Id of the goal in the graph."""

    @property
    def request(self) -> Any:
        """The goal message."""

    @property
    def cancel_requested(self) -> bool:
        """Whether the client requested cancelling and was not refused."""

    def feedback(self, message: Any = None, /, **fields: Any) -> None:
        """Send feedback to the client: a feedback message, a mapping, or keywords.

        Raises:
            MessageMismatch: it does not match the type definition.
        """


class Abort(Exception):
    """Raise it in the code of a goal to end the goal as aborted.

    Args:
        text: the reason; it is copied to the result's ``error_msg`` if that field exists and is empty.
        result: result message or mapping of its fields; None for the defaults.
    """

    def __init__(self, text: str = "", result: Any = None) -> None:
        super().__init__(text)
        self.text = text
        self.result = result


Execute = Callable[[ServerGoal], Awaitable[Any]]
"""Runs one goal, as a task of its own.

It returns the result of a goal that succeeded (result message, mapping of its fields, None for the defaults). `Abort`
ends the goal as aborted, and so does any other exception, which is also logged. When a request to cancel was
accepted, or a newer goal pre-empts this one, ``CancelledError`` is raised in it; what it then raises or returns is
the outcome: canceled after a request, `ActionPolicy.overtaken` after pre-emption. Stop motion in its ``finally``.
"""

Accept = Callable[[Any], str | None]
"""Takes a goal message; returns None to accept it, or the reason for rejecting it."""


@dataclass(frozen=True, slots=True)
class ActionPolicy:
    """How a server treats goals.

    Attributes:
        accept: decides whether to accept a goal; None accepts all.
        may_cancel: decides whether to accept a request to cancel; None always does.
        preempt: a new goal pre-empts the active one (whose text is ``preempted by a newer goal``), as in Nav2's
            ``SimpleActionServer``; False runs any number of goals in parallel.
        overtaken: status of a pre-empted goal: aborted as in Nav2, or cancelled as in actionlib's
            ``SimpleActionServer``.
    """

    accept: Accept | None = None
    may_cancel: Callable[[ServerGoal], bool] | None = None
    preempt: bool = False
    overtaken: GoalStatus = GoalStatus.ABORTED


class ActionServer(Protocol):
    """Offers an action."""

    @property
    def name(self) -> str:
        """Absolute name of the action."""

    def close(self) -> None:
        """Stop offering the action; active goals are aborted with the text ``the server was closed``."""


SERVER_LOST_AFTER = 3.0
"""Seconds without any sign of the server after which an active goal fails with `ServerLost`."""
