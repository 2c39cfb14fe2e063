"""Action servers in ROS 1 graphs: actionlib's protocol around `ServedGoals`."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from typing import Any

from jacaros.ros.action import ActionPolicy, Execute, GoalStatus, Outcome, ServedGoals
from jacaros.ros.actionlib_client import ActionTopicsNode
from jacaros.ros.names import result_type
from jacaros.ros.node import Sample
from jacaros.ros.protocols.actionlib import (
    COMMANDS,
    GOAL_STATUS_TYPE,
    ID_TYPE,
    NEWS,
    STATUS,
    STATUS_KEPT,
    STATUS_PERIOD,
    STATUS_TYPE,
    State,
    part_type,
    time_of,
)
from jacaros.runtime.clock import Timer

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
    state: State
    text: str = ""
    told_until: float | None = None
    status: Any = None
    feedback_at: float = -math.inf

    def change(self, state: State, text: str = "") -> None:
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
        self, node: ActionTopicsNode, name: str, type_name: str, execute: Execute, policy: ActionPolicy
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
        self._status = node.publisher(f"{name}/status", STATUS_TYPE, STATUS)
        self._feedback = node.publisher(f"{name}/feedback", part_type(type_name, "ActionFeedback"), NEWS)
        self._result = node.publisher(f"{name}/result", part_type(type_name, "ActionResult"), NEWS)
        self._goal = node.subscription(
            f"{name}/goal", part_type(type_name, "ActionGoal"), self._take_goal, COMMANDS
        )
        self._cancel = node.subscription(f"{name}/cancel", ID_TYPE, self._take_cancel, COMMANDS)
        self._timer: Timer | None = None
        self._tell_regularly()

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
            if known.state is State.RECALLING:  # the request to cancel has overtaken the goal
                self._finish(known, State.RECALLED, "cancelled before it began")
            return
        goal = self._goals[goal_id] = _Goal(goal_id, message.goal_id.stamp, State.PENDING)
        if NO_TIME < time_of(goal.stamp) <= self._cancelled_until:
            self._finish(goal, State.RECALLED, OUTDATED)
            return
        refusal = self._served.judge(message.goal)
        if refusal is not None:
            self._finish(goal, State.REJECTED, refusal)
            return
        goal.change(State.ACTIVE)
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
        wanted, until = sample.message.id, time_of(sample.message.stamp)
        everything = not wanted and until == NO_TIME
        for goal_id, goal in list(self._goals.items()):
            in_time = until != NO_TIME and time_of(goal.stamp) <= until
            if (everything or goal_id == wanted or in_time) and self._served.cancel(goal_id):
                goal.change(State.PREEMPTING)
        if wanted and wanted not in self._goals:
            self._goals[wanted] = _Goal(
                wanted, sample.message.stamp, State.RECALLING, told_until=self._later()
            )
        self._cancelled_until = max(self._cancelled_until, until)
        self._report()

    # Messages to clients:

    def _send_feedback(self, goal: _Goal, feedback: Any) -> None:
        """Send feedback of a goal."""
        goal.feedback_at = self._node.clock.elapsed
        self._feedback.publish(
            self._feedback.message(
                header={"stamp": self._node.clock.now()}, status=self._status_of(goal), feedback=feedback
            )
        )

    def _end(self, goal: _Goal, outcome: Outcome) -> None:
        """Send the outcome of an accepted goal."""
        states = {
            GoalStatus.SUCCEEDED: State.SUCCEEDED,
            GoalStatus.CANCELED: State.PREEMPTED,
            GoalStatus.ABORTED: State.ABORTED,
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

    def _finish(self, goal: _Goal, state: State, text: str, result: Any = None) -> None:
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
        self._timer = self._node.clock.call_later(STATUS_PERIOD, self._tell_regularly)

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
                GOAL_STATUS_TYPE,
                {
                    "goal_id": {"id": goal.goal_id, "stamp": goal.stamp},
                    "status": goal.state.value,
                    "text": goal.text,
                },
            )
        return goal.status

    def _later(self) -> float:
        return self._node.clock.elapsed + STATUS_KEPT
