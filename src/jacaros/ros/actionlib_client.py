"""Action clients of ROS 1 graphs: actionlib's protocol as a `GoalWire`."""

import itertools
from collections.abc import Callable
from functools import partial
from typing import Any, Protocol

from jacaros.ros.action_calling import GoalSender
from jacaros.ros.action_serving import text_of
from jacaros.ros.backend import Publisher, Sample, Subscription
from jacaros.ros.message import MessageFactory
from jacaros.ros.names import result_type
from jacaros.ros.orphans import Orphans
from jacaros.ros.protocols.actionlib import (
    COMMANDS,
    ID_TYPE,
    NEWS,
    STATUS,
    STATUS_PERIOD,
    STATUS_TYPE,
    UNDER_WAY,
    SentGoal,
    SentGoals,
    State,
    part_type,
)
from jacaros.ros.qos import QoS
from jacaros.runtime.clock import Clock, Timer

LOOKING = 0.02
"""Seconds between two checks for a server that a caller waits for."""
QUIET = 4
"""Number of `STATUS_PERIOD` without a message after which the server counts as gone; then `SERVER_LOST_AFTER`
begins."""

_numbers = itertools.count(1)


class ActionTopicsNode(Protocol):
    """The interface of a backend for actions."""

    clock: Clock
    log: Callable[[str], None]
    factory: MessageFactory

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""

    @property
    def orphans(self) -> Orphans:
        """Recognises goals of earlier runs."""

    def publisher(self, topic: str, type_name: str, qos: QoS = ...) -> Publisher:
        """Make a publisher."""

    def subscription(
        self, topic: str, type_name: str, callback: Callable[[Sample], None], qos: QoS = ...
    ) -> Subscription:
        """Call *callback* with every message."""

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Call *hook* when the process ends."""


class ActionlibWire:
    """The five topics of one action, on the client's side.

    Args:
        node: the backend.
        sender: the client.
    """

    def __init__(self, node: ActionTopicsNode, sender: GoalSender) -> None:
        self._node = node
        self._sender = sender
        name, kind = sender.name, sender.type_name
        self._complete = self._heard = self._present = self._closed = False
        self._quiet = 0
        self._timer: Timer | None = None
        self._goal = node.publisher(f"{name}/goal", part_type(kind, "ActionGoal"), COMMANDS)
        self._cancel = node.publisher(f"{name}/cancel", ID_TYPE, COMMANDS)
        empty = partial(node.factory.make, result_type(kind))
        self._goals = SentGoals(sender, empty, self._goal.publish, self._send_cancel)
        self._status = node.subscription(f"{name}/status", STATUS_TYPE, self._take_status, STATUS)
        self._feedback = node.subscription(
            f"{name}/feedback", part_type(kind, "ActionFeedback"), self._take_feedback, NEWS
        )
        self._result = node.subscription(
            f"{name}/result", part_type(kind, "ActionResult"), self._take_result, NEWS
        )
        self._forget_hook = node.add_exit_hook(self._cancel_all)

    @property
    def offered(self) -> bool:
        """Whether there is a server with all five topics connected. Reading it starts the checks."""
        self._look()
        return self._present

    def new_id(self) -> str:
        """Return the id of a new goal."""
        return self._node.orphans.named_id(next(_numbers), self._node.clock.now())

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Send a goal message."""
        now = self._node.clock.now()
        message = self._goal.message(header={"stamp": now}, goal_id={"stamp": now, "id": goal_id}, goal=goal)
        self._goals[goal_id] = SentGoal(message, self._node.clock.elapsed)
        self._goal.publish(message)
        self._look()

    def cancel_goal(self, goal_id: str) -> None:
        """Ask the server to cancel a goal."""
        self._goals.ask_to_cancel(goal_id, self._node.clock.elapsed)

    def adopt_goal(self, goal_id: str) -> None:
        """Follow a goal of an earlier run."""
        self._goals[goal_id] = SentGoal(None, self._node.clock.elapsed, heard_of=True, accepted=True)

    def forget_goal(self, goal_id: str) -> None:
        """Stop reporting a goal: it has ended for this client."""
        self._goals.pop(goal_id, None)

    def close(self) -> None:
        """Leave the five topics."""
        self._closed = True
        self._forget_hook()
        if self._timer is not None:
            self._timer.cancel()
        for end in (self._goal, self._cancel, self._status, self._feedback, self._result):
            end.close()

    def _cancel_all(self) -> None:
        """Exit hook: leave no robot driving towards its goal when the process ends."""
        for goal_id in list(self._goals):
            self._send_cancel(goal_id)

    # The server's presence: connections report no changes, so they are polled while a caller needs to know.

    def _look(self) -> None:
        if self._closed:
            return
        publishers = self._status.publisher_count
        complete = (
            publishers > 0
            and self._feedback.publisher_count > 0
            and self._result.publisher_count > 0
            and self._goal.subscription_count > 0
            and self._cancel.subscription_count > 0
        )
        if complete and not self._complete:
            self._goals.lose_unanswered()
            # A publisher is visible a moment before it knows us, and messages sent meanwhile are lost, even a result.
            self._heard = False
        if publishers == 0:
            self._heard = False
        self._complete = complete
        self._set_present(complete and self._heard)
        if self._timer is None and (self._sender.busy or not self._present):
            delay = STATUS_PERIOD if self._present else LOOKING
            self._timer = self._node.clock.call_later(delay, self._tick)

    def _tick(self) -> None:
        self._timer = None
        self._quiet += 1
        if self._present and self._quiet >= QUIET:
            self._heard = False
        if self._sender.busy:
            self._look()

    def _note_server(self) -> None:
        """Note that a message of the server has arrived."""
        self._quiet = 0
        self._heard = True
        if not self._present:
            self._look()

    def _set_present(self, present: bool) -> None:
        if present != self._present:
            self._present = present
            self._quiet = 0
            self._sender.server_present(present)

    # Messages of the server:

    def _take_status(self, sample: Sample) -> None:
        self._note_server()
        if self._present:  # otherwise a request to cancel would be lost
            listed = sample.message.status_list
            self._sender.goals_under_way(
                each.goal_id.id for each in listed if State(each.status) in UNDER_WAY
            )
        if self._goals:
            told = [(each.goal_id.id, each.status, each.text) for each in sample.message.status_list]
            self._goals.take_status(told, self._node.clock.elapsed)

    def _take_feedback(self, sample: Sample) -> None:
        self._note_server()
        goal_id = sample.message.status.goal_id.id
        if self._goals.take_feedback(goal_id):
            self._sender.feedback(goal_id, sample.message.feedback)

    def _take_result(self, sample: Sample) -> None:
        self._note_server()
        message = sample.message
        goal_id, state = message.status.goal_id.id, State(message.status.status)
        self._goals.take_result(
            goal_id, state, message.result, message.status.text or text_of(message.result)
        )

    def _send_cancel(self, goal_id: str) -> None:
        self._cancel.publish(self._cancel.message(id=goal_id))
