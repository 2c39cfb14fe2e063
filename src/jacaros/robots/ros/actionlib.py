"""Actions of ROS 1 graphs: actionlib's protocol as a `GoalWire` of clients, and around the `ServedGoals` of servers."""

import itertools
import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from jacaros.robots.ros.action import (
    ActionPolicy,
    ExecuteCallback,
    GoalOutcome,
    GoalStatus,
    ServedGoals,
    text_of,
)
from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.names import result_type
from jacaros.robots.ros.node import Node, Sample
from jacaros.robots.ros.protocols import actionlib as protocol
from jacaros.robots.ros.protocols.actionlib import GoalState, SentGoal, SentGoals, part_type
from jacaros.runtime.clock import Timer

LOOKING = 0.02
"""Seconds between two checks for a server that a caller waits for."""
QUIET = 4
"""Number of `STATUS_PERIOD` without a message after which the server counts as gone; then `SERVER_LOST_AFTER`
begins."""

_numbers = itertools.count(1)


class ActionlibWire:
    """The five topics of one action, on the client's side.

    Args:
        node: the backend.
        sender: the client.
    """

    def __init__(self, node: Node, sender: ActionClient) -> None:
        self._node = node
        self._sender = sender
        name, kind = sender.name, sender.type_name
        self._complete = self._heard = self._present = self._closed = False
        self._quiet = 0
        self._timer: Timer | None = None
        self._goal = node.publisher(f"{name}/goal", part_type(kind, "ActionGoal"), protocol.COMMANDS)
        self._cancel = node.publisher(f"{name}/cancel", protocol.ID_TYPE, protocol.COMMANDS)
        empty = partial(node.factory.make, result_type(kind))
        self._goals = SentGoals(sender, empty, self._goal.publish, self._send_cancel)
        self._status = node.subscription(
            f"{name}/status", protocol.STATUS_TYPE, self._take_status, protocol.STATUS
        )
        self._feedback = node.subscription(
            f"{name}/feedback", part_type(kind, "ActionFeedback"), self._take_feedback, protocol.NEWS
        )
        self._result = node.subscription(
            f"{name}/result", part_type(kind, "ActionResult"), self._take_result, protocol.NEWS
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
            delay = protocol.STATUS_PERIOD if self._present else LOOKING
            self._timer = self._node.clock.call_later(delay, self._tick)

    def _tick(self) -> None:
        self._timer = None
        self._quiet += 1
        if self._present and self._quiet >= QUIET:
            self._heard = False
        if self._sender.busy:
            self._look()

    def _note_server(self) -> None:
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
                each.goal_id.id for each in listed if GoalState(each.status) in protocol.UNDER_WAY
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
        goal_id, state = message.status.goal_id.id, GoalState(message.status.status)
        self._goals.take_result(
            goal_id, state, message.result, message.status.text or text_of(message.result)
        )

    def _send_cancel(self, goal_id: str) -> None:
        self._cancel.publish(self._cancel.message(id=goal_id))


NO_TIME = (0, 0)
AFTER_FEEDBACK = 0.01
"""Seconds between the last feedback and the result: they use two topics, and the result must not arrive first."""
OUTDATED = "cancelled by a request for all goals up to its time"


@dataclass(slots=True)
class _Goal:
    """A goal that is published to clients.

    Attributes:
        goal_id: its id.
        stamp: when it was sent, according to the client.
        state: its state.
        text: text of the state.
        told_until: when it is removed from the list; None while it is active.
        status: the ``actionlib_msgs/GoalStatus`` message of this state, once it was made.
        feedback_at: time of the last feedback, on `Clock.elapsed`.
    """

    goal_id: str
    stamp: Any
    state: GoalState
    text: str = ""
    told_until: float | None = None
    status: Any = None
    feedback_at: float = -math.inf

    def change(self, state: GoalState, text: str = "") -> None:
        """Change the state."""
        self.state, self.text, self.status = state, text, None


class ActionlibServer:
    """An action server.

    Args:
        node: the backend.
        name: absolute name of the action.
        type_name: action type in full form.
        execute: runs one goal.
        policy: how to treat goals.
    """

    def __init__(
        self, node: Node, name: str, type_name: str, execute: ExecuteCallback, policy: ActionPolicy
    ) -> None:
        self.name = name
        self._node = node
        self._result_type = result_type(type_name)
        self._served = ServedGoals(node.clock, node.factory, name, type_name, execute, policy, node.log)
        self._goals: dict[str, _Goal] = {}
        self._ending: dict[str, Callable[[], None]] = {}
        """Goals whose results wait until their feedback is on its way."""
        self._cancelled_until = NO_TIME
        self._count = 0
        self._closed = False
        self._status = node.publisher(f"{name}/status", protocol.STATUS_TYPE, protocol.STATUS)
        self._feedback = node.publisher(
            f"{name}/feedback", part_type(type_name, "ActionFeedback"), protocol.NEWS
        )
        self._result = node.publisher(f"{name}/result", part_type(type_name, "ActionResult"), protocol.NEWS)
        self._goal = node.subscription(
            f"{name}/goal", part_type(type_name, "ActionGoal"), self._take_goal, protocol.COMMANDS
        )
        self._cancel = node.subscription(
            f"{name}/cancel", protocol.ID_TYPE, self._take_cancel, protocol.COMMANDS
        )
        self._timer: Timer | None = None
        self._tell_regularly()

    @property
    def abandoned(self) -> bool:
        """Whether no node listens to the feedback."""
        return self._feedback.subscription_count == 0

    def close(self) -> None:
        """Stop offering the action; active goals are aborted."""
        if self._closed:
            return
        self._served.close()
        for finish in list(self._ending.values()):
            finish()
        self._leave()

    def abandon(self) -> None:
        """Stop the active goals and leave without informing clients, which cannot be reached."""
        if not self._closed:
            self._served.abandon()
            self._ending.clear()
            self._leave()

    def _leave(self) -> None:
        self._closed = True
        if self._timer is not None:
            self._timer.cancel()
        for end in (self._goal, self._cancel, self._status, self._feedback, self._result):
            end.close()

    # Requests of clients:

    def _take_goal(self, sample: Sample) -> None:
        message = sample.message
        goal_id = message.goal_id.id or self._new_id()
        known = self._goals.get(goal_id)
        if known is not None:
            if known.state is GoalState.RECALLING:  # the request to cancel has overtaken the goal
                self._finish(known, GoalState.RECALLED, "cancelled before it began")
            return
        goal = self._goals[goal_id] = _Goal(goal_id, message.goal_id.stamp, GoalState.PENDING)
        if NO_TIME < protocol.time_of(goal.stamp) <= self._cancelled_until:
            self._finish(goal, GoalState.RECALLED, OUTDATED)
            return
        refusal = self._served.judge(message.goal)
        if refusal is not None:
            self._finish(goal, GoalState.REJECTED, refusal)
            return
        goal.change(GoalState.ACTIVE)
        self._served.begin(
            goal_id, message.goal, partial(self._send_feedback, goal), partial(self._end, goal)
        )
        self._report()

    def _new_id(self) -> str:
        """Return an id for a goal that came without one."""
        self._count += 1
        return f"{self.name}-{self._count}-{self._node.clock.now():.9f}"

    def _take_cancel(self, sample: Sample) -> None:
        """Handle a request to cancel one goal, all goals up to a time, or, with neither given, all goals."""
        wanted, until = sample.message.id, protocol.time_of(sample.message.stamp)
        everything = not wanted and until == NO_TIME
        for goal_id, goal in list(self._goals.items()):
            in_time = until != NO_TIME and protocol.time_of(goal.stamp) <= until
            if (everything or goal_id == wanted or in_time) and self._served.cancel(goal_id):
                goal.change(GoalState.PREEMPTING)
        if wanted and wanted not in self._goals:
            self._goals[wanted] = _Goal(
                wanted, sample.message.stamp, GoalState.RECALLING, told_until=self._later()
            )
        self._cancelled_until = max(self._cancelled_until, until)
        self._report()

    # Messages to clients:

    def _send_feedback(self, goal: _Goal, feedback: Any) -> None:
        goal.feedback_at = self._node.clock.elapsed
        self._feedback.publish(
            self._feedback.message(
                header={"stamp": self._node.clock.now()}, status=self._status_of(goal), feedback=feedback
            )
        )

    def _end(self, goal: _Goal, outcome: GoalOutcome) -> None:
        """Send the outcome of an accepted goal."""
        states = {
            GoalStatus.SUCCEEDED: GoalState.SUCCEEDED,
            GoalStatus.CANCELED: GoalState.PREEMPTED,
            GoalStatus.ABORTED: GoalState.ABORTED,
        }

        def finish() -> None:
            if self._ending.pop(goal.goal_id, None) is not None:
                self._finish(goal, states[outcome.status], outcome.text, outcome.result)

        self._ending[goal.goal_id] = finish
        wait = goal.feedback_at + AFTER_FEEDBACK - self._node.clock.elapsed
        if wait > 0.0:
            self._node.clock.call_later(wait, finish)
        else:
            finish()

    def _finish(self, goal: _Goal, state: GoalState, text: str, result: Any = None) -> None:
        goal.change(state, text)
        goal.told_until = self._later()
        if self._closed:
            return
        given = result if result is not None else self._node.factory.make(self._result_type)
        self._result.publish(
            self._result.message(
                header={"stamp": self._node.clock.now()}, status=self._status_of(goal), result=given
            )
        )
        self._report()

    def _tell_regularly(self) -> None:
        now = self._node.clock.elapsed
        over = [goal_id for goal_id, goal in self._goals.items() if (goal.told_until or now) < now]
        for goal_id in over:
            del self._goals[goal_id]
        self._report()
        self._timer = self._node.clock.call_later(protocol.STATUS_PERIOD, self._tell_regularly)

    def _report(self) -> None:
        if not self._closed:
            self._status.publish(
                self._status.message(
                    header={"stamp": self._node.clock.now()},
                    status_list=[self._status_of(goal) for goal in self._goals.values()],
                )
            )

    def _status_of(self, goal: _Goal) -> Any:
        if goal.status is None:
            goal.status = self._node.factory.make(
                protocol.GOAL_STATUS_TYPE,
                {
                    "goal_id": {"id": goal.goal_id, "stamp": goal.stamp},
                    "status": goal.state.value,
                    "text": goal.text,
                },
            )
        return goal.status

    def _later(self) -> float:
        return self._node.clock.elapsed + protocol.STATUS_KEPT
