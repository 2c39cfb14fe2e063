"""Actions of the middleware, both ways: goals that take their time, tell how far they are, and can be cancelled.

Modelled on ROS 2's actions (design article "Actions") and on ROS 1's actionlib, whose states are mapped to the same three
outcomes.  Everything here happens on the loop of the backend's clock.
"""

from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Protocol


class GoalStatus(StrEnum):
    """What became of a goal.

    ROS 2's numbers are 4, 5 and 6; on ROS 1 ``canceled`` stands for PREEMPTED and RECALLED, ``aborted`` for ABORTED.
    A goal that was refused (ROS 2: not accepted; ROS 1: REJECTED) has no status: `ActionClient.send` raises `GoalRejected`.
    """

    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"


@dataclass(frozen=True, slots=True)
class Outcome:
    """The end of a goal.

    Attributes:
        status: how it ended.
        result: the result message; with its defaults when the server gave none.
        text: what the server said about it in words (ROS 1's status text, a field ``error_msg`` or ``message``), or "".
    """

    status: GoalStatus
    result: Any
    text: str = ""


class GoalHandle(Protocol):
    """A goal that its server has accepted, on the client's side."""

    @property
    def goal_id(self) -> str:
        """Name of the goal in the graph."""

    async def outcome(self, timeout: float | None = None) -> Outcome:
        """Wait for the goal's end; any number of callers may wait, also after the end.

        Raises:
            CallTimedOut: the goal is still under way after *timeout* seconds of the clock; it is not cancelled by that.
            ServerLost: the server went away, so that the end will never be told (`SERVER_LOST_AFTER`).
        """

    async def cancel(self, timeout: float | None = None) -> bool:
        """Ask the server to cancel the goal; True when it agreed, False when it refused or the goal was over.

        The goal is over only when `outcome` says so.

        Raises:
            CallTimedOut: the server did not answer in time.
            ServerLost: there is no server any more.
        """

    def abandon(self, afterwards: Callable[[], Awaitable[object]] | None = None) -> None:
        """Cancel the goal and return immediately.

        Its client owns the goal until it has ended, and logs a warning when that takes more than 5 s.

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

        Goals of this node that were asked to be cancelled go first: the goal is sent when they have ended, at the latest
        5 s after each was asked.  That time does not count for *timeout*.

        Args:
            goal: a goal message, or a mapping of its fields, or None for the defaults.
            on_feedback: called on the loop with each feedback message of this goal, until its end.
            timeout: seconds for waiting for the server and for its acceptance together; None waits for ever.

        Raises:
            MessageMismatch: the goal does not fit the definition.
            GoalRejected: the server refused it.
            ServerUnavailable: nobody offered the action in time.
            CallTimedOut: the server did not say in time whether it accepts; the goal is cancelled as soon as it does.

        Cancelling this coroutine cancels the goal, should the server accept it.
        """

    def close(self) -> None:
        """Give the client up: its goals are cancelled as far as the server can be reached, waiting callers fail."""


class ServerGoal(Protocol):
    """A goal that a server carries out, on the server's side."""

    @property
    def goal_id(self) -> str:
        """Name of the goal in the graph."""

    @property
    def request(self) -> Any:
        """The goal message."""

    @property
    def cancel_requested(self) -> bool:
        """Whether the client asked for cancelling and was not refused."""

    def feedback(self, message: Any = None, /, **fields: Any) -> None:
        """Tell the client how far the goal is: a feedback message, or a mapping, or keywords.

        Raises:
            MessageMismatch: it does not fit the definition.
        """


class Abort(Exception):
    """Raised by the code that carries out a goal: it ends as aborted.

    Args:
        text: why, in words; it goes into the result's ``error_msg`` where there is such a field and none was given.
        result: result message or mapping of its fields; None for the defaults.
    """

    def __init__(self, text: str = "", result: Any = None) -> None:
        super().__init__(text)
        self.text = text
        self.result = result


Execute = Callable[[ServerGoal], Awaitable[Any]]
"""Carries out one goal, as a task of its own.

What it gives (result message, mapping of its fields, None for the defaults) is the result of a goal that succeeded;
`Abort` ends it as aborted, any other exception as well and is logged.  When cancelling was requested and accepted, or a
newer goal took over, ``CancelledError`` is thrown into it, and what it raises or gives then is the end: cancelled for a
request, `ActionPolicy.overtaken` for a newer goal.  Its ``finally`` is where motion is stopped.
"""

Accept = Callable[[Any], str | None]
"""Takes a goal message; gives None to accept it, or the reason for refusing it."""


@dataclass(frozen=True, slots=True)
class ActionPolicy:
    """How a server treats goals.

    Attributes:
        accept: judges goals; None accepts all.
        may_cancel: judges a request for cancelling; None agrees always.
        preempt: a new goal takes over from the one under way (whose text is ``preempted by a newer goal``), as under
            Nav2's ``SimpleActionServer``; False carries out any number of goals side by side.
        overtaken: how a goal ends from which a new one has taken over: aborted as under Nav2, or cancelled as under
            actionlib's ``SimpleActionServer``.
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
        """Stop to offer the action; goals under way are aborted with the text ``the server was closed``."""


SERVER_LOST_AFTER = 3.0
"""Seconds without any sign of the server after which a goal under way is given up with `ServerLost`."""

GoalFields = Mapping[str, Any]
