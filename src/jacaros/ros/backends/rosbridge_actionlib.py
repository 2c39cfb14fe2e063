"""Actions of a ROS 1 robot through the bridge: actionlib's five topics, in the protocol's own notation.

The protocol knows no actions of ROS 1, so goals, requests for cancelling and news are ordinary messages of the types that
actionlib wraps around an action's own (``pkg/NameActionGoal`` and so on).
"""

import uuid
from collections.abc import Callable
from typing import Any

from jacaros.clock import Timer
from jacaros.ros.action import ActionPolicy, Execute, GoalStatus, Outcome
from jacaros.ros.action_calling import GoalSender
from jacaros.ros.action_serving import OneGoalOf, ServedGoals, text_of
from jacaros.ros.backends.rosbridge_actions import CANCELED_AFTER, LOST_LINK, PresenceWatch
from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.backends.rosbridge_topics import RawTopics
from jacaros.ros.errors import CallFailed, ServerLost
from jacaros.ros.names import feedback_type, goal_type, result_type

PENDING, ACTIVE, PREEMPTED, SUCCEEDED, ABORTED, REJECTED, PREEMPTING, RECALLING, RECALLED, LOST = range(10)
"""Numbers of ``actionlib_msgs/GoalStatus``."""
_ENDS = {
    PREEMPTED: GoalStatus.CANCELED,
    RECALLED: GoalStatus.CANCELED,
    SUCCEEDED: GoalStatus.SUCCEEDED,
    ABORTED: GoalStatus.ABORTED,
}
_NUMBERS = {
    GoalStatus.CANCELED: PREEMPTED,
    GoalStatus.SUCCEEDED: SUCCEEDED,
    GoalStatus.ABORTED: ABORTED,
}
STATUS_EVERY, STATUS_KEPT = 0.2, 5.0
"""Seconds between two status messages, and for which they tell of a goal that is over, as actionlib does."""
RESULT_OVERDUE = 2.0
"""Seconds after which the result of a goal that is over is not awaited any more."""


class Ros1Goals:
    """The `GoalWire` of an action client on a ROS 1 robot."""

    def __init__(self, node: BridgeNode, sender: GoalSender) -> None:
        self._node = node
        self._sender = sender
        self._name = sender.name
        self._written = node.written_type(sender.type_name)
        self._goals: dict[str, int] = {}
        self._watch = PresenceWatch(node, f"{self._name}/status", sender)
        self._topics = RawTopics(node)
        self._topics.listen(f"{self._name}/feedback", f"{self._written}ActionFeedback", self._feedback)
        self._topics.listen(f"{self._name}/result", f"{self._written}ActionResult", self._result)
        self._topics.listen(f"{self._name}/status", "actionlib_msgs/GoalStatusArray", self._status)
        self._goal = RawPublisher(node, f"{self._name}/goal", f"{self._written}ActionGoal")
        self._cancel = RawPublisher(node, f"{self._name}/cancel", "actionlib_msgs/GoalID")
        self._goal.join()
        self._cancel.join()

    @property
    def offered(self) -> bool:
        """Whether a server offers the action, as far as is known."""
        return self._watch.offered

    def new_id(self) -> str:
        """Make up the id of a new goal."""
        return f"{self._node.node_name}-{uuid.uuid4().hex}"

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Send a goal message."""
        stamp = self._node.written_time()
        values = self._node.translator.encode(goal_type(self._sender.type_name), goal)
        sent = self._goal.send(
            {"header": {"stamp": stamp}, "goal_id": {"stamp": stamp, "id": goal_id}, "goal": values}
        )
        if not sent:
            raise CallFailed(f"action {self._name}: there is no connection to the rosbridge server")
        self._goals[goal_id] = PENDING

    def cancel_goal(self, goal_id: str) -> None:
        """Ask the server to cancel a goal."""
        # With a stamp of zero the id alone counts; any other would cancel all goals up to that time as well.
        self._cancel.send({"stamp": {"secs": 0, "nsecs": 0}, "id": goal_id})
        self._node.clock.call_later(CANCELED_AFTER, lambda: self._cancel_is_overdue(goal_id))

    def forget_goal(self, goal_id: str) -> None:
        """The goal is over for this client."""
        self._goals.pop(goal_id, None)

    def close(self) -> None:
        """Leave."""
        self._watch.stop()
        self._topics.close()
        self._goal.leave()
        self._cancel.leave()

    def lost(self) -> None:
        """The link is down; what a goal does meanwhile would be told to nobody."""
        for goal_id in list(self._goals):
            self._sender.fail(goal_id, ServerLost(LOST_LINK.format(goal_id)))

    def join(self) -> None:
        """The link is up."""
        self._goal.join()
        self._cancel.join()

    def _feedback(self, values: Any) -> None:
        goal_id, _ = _goal_and_text(values)
        if goal_id in self._goals:
            message = self._decoded(feedback_type(self._sender.type_name), values.get("feedback") or {})
            if message is not None:
                self._progress(goal_id, ACTIVE, "")
                self._sender.feedback(goal_id, message)

    def _result(self, values: Any) -> None:
        goal_id, text = _goal_and_text(values)
        if goal_id not in self._goals:
            return
        number = values["status"]["status"]
        if number == REJECTED:
            self._sender.rejected(goal_id, text)
            return
        result = self._decoded(result_type(self._sender.type_name), values.get("result") or {})
        if result is None:
            self._sender.fail(goal_id, CallFailed(f"action {self._name}: the result cannot be read"))
            return
        self._progress(goal_id, ACTIVE, text)
        status = _ENDS.get(number, GoalStatus.ABORTED)
        self._sender.ended(goal_id, Outcome(status, result, text or text_of(result)))

    def _status(self, values: Any) -> None:
        listed = {each["goal_id"]["id"]: each for each in values.get("status_list", ())}
        for goal_id, number in list(self._goals.items()):
            if goal_id in listed:
                self._progress(goal_id, listed[goal_id]["status"], listed[goal_id].get("text", ""))
            elif number != PENDING:
                text = f"another server offers action {self._name} now; what becomes of goal {goal_id} is not known"
                self._sender.fail(goal_id, ServerLost(text))

    def _progress(self, goal_id: str, number: int, text: str) -> None:
        before = self._goals.get(goal_id)
        if before is None or number == before or before in _ENDS:
            return
        self._goals[goal_id] = number
        if number == REJECTED:
            self._sender.rejected(goal_id, text)
        elif number != PENDING and before == PENDING:
            self._sender.accepted(goal_id)
        if number in (PREEMPTING, RECALLING):
            self._sender.cancel_answered(goal_id, True)
        elif number in _ENDS:
            self._node.clock.call_later(RESULT_OVERDUE, lambda: self._end_without_result(goal_id, text))

    def _end_without_result(self, goal_id: str, text: str) -> None:
        number = self._goals.get(goal_id)
        if number in _ENDS:
            result = self._node.factory.make(result_type(self._sender.type_name))
            self._sender.ended(goal_id, Outcome(_ENDS[number], result, text))

    def _cancel_is_overdue(self, goal_id: str) -> None:
        if self._goals.get(goal_id) in (PENDING, ACTIVE):
            self._sender.cancel_answered(goal_id, False)

    def _decoded(self, type_name: str, values: Any) -> Any:
        try:
            return self._node.translator.decode(type_name, values)
        except ValueError as problem:
            self._node.log(f"action {self._name}: {problem}")
            return None


class RawPublisher:
    """A publisher for the backend's own use, of messages as the protocol writes them."""

    def __init__(self, node: BridgeNode, topic: str, written_type: str) -> None:
        self._node = node
        self._topic = topic
        self._type = written_type
        self._number = node.members.number("advertise", topic)

    def join(self) -> None:
        """Advertise the topic."""
        self._node.send(
            {
                "op": "advertise",
                "id": self._number,
                "topic": self._topic,
                "type": self._type,
                "queue_size": 10,
            }
        )

    def send(self, values: dict[str, Any]) -> bool:
        """Publish a message; False when it is lost."""
        return self._node.send({"op": "publish", "topic": self._topic, "msg": values})

    def leave(self) -> None:
        """Leave the topic."""
        self._node.send({"op": "unadvertise", "id": self._number, "topic": self._topic})


class Ros1GoalService:
    """The side of an action server on a ROS 1 robot."""

    def __init__(
        self, node: BridgeNode, name: str, type_name: str, execute: Execute, policy: ActionPolicy
    ) -> None:
        self.name = name
        self._node = node
        self._type_name = type_name
        written = node.written_type(type_name)
        self._make: Callable[[], ServedGoals] = lambda: ServedGoals(
            node.factory, name, type_name, execute, policy, node.log
        )
        self._goals = self._make()
        self._states: dict[str, _State] = {}
        self._timer: Timer | None = None
        self._publishers = {
            "feedback": RawPublisher(node, f"{name}/feedback", f"{written}ActionFeedback"),
            "result": RawPublisher(node, f"{name}/result", f"{written}ActionResult"),
            "status": RawPublisher(node, f"{name}/status", "actionlib_msgs/GoalStatusArray"),
        }
        self._topics = RawTopics(node)
        self._topics.listen(f"{name}/goal", f"{written}ActionGoal", self.goal)
        self._topics.listen(f"{name}/cancel", "actionlib_msgs/GoalID", self._cancel_asked)

    def join(self) -> None:
        """Offer the action at a server that does not know us yet."""
        for publisher in self._publishers.values():
            publisher.join()
        self._tell_status()

    def lost(self) -> None:
        """The link is down: clients see the action go away, so nothing is to go on behind their backs."""
        self._goals.close()
        self._goals = self._make()
        self._states.clear()

    def close(self) -> None:
        """Stop to offer the action."""
        self._goals.close()
        if self._timer is not None:
            self._timer.cancel()
        self._topics.close()
        for publisher in self._publishers.values():
            publisher.leave()

    def goal(self, values: dict[str, Any]) -> None:
        """Take a goal."""
        goal_id = str(values.get("goal_id", {}).get("id", "")) or f"{self.name}-{uuid.uuid4().hex}"
        if goal_id in self._states:
            return
        state = self._states[goal_id] = _State(values.get("goal_id", {}).get("stamp"))
        try:
            request = self._node.translator.decode(goal_type(self._type_name), values.get("goal") or {})
            reason = self._goals.judge(request)
        except ValueError as problem:
            request, reason = None, str(problem)
        if reason is None:
            state.number = ACTIVE
            self._goals.begin(goal_id, request, OneGoalOf(self, goal_id))
            self._tell_status()
        else:
            self._end(goal_id, REJECTED, self._node.factory.make(result_type(self._type_name)), reason)

    def cancel(self, goal_id: str) -> None:
        """Take a request for cancelling one goal."""
        state = self._states.get(goal_id)
        if state is not None and self._goals.cancel(goal_id) and state.number == ACTIVE:
            state.number = PREEMPTING
            self._tell_status()

    def feedback(self, goal_id: str, message: Any) -> None:
        """Send feedback of a goal."""
        values = self._node.translator.encode(feedback_type(self._type_name), message)
        self._send("feedback", goal_id, values)

    def ended(self, goal_id: str, outcome: Outcome) -> None:
        """Send the end of a goal."""
        self._end(goal_id, _NUMBERS[outcome.status], outcome.result, outcome.text)

    def _cancel_asked(self, values: Any) -> None:
        goal_id = str(values.get("id", ""))
        stamp = _seconds(values.get("stamp"))
        for each, state in list(self._states.items()):
            all_of_them = not goal_id and not stamp
            if each == goal_id or all_of_them or (stamp and _seconds(state.stamp) <= stamp):
                self.cancel(each)

    def _end(self, goal_id: str, number: int, result: Any, text: str) -> None:
        state = self._states.get(goal_id)
        if state is None:
            return
        state.number, state.text = number, text
        self._send("result", goal_id, self._node.translator.encode(result_type(self._type_name), result))
        self._tell_status()
        self._node.clock.call_later(STATUS_KEPT, lambda: self._forget(goal_id))

    def _forget(self, goal_id: str) -> None:
        self._states.pop(goal_id, None)

    def _send(self, what: str, goal_id: str, values: Any) -> None:
        state = self._states.get(goal_id)
        if state is not None:
            header = {"stamp": self._node.written_time()}
            self._publishers[what].send({"header": header, "status": state.written(goal_id), what: values})

    def _tell_status(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        listed = [state.written(goal_id) for goal_id, state in self._states.items()]
        header = {"stamp": self._node.written_time()}
        self._publishers["status"].send({"header": header, "status_list": listed})
        self._timer = self._node.clock.call_later(STATUS_EVERY, self._tell_status)


class _State:
    """What the status topic says of a goal."""

    def __init__(self, stamp: Any) -> None:
        self.stamp = stamp or {"secs": 0, "nsecs": 0}
        self.number = PENDING
        self.text = ""

    def written(self, goal_id: str) -> dict[str, Any]:
        return {"goal_id": {"stamp": self.stamp, "id": goal_id}, "status": self.number, "text": self.text}


def _goal_and_text(values: Any) -> tuple[str, str]:
    status = values.get("status", {})
    return status.get("goal_id", {}).get("id", ""), status.get("text", "")


def _seconds(stamp: Any) -> float:
    stamp = stamp or {}
    return float(stamp.get("secs", 0)) + float(stamp.get("nsecs", 0)) * 1e-9
