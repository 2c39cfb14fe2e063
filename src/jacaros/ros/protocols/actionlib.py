"""ROS 1's actions, without input and output: the states of a goal, and what a client makes of what the server says.

The protocol is actionlib's (ROS wiki, "actionlib/DetailedDescription"; ``actionlib_msgs/GoalStatus``): five topics below
the action's name.  It needs nothing but topics, so every backend that reaches a ROS 1 graph can use it.
"""

import itertools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import Any, Protocol

from jacaros.ros.action import GoalStatus
from jacaros.ros.qos import QoS

STATUS_PERIOD = 0.2
"""Seconds between two messages of a server about its goals, as actionlib's servers have it."""
STATUS_KEPT = 5.0
"""Seconds for which a server goes on to tell how a goal ended."""
ENOUGH_NEWS = 5
"""After so many messages about a server's goals, what they do not say is not so: one alone may have overtaken others."""

SENT_AGAIN_AFTER = 1.0
"""Seconds in which a server that runs mentions a goal that it was sent; one that does not has not got it.  Between the two
topics being connected and the first message, a goal can get lost: rospy's publishers, and a bridge's, know a subscriber
before it hears them.  A server that has got it after all ignores the second, for it has the same id."""
OVERTAKEN = "it was lost on its way to the server, which has accepted a newer goal"
REFUSED_AFTER = 1.0
"""Seconds in which a request for cancelling must show in the goal's state: actionlib's servers do not say no."""

STATUS_TYPE, ID_TYPE = "actionlib_msgs/msg/GoalStatusArray", "actionlib_msgs/msg/GoalID"
GOAL_STATUS_TYPE = "actionlib_msgs/msg/GoalStatus"
COMMANDS = QoS(depth=100)
"""For goals and requests for cancelling."""
NEWS = QoS(depth=100)
"""For feedback and results."""
STATUS = QoS(durability="transient_local", depth=1)


class State(IntEnum):
    """States of a goal, ``actionlib_msgs/GoalStatus``."""

    PENDING = 0
    ACTIVE = 1
    PREEMPTED = 2
    SUCCEEDED = 3
    ABORTED = 4
    REJECTED = 5
    PREEMPTING = 6
    RECALLING = 7
    RECALLED = 8
    LOST = 9


ENDS = {
    State.SUCCEEDED: GoalStatus.SUCCEEDED,
    State.PREEMPTED: GoalStatus.CANCELED,
    State.RECALLED: GoalStatus.CANCELED,
    State.ABORTED: GoalStatus.ABORTED,
    State.LOST: GoalStatus.ABORTED,
}
"""What the last states of accepted goals are called in the port."""
UNDER_WAY = frozenset({State.PENDING, State.ACTIVE, State.PREEMPTING, State.RECALLING})
CANCELLING = frozenset({State.PREEMPTING, State.RECALLING, State.PREEMPTED, State.RECALLED})
"""States that tell that a request for cancelling was agreed to."""


def part_type(action: str, part: str) -> str:
    """Name one of the messages that actionlib makes of an action: ``ActionGoal``, ``ActionResult``, ``ActionFeedback``."""
    return f"{action}_{part}"


def time_of(stamp: Any) -> tuple[int, int]:
    """Seconds and nanoseconds of a time, comparable; (0, 0) stands for none."""
    if hasattr(stamp, "nsecs"):
        return (stamp.secs, stamp.nsecs)
    return (stamp.sec, stamp.nanosec)


@dataclass(slots=True)
class SentGoal:
    """What is known of a goal under way.

    Attributes:
        message: what was sent; None for a goal of an earlier run.
        sent: when it was, for the last time.
        heard_of: the server has mentioned it.
        accepted: by the server.
        overtaken: the server has accepted a newer one, and had not heard of this one.
        missing: messages about the server's goals, one after the other, in which it was not mentioned.
        ended: such messages that called it ended, while its result has not come.
        cancelling: when cancelling was asked for, until it is answered.
        unmoved: such messages since then that called it active.
    """

    message: Any
    sent: float
    heard_of: bool = False
    accepted: bool = False
    overtaken: bool = False
    missing: int = 0
    ended: int = 0
    cancelling: float | None = None
    unmoved: int = 0


class Listener(Protocol):
    """Whom `SentGoals` tells what has become of goals, and asks to send."""

    def accepted(self, goal_id: str) -> None:
        """The server has accepted a goal."""

    def rejected(self, goal_id: str, reason: str) -> None:
        """The server has refused a goal."""

    def ended(self, goal_id: str, status: GoalStatus, result: Any, text: str) -> None:
        """A goal is over; *result* is None where the message with it was lost."""

    def lost(self, goal_id: str, how: str) -> None:
        """The server does not know a goal; *how* goes between "the server" and "goal"."""

    def cancel_answered(self, goal_id: str, agreed: bool) -> None:
        """A request for cancelling was agreed to, or not."""

    def wants(self, goal_id: str) -> bool:
        """Whether anybody still wants a goal to begin."""

    def send_again(self, message: Any) -> None:
        """Send a goal once more."""

    def send_cancel(self, goal_id: str) -> None:
        """Ask for cancelling a goal."""


class SentGoals(dict[str, SentGoal]):
    """The goals of a client, the oldest first, by what their server says of them.

    Args:
        listener: is told, and asked.
    """

    def __init__(self, listener: Listener) -> None:
        super().__init__()
        self._listener = listener

    def ask_to_cancel(self, goal_id: str, now: float) -> None:
        """Send a request for cancelling; what comes of it shows in the goal's state."""
        goal = self.get(goal_id)
        if goal is not None and goal.cancelling is None:
            goal.cancelling, goal.unmoved = now, 0
        self._listener.send_cancel(goal_id)

    def lose_unanswered(self) -> None:
        """A server is there after none was: it has never heard of the goals that were not accepted."""
        for goal_id, goal in list(self.items()):
            if not goal.accepted:
                self._listener.lost(goal_id, "went away before it accepted")

    def take_status(self, told: Iterable[tuple[str, int, str]], now: float) -> None:
        """Take what the server says of all its goals: id, state and text of each; *now* in seconds of a steady clock."""
        known = {goal_id: (State(state), text) for goal_id, state, text in told if goal_id in self}
        for goal_id, goal in list(self.items()):
            if goal_id in known:
                goal.missing = 0
                goal.heard_of = True
                self._advance(goal_id, goal, *known[goal_id], now)
                continue
            goal.missing += 1
            if goal.missing < ENOUGH_NEWS:
                continue
            if goal.accepted:
                self._listener.lost(goal_id, "has been started again and does not know")
            elif not goal.heard_of:
                self._see_lost(goal_id, goal, now)

    def take_feedback(self, goal_id: str) -> bool:
        """Note that feedback has come; True when it is of a goal of ours."""
        goal = self.get(goal_id)
        if goal is not None:
            self._accept(goal_id, goal)
        return goal is not None

    def take_result(self, goal_id: str, state: State, result: Any, text: str) -> None:
        """Take the message that tells the end of a goal."""
        goal = self.get(goal_id)
        if goal is None:
            return
        if state is State.REJECTED:
            self._listener.rejected(goal_id, text)
        elif state in ENDS:
            self._accept(goal_id, goal)
            self._listener.ended(goal_id, ENDS[state], result, text)

    def _see_lost(self, goal_id: str, goal: SentGoal, now: float) -> None:
        """A goal seems to be lost on its way: send it again, unless a newer one has taken its place."""
        if now - goal.sent < SENT_AGAIN_AFTER or not self._listener.wants(goal_id):
            return
        # A server that pursues one goal at a time would leave the newer one for the older, or begin it after that.
        if goal.overtaken:
            self.ask_to_cancel(goal_id, now)
            self._listener.ended(goal_id, GoalStatus.CANCELED, None, OVERTAKEN)
        elif not any(newer.heard_of for newer in self._newer_than(goal)):
            goal.sent, goal.missing = now, 0
            self._listener.send_again(goal.message)

    def _newer_than(self, goal: SentGoal) -> Iterator[SentGoal]:
        return itertools.islice(itertools.dropwhile(lambda each: each is not goal, self.values()), 1, None)

    def _advance(self, goal_id: str, goal: SentGoal, state: State, text: str, now: float) -> None:
        if state is State.REJECTED:
            self._listener.rejected(goal_id, text)
            return
        if state not in (State.PENDING, State.RECALLING):
            self._accept(goal_id, goal)
        if goal.cancelling is not None:
            self._see_cancelling(goal_id, goal, goal.cancelling, state, now)
        if state in ENDS:
            goal.ended += 1
            if goal.ended >= ENOUGH_NEWS:  # the result was lost: there is none to wait for
                self._listener.ended(goal_id, ENDS[state], None, text)

    def _accept(self, goal_id: str, goal: SentGoal) -> None:
        if not goal.accepted:
            goal.accepted = True
            for older in itertools.takewhile(lambda each: each is not goal, self.values()):
                older.overtaken = not older.heard_of and not older.accepted
            self._listener.accepted(goal_id)

    def _see_cancelling(self, goal_id: str, goal: SentGoal, asked: float, state: State, now: float) -> None:
        if state in CANCELLING:
            goal.cancelling = None
            self._listener.cancel_answered(goal_id, True)
        elif state is State.ACTIVE:
            goal.unmoved += 1
            if goal.unmoved >= ENOUGH_NEWS and now - asked >= REFUSED_AFTER:
                goal.cancelling = None
                self._listener.cancel_answered(goal_id, False)
