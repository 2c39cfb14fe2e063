"""ROS 1's actions, without input and output: the states of a goal, and how a client interprets status messages.

The protocol is actionlib's (ROS wiki, "actionlib/DetailedDescription"; ``actionlib_msgs/GoalStatus``): five topics
below the action's name. It needs only topics, so every backend that reaches a ROS 1 graph can use it.
"""

import itertools
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from jacaros.robots.ros.action import GoalOutcome, GoalStatus
from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.errors import ServerLost
from jacaros.robots.ros.qos import QoS

STATUS_PERIOD = 0.2
"""Seconds between two status messages of a server, as in actionlib's servers."""
STATUS_KEPT = 5.0
"""Seconds for which a server keeps reporting how a goal ended."""
ENOUGH_NEWS = 5
"""Number of status messages after which missing information counts as absent: a single one may have overtaken
others."""

SENT_AGAIN_AFTER = 1.0
"""Seconds within which a running server mentions a goal that it received; otherwise the goal is sent again. Between
the connection of the two topics and the first message a goal can get lost: rospy's publishers, and a bridge's, know a
subscriber before it receives from them. A server that did receive the goal ignores the second one, which has the same
id."""
OVERTAKEN = "the goal was lost on its way to the server, which has accepted a newer one"
REFUSED_AFTER = 1.0
"""Seconds within which a request to cancel must show in the goal's state: actionlib's servers send no refusal."""

STATUS_TYPE, ID_TYPE = "actionlib_msgs/msg/GoalStatusArray", "actionlib_msgs/msg/GoalID"
GOAL_STATUS_TYPE = "actionlib_msgs/msg/GoalStatus"
COMMANDS = QoS(depth=100)
"""For goals and requests to cancel."""
NEWS = QoS(depth=100)
"""For feedback and results."""
STATUS = QoS(durability="transient_local", depth=1)


class GoalState(IntEnum):
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
    GoalState.SUCCEEDED: GoalStatus.SUCCEEDED,
    GoalState.PREEMPTED: GoalStatus.CANCELED,
    GoalState.RECALLED: GoalStatus.CANCELED,
    GoalState.ABORTED: GoalStatus.ABORTED,
    GoalState.LOST: GoalStatus.ABORTED,
}
"""Statuses in the port of the final states of accepted goals."""
UNDER_WAY = frozenset({GoalState.PENDING, GoalState.ACTIVE, GoalState.PREEMPTING, GoalState.RECALLING})
CANCELLING = frozenset({GoalState.PREEMPTING, GoalState.RECALLING, GoalState.PREEMPTED, GoalState.RECALLED})
"""States that show that a request to cancel was accepted."""


def part_type(action: str, part: str) -> str:
    """Return the name of one of actionlib's messages of an action: ``ActionGoal``, ``ActionResult``,
    ``ActionFeedback``."""
    return f"{action}_{part}"


def time_of(stamp: Any) -> tuple[int, int]:
    """Return seconds and nanoseconds of a time, comparable; (0, 0) stands for none."""
    if hasattr(stamp, "nsecs"):
        return (stamp.secs, stamp.nsecs)
    return (stamp.sec, stamp.nanosec)


@dataclass(slots=True)
class SentGoal:
    """The state of an active goal.

    Attributes:
        message: the message that was sent; None for a goal of an earlier run.
        sent: when it was last sent.
        heard_of: whether the server has mentioned it.
        accepted: whether the server has accepted it.
        overtaken: whether the server has accepted a newer goal without mentioning this one.
        missing: number of consecutive status messages that did not mention it.
        ended: number of such messages that reported it as ended, while its result has not arrived.
        cancelling: when cancelling was requested, until the answer.
        unmoved: number of such messages since then that reported it as active.
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


class SentGoals(dict[str, SentGoal]):
    """The goals of a client, the oldest first, tracked by the status messages of their server.

    Args:
        sender: is informed of what becomes of them.
        make_result: makes an empty result, for a goal whose own was lost.
        send: sends the message of a goal once more.
        cancel: sends a request to cancel a goal.
    """

    def __init__(
        self,
        sender: ActionClient,
        make_result: Callable[[], Any],
        send: Callable[[Any], None],
        cancel: Callable[[str], None],
    ) -> None:
        super().__init__()
        self._sender = sender
        self._make_result = make_result
        self._send = send
        self._cancel = cancel

    def ask_to_cancel(self, goal_id: str, now: float) -> None:
        """Send a request to cancel; the answer shows in the goal's state."""
        goal = self.get(goal_id)
        if goal is not None and goal.cancelling is None:
            goal.cancelling, goal.unmoved = now, 0
        self._cancel(goal_id)

    def lose_unanswered(self) -> None:
        """Lose the goals that were not accepted: a new server has never received them."""
        for goal_id, goal in list(self.items()):
            if not goal.accepted:
                self._lose(goal_id, "went away before it accepted")

    def take_status(self, told: Iterable[tuple[str, int, str]], now: float) -> None:
        """Handle a status message: id, state and text of each goal; *now* in seconds of a monotonic clock."""
        known = {goal_id: (GoalState(state), text) for goal_id, state, text in told if goal_id in self}
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
                self._lose(goal_id, "was restarted and does not know")
            elif not goal.heard_of:
                self._see_lost(goal_id, goal, now)

    def take_feedback(self, goal_id: str) -> bool:
        """Note that feedback has arrived. Return whether it is for one of our goals."""
        goal = self.get(goal_id)
        if goal is not None:
            self._accept(goal_id, goal)
        return goal is not None

    def take_result(self, goal_id: str, state: GoalState, result: Any, text: str) -> None:
        """Handle the result message of a goal."""
        goal = self.get(goal_id)
        if goal is None:
            return
        if state is GoalState.REJECTED:
            self._sender.rejected(goal_id, text)
        elif state in ENDS:
            self._accept(goal_id, goal)
            self._end(goal_id, ENDS[state], result, text)

    def _end(self, goal_id: str, status: GoalStatus, result: Any, text: str) -> None:
        given = self._make_result() if result is None else result
        self._sender.ended(goal_id, GoalOutcome(status, given, text))

    def _lose(self, goal_id: str, how: str) -> None:
        self._sender.fail(
            goal_id, ServerLost(f"the server of action {self._sender.name} {how} goal {goal_id}")
        )

    def _see_lost(self, goal_id: str, goal: SentGoal, now: float) -> None:
        """Handle a goal that seems to be lost on its way: send it again, unless a newer one has replaced it."""
        if now - goal.sent < SENT_AGAIN_AFTER or not self._sender.wants(goal_id):
            return
        # A server with a single goal would replace the newer goal by the older, or begin the older after it.
        if goal.overtaken:
            self.ask_to_cancel(goal_id, now)
            self._end(goal_id, GoalStatus.CANCELED, None, OVERTAKEN)
        elif not any(newer.heard_of for newer in self._newer_than(goal)):
            goal.sent, goal.missing = now, 0
            self._send(goal.message)

    def _newer_than(self, goal: SentGoal) -> Iterator[SentGoal]:
        return itertools.islice(itertools.dropwhile(lambda each: each is not goal, self.values()), 1, None)

    def _advance(self, goal_id: str, goal: SentGoal, state: GoalState, text: str, now: float) -> None:
        if state is GoalState.REJECTED:
            self._sender.rejected(goal_id, text)
            return
        if state not in (GoalState.PENDING, GoalState.RECALLING):
            self._accept(goal_id, goal)
        if goal.cancelling is not None:
            self._see_cancelling(goal_id, goal, goal.cancelling, state, now)
        if state in ENDS:
            goal.ended += 1
            if goal.ended >= ENOUGH_NEWS:  # the result was lost, so do not wait for it
                self._end(goal_id, ENDS[state], None, text)

    def _accept(self, goal_id: str, goal: SentGoal) -> None:
        if not goal.accepted:
            goal.accepted = True
            for older in itertools.takewhile(lambda each: each is not goal, self.values()):
                older.overtaken = not older.heard_of and not older.accepted
            self._sender.accepted(goal_id)

    def _see_cancelling(
        self, goal_id: str, goal: SentGoal, asked: float, state: GoalState, now: float
    ) -> None:
        if state in CANCELLING:
            goal.cancelling = None
            self._sender.cancel_answered(goal_id, True)
        elif state is GoalState.ACTIVE:
            goal.unmoved += 1
            if goal.unmoved >= ENOUGH_NEWS and now - asked >= REFUSED_AFTER:
                goal.cancelling = None
                self._sender.cancel_answered(goal_id, False)
