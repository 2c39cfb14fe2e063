"""ROS 1's actions: five topics below the action's name, and the states that a goal goes through.

The protocol is actionlib's (ROS wiki, "actionlib/DetailedDescription"; ``actionlib_msgs/GoalStatus``).  It needs nothing
but topics, so every backend that reaches a ROS 1 graph can use it.
"""

from collections.abc import Callable
from enum import IntEnum
from typing import Any, Protocol

from jacaros.clock import Clock
from jacaros.ros.action import GoalStatus
from jacaros.ros.backend import Publisher, Sample, Subscription
from jacaros.ros.message import MessageFactory
from jacaros.ros.orphans import Orphans
from jacaros.ros.qos import QoS

STATUS_PERIOD = 0.2
"""Seconds between two messages of a server about its goals, as actionlib's servers have it."""
STATUS_KEPT = 5.0
"""Seconds for which a server goes on to tell how a goal ended."""
ENOUGH_NEWS = 5
"""After so many messages about a server's goals, what they do not say is not so: one alone may have overtaken others."""

STATUS_TYPE, ID_TYPE = "actionlib_msgs/msg/GoalStatusArray", "actionlib_msgs/msg/GoalID"
GOAL_STATUS_TYPE = "actionlib_msgs/msg/GoalStatus"
COMMANDS = QoS(depth=100)
"""For goals and requests for cancelling."""
NEWS = QoS(depth=100)
"""For feedback and results."""
STATUS = QoS(durability="transient_local", depth=1)


class ActionTopicsNode(Protocol):
    """What actions need of a backend."""

    clock: Clock
    log: Callable[[str], None]
    factory: MessageFactory

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""

    @property
    def orphans(self) -> Orphans:
        """What recognises goals of earlier runs."""

    def publisher(self, topic: str, type_name: str, qos: QoS = ...) -> Publisher:
        """Make a publisher."""

    def subscription(
        self, topic: str, type_name: str, callback: Callable[[Sample], None], qos: QoS = ...
    ) -> Subscription:
        """Have *callback* called for every message."""

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Have *hook* called when the process stops."""


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
