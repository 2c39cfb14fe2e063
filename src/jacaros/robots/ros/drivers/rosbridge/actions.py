"""Action clients and servers: through actionlib's topics on ROS 1, as goals on ROS 2, as soon as the version is
known.

The protocol has operations for ROS 2's goals, but conveys less than ROS 2 does. A client receives feedback and the
outcome, but neither the acceptance of its goal nor the answer to a request to cancel; both are read from the action's
status topic. The bridge does not report the goal's id there, so a new id is taken to be ours. A server cannot reject:
the bridge has already accepted each goal, so a rejected goal is aborted, with the reason in its result.
"""

import uuid
from dataclasses import dataclass
from functools import partial
from typing import Any

from jacaros.robots.ros.action import (
    TEXT_FIELDS,
    ActionPolicy,
    ExecuteCallback,
    GoalOutcome,
    GoalStatus,
    ServedGoals,
    text_of,
)
from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.actionlib import ActionlibServer, ActionlibWire
from jacaros.robots.ros.drivers.rosbridge.node import BridgeNode, OperationHandler
from jacaros.robots.ros.drivers.rosbridge.topics import BridgeSubscription
from jacaros.robots.ros.errors import CallFailed, ServerLost, ServerUnavailable
from jacaros.robots.ros.names import feedback_type, goal_type, result_type
from jacaros.robots.ros.node import Sample, SubscriptionOptions
from jacaros.robots.ros.protocols.ros2_actions import CANCELING, ENDS, NUMBERS, STATUS, UNDER_WAY
from jacaros.robots.ros.protocols.rosbridge_wire import LOOK_AGAIN
from jacaros.robots.ros.qos import QoS
from jacaros.runtime.clock import Timer

STATUS_TYPE = "action_msgs/msg/GoalStatusArray"
STATUS_QUALITY = QoS(durability="transient_local", depth=100)
TOLD_WITHIN = 10.0
"""Seconds without a sign of a goal after which it counts as not sent: the bridge looks for a server for one of them."""
UNTOLD = f"no answer about the goal within {TOLD_WITHIN:g} s"
CANCELED_AFTER = 1.0
"""Seconds within which a server that accepts to cancel has changed the goal's status."""


@dataclass(slots=True)
class _Sent:
    """A goal that was sent; *key* is its id in the status topic."""

    accepted: bool = False
    key: str | None = None
    cancel_asked: bool = False


class Ros2Goals:
    """The `GoalWire` of an action client on a ROS 2 robot.

    While a goal is active or a caller waits for the server, it polls rosapi, which reports neither publishers of the
    hidden topics of actions nor servers of their services.
    """

    def __init__(self, node: BridgeNode, sender: ActionClient) -> None:
        self._node = node
        self._sender = sender
        self._goals: dict[str, _Sent] = {}
        self._known: set[str] = set()
        self._present = False
        self._polled = node.polled(
            "action_servers", lambda seen: sender.name in seen["action_servers"], False
        )
        self._timer: Timer | None = None
        self._status: BridgeSubscription | None = None
        self._forget_hook = node.add_exit_hook(self._cancel_all)

    def join(self) -> None:
        """Follow the status of goals; on the first connection."""
        if self._status is None:
            wanted = SubscriptionOptions(
                f"{self._sender.name}{STATUS}", STATUS_TYPE, self._status_changed, STATUS_QUALITY
            )
            self._status = self._node.keep(BridgeSubscription(self._node, wanted))

    @property
    def offered(self) -> bool:
        """Whether a server offers the action, as far as is known; reading it starts the polling."""
        if self._timer is None:
            self._timer = self._node.clock.call_later(0.0, self._look)
        return self._present and self._node.connected

    def lost(self) -> None:
        """Handle that the link is down, and perhaps the server, too."""
        self._present = False

    def new_id(self) -> str:
        """Return the id of a new goal; the bridge has one table of ids for all its clients."""
        return f"send_action_goal:{self._sender.name}:{uuid.uuid4().hex}"

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Send a goal message."""
        node, sender = self._node, self._sender
        operation = {
            "op": "send_action_goal",
            "id": goal_id,
            "action": sender.name,
            "action_type": sender.type_name,
            "args": node.translator.encode(goal_type(sender.type_name), goal),
            "feedback": True,
        }
        # Stored before it is sent: an exit hook in another thread must find it.
        self._goals[goal_id] = _Sent()
        node.handlers |= {(answer, goal_id): handler for answer, handler in self._handlers.items()}
        sent: list[bool] = []
        node.lifetime.send(lambda _: sent.append(node.send(operation)), None)
        if sent != [True]:
            self.forget_goal(goal_id)
            raise CallFailed(f"action {sender.name}: no connection to the rosbridge server")
        node.clock.call_later(TOLD_WITHIN, lambda: self._expect_sign(goal_id))

    def cancel_goal(self, goal_id: str) -> None:
        """Ask the server to cancel a goal."""
        sent = self._goals.get(goal_id)
        self._ask_to_cancel(goal_id)
        if sent is not None:
            sent.cancel_asked = True
            self._node.clock.call_later(CANCELED_AFTER, lambda: self._cancel_is_overdue(goal_id))

    def adopt_goal(self, goal_id: str) -> None:
        """Never called: the bridge generates the servers' goal ids, so orphans are not recognised."""

    def forget_goal(self, goal_id: str) -> None:
        """Stop reporting a goal: it has ended for this client."""
        self._goals.pop(goal_id, None)
        for answer in self._handlers:
            self._node.handlers.pop((answer, goal_id), None)

    def close(self) -> None:
        """Leave."""
        self._forget_hook()
        if self._timer is not None:
            self._timer.cancel()
        if self._status is not None:
            self._status.close()

    def _cancel_all(self) -> None:
        """Exit hook: leave no robot driving towards its goal when the process ends."""
        for goal_id in list(self._goals):
            self._ask_to_cancel(goal_id)

    # Messages of the bridge, on the loop:

    @property
    def _handlers(self) -> dict[str, OperationHandler]:
        return {"action_feedback": self._take_feedback, "action_result": self._take_result}

    def _take_feedback(self, message: dict[str, Any]) -> None:
        goal_id, values = message["id"], message.get("values")
        self._accept(goal_id)
        if isinstance(values, dict) and values.keys() == {"goal_id", "feedback"}:  # older servers
            values = values["feedback"]
        feedback = self._decoded(feedback_type(self._sender.type_name), values)
        if feedback is not None:
            self._sender.feedback(goal_id, feedback)

    def _take_result(self, message: dict[str, Any]) -> None:
        """Pass on the outcome of a goal, or why it did not begin."""
        goal_id, values, number = message["id"], message.get("values"), message.get("status")
        if not message.get("result", True) and not (number in ENDS and isinstance(values, dict)):
            self._refused(goal_id, str(values))
            return
        if number is None and isinstance(values, dict) and "status" in values:  # older servers
            number, values = values["status"], values.get("result")
        self._accept(goal_id)
        status = ENDS.get(number or 4, GoalStatus.ABORTED)
        result = self._decoded(result_type(self._sender.type_name), values or {})
        if result is not None:
            self._sender.ended(goal_id, GoalOutcome(status, result, text_of(result)))
        else:
            self._sender.fail(goal_id, CallFailed(f"action {self._sender.name}: the result cannot be read"))

    def _refused(self, goal_id: str, text: str) -> None:
        if "No action server" in text:
            self._sender.fail(goal_id, ServerUnavailable(f"no server offers action {self._sender.name}"))
        elif "rejected" in text:
            self._sender.rejected(goal_id)
        elif text == UNTOLD:
            problem = f"action {self._sender.name}: {text}; does this rosbridge server support actions? Version 2 does"
            self._sender.fail(goal_id, CallFailed(problem))
        else:
            self._sender.rejected(goal_id, text)

    def _look(self) -> None:
        self._timer = None
        seen = self._node.connected and self._polled.value
        if seen != self._present:
            self._present = seen
            self._sender.server_present(seen)
        if self._sender.busy or self._polled.asking:
            pause = LOOK_AGAIN / 4 if self._polled.asking else LOOK_AGAIN
            self._timer = self._node.clock.call_later(pause, self._look)

    def _ask_to_cancel(self, goal_id: str) -> None:
        self._node.send({"op": "cancel_action_goal", "id": goal_id, "action": self._sender.name})

    def _status_changed(self, sample: Sample) -> None:
        seen = {
            bytes(each.goal_info.goal_id.uuid).hex(): int(each.status) for each in sample.message.status_list
        }
        for key, number in seen.items():
            if key not in self._known and number in UNDER_WAY:
                self._appeared(key)
        self._known = set(seen)
        for goal_id, sent in list(self._goals.items()):
            if sent.cancel_asked and sent.key is not None and seen.get(sent.key) == CANCELING:
                sent.cancel_asked = False
                self._sender.cancel_answered(goal_id, True)

    def _appeared(self, key: str) -> None:
        for goal_id, sent in list(self._goals.items()):
            if sent.key is None:
                sent.key = key
                self._accept(goal_id)
                return

    def _accept(self, goal_id: str) -> None:
        sent = self._goals.get(goal_id)
        if sent is not None and not sent.accepted:
            sent.accepted = True
            self._sender.accepted(goal_id)

    def _expect_sign(self, goal_id: str) -> None:
        """Start the time-out for a first answer: servers without actions do not send an error."""
        sent = self._goals.get(goal_id)
        if sent is not None and not sent.accepted:
            self._ask_to_cancel(goal_id)
            self._refused(goal_id, UNTOLD)

    def _cancel_is_overdue(self, goal_id: str) -> None:
        sent = self._goals.get(goal_id)
        if sent is not None and sent.cancel_asked:
            sent.cancel_asked = False
            # Without its key the result is unknown; the request was delivered, and most servers always accept.
            self._sender.cancel_answered(goal_id, sent.key is None)

    def _decoded(self, type_name: str, values: Any) -> Any:
        try:
            return self._node.translator.decode(type_name, values)
        except ValueError as problem:
            self._node.log(f"action {self._sender.name}: {problem}")
            return None


class Ros2GoalService:
    """An action server on a ROS 2 robot."""

    def __init__(
        self, node: BridgeNode, name: str, type_name: str, execute: ExecuteCallback, policy: ActionPolicy
    ) -> None:
        self.name = name
        self._node = node
        self._type_name = type_name
        self._goals = ServedGoals(node.clock, node.factory, name, type_name, execute, policy, node.log)
        node.handlers["send_action_goal", name] = self._goal
        node.handlers["cancel_action_goal", name] = self._cancel
        node.send({"op": "advertise_action", "type": type_name, "action": name})

    def abandon(self) -> None:
        """The link is down: the bridge has reported the goals as aborted to the clients, so stop them."""
        self._goals.abandon()
        self._unhandle()

    def close(self) -> None:
        """Stop offering the action."""
        self._goals.close()
        self._unhandle()
        self._node.send({"op": "unadvertise_action", "action": self.name})

    def _unhandle(self) -> None:
        self._node.unhandle(self._goal, "send_action_goal", self.name)
        self._node.unhandle(self._cancel, "cancel_action_goal", self.name)

    def _goal(self, message: dict[str, Any]) -> None:
        goal_id = str(message.get("id"))
        try:
            request = self._node.translator.decode(goal_type(self._type_name), message.get("args") or {})
        except ValueError as problem:
            self._end(goal_id, self._aborted(str(problem)))
            return
        reason = self._goals.judge(request)
        if reason is not None:
            self._end(goal_id, self._aborted(reason))
        else:
            self._goals.begin(goal_id, request, partial(self._feedback, goal_id), partial(self._end, goal_id))

    def _cancel(self, message: dict[str, Any]) -> None:
        """Handle a request to cancel; the bridge has already accepted it."""
        self._goals.cancel(str(message.get("id")))

    def _feedback(self, goal_id: str, message: Any) -> None:
        values = self._node.translator.encode(feedback_type(self._type_name), message)
        self._node.send({"op": "action_feedback", "id": goal_id, "action": self.name, "values": values})

    def _end(self, goal_id: str, outcome: GoalOutcome) -> None:
        self._node.send(
            {
                "op": "action_result",
                "id": goal_id,
                "action": self.name,
                "values": self._node.translator.encode(result_type(self._type_name), outcome.result),
                "status": NUMBERS[outcome.status],
                "result": True,
            }
        )

    def _aborted(self, text: str) -> GoalOutcome:
        kind = result_type(self._type_name)
        fields = self._node.factory.fields(kind)
        told = {name: text for name in TEXT_FIELDS if name in fields and fields[name].base == "string"}
        return GoalOutcome(GoalStatus.ABORTED, self._node.factory.make(kind, told), text)


LOST_LINK = (
    "the connection to the rosbridge server was lost during goal {}; it is unknown whether the goal continues"
)


class BridgeActionClient(ActionClient):
    """Action client of `RosbridgeBackend`."""

    def __init__(self, node: BridgeNode, name: str, type_name: str) -> None:
        node.schema.load(type_name)
        super().__init__(
            node.clock, node.log, node.factory, name, type_name, node.leaving_goals, node.orphans
        )
        self._node = node
        self.wire = Ros2Goals(node, self)
        node.keep(self)
        if node.attached:
            self.join()

    def join(self) -> None:
        """Handle that the link is up, to a robot of perhaps another version of ROS."""
        version = 1 if isinstance(self.wire, ActionlibWire) else 2
        if version != self._node.ros_version:
            self.wire.close()
            self.wire = Ros2Goals(self._node, self) if version == 1 else ActionlibWire(self._node, self)
        if isinstance(self.wire, Ros2Goals):
            self.wire.join()
        if self.busy:
            _ = self.wire.offered  # starts polling

    def lost(self) -> None:
        """Handle that the link is down: the outcome of active goals can no longer arrive."""
        if isinstance(self.wire, Ros2Goals):
            self.wire.lost()
        for goal_id in list(self._goals):
            self.fail(goal_id, ServerLost(LOST_LINK.format(goal_id)))

    def close(self) -> None:
        """Close the client."""
        super().close()
        self._node.forget(self)


class BridgeActionServer:
    """Action server of `RosbridgeBackend`."""

    def __init__(
        self, node: BridgeNode, name: str, type_name: str, execute: ExecuteCallback, policy: ActionPolicy
    ) -> None:
        node.schema.load(type_name)
        node.keep(self)
        self.name = name
        self._node = node
        self._offer = (name, type_name, execute, policy)
        self._service: ActionlibServer | Ros2GoalService | None = None
        self.abandoned = False
        if node.attached:
            self.join()

    def join(self) -> None:
        """The link is up: offer the action."""
        if self._node.ros_version == 1:
            self._service = ActionlibServer(self._node, *self._offer)
        else:
            self._service = Ros2GoalService(self._node, *self._offer)

    def lost(self) -> None:
        """Handle that the link is down: clients see the action disappear, so its goals must not continue."""
        if self._service is not None:
            self._service.abandon()
            self._service = None

    def close(self) -> None:
        """Stop offering the action."""
        self._node.forget(self)
        if self._service is not None:
            self._service.close()
            self._service = None
