"""Actions of ROS 2, built from their three services and two topics below ``<name>/_action``.

rclpy's own action classes are not used: their state belongs to the executor's threads, they need the decision about a
goal before their callback returns, and on Jazzy an answer that arrives too early is lost. The protocol is that of the
design article "Actions" (design.ros2.org), which every client library speaks.
"""

import time
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray  # type: ignore[import-not-found]
from action_msgs.srv import CancelGoal  # type: ignore[import-not-found]
from rclpy.event_handler import SubscriptionEventCallbacks  # type: ignore[import-not-found]
from rclpy.qos import QoSProfile  # type: ignore[import-not-found]
from unique_identifier_msgs.msg import UUID  # type: ignore[import-not-found]

from jacaros.robots.ros.action import ActionPolicy, ExecuteCallback, GoalOutcome, ServedGoals, text_of
from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.drivers.ros2.graph import action_servers, mismatch, profile
from jacaros.robots.ros.drivers.ros2.node import STOPPING_ROBOTS, Ros2Node
from jacaros.robots.ros.drivers.ros2.services import SETTLING, LateService
from jacaros.robots.ros.errors import CallFailed, ServerLost
from jacaros.robots.ros.handoff import Handoff, post
from jacaros.robots.ros.protocols.ros2_actions import (
    ACCEPTED,
    CANCEL_GOAL,
    CANCELING,
    ENDS,
    EXECUTING,
    FEEDBACK,
    FEEDBACK_QUALITY,
    GET_RESULT,
    NUMBERS,
    RESULT_KEPT,
    SEND_GOAL,
    STATUS,
    STATUS_QUALITY,
    UNDER_WAY,
    UNKNOWN,
    FailureDetector,
    new_goal_id,
)

Respond = Callable[[Any], None]
LOOKING = 0.1
"""Seconds between two checks of the server, while a goal is active or a caller waits for the server."""
COMPARING = 0.5
"""Seconds between two checks of the types in the graph, while there is no server."""
REPEATING, REPEATING_LAST = 1.0, 0.04
"""Seconds after which an unanswered request is repeated: while the client is open, and a last one to cancel."""
CANCEL_DEPTH = 3
"""Length of the queue of requests to cancel; in older versions of Fast DDS, a full queue makes lost ones noticed."""
FEW_GOALS, STATUS_TOGETHER = 20, 0.2
"""Number of goals above which changes of status are published together, this number of seconds later: a message has all."""
FEEDBACK_WAITING = 100
"""Number of feedback messages that may wait for the loop; the oldest is dropped first."""


def goal_id(message: Any) -> str:
    """Read a goal's id from a message, as 32 hexadecimal digits."""
    return bytes(message.uuid).hex()


def id_message(identity: str) -> Any:
    """Make the message of a goal's id."""
    return UUID(uuid=list(bytes.fromhex(identity)))


@dataclass(slots=True)
class _ServedGoal:
    """A goal of the server; *asking* wait for its *response*."""

    info: Any
    status: int = ACCEPTED
    response: Any = None
    asking: list[Respond] = field(default_factory=list)


def _is_none(identity: Any) -> bool:
    return not any(identity.uuid)


class Ros2ActionServer:
    """Action server of the ``ros2`` backend."""

    def __init__(
        self, node: Ros2Node, name: str, type_name: str, execute: ExecuteCallback, policy: ActionPolicy
    ) -> None:
        self.name = name
        self._node = node
        self._impl: Any = node.schema.message_class(type_name).Impl
        self._under_way = ServedGoals(node.clock, node.factory, name, type_name, execute, policy, node.log)
        self._goals: dict[str, _ServedGoal] = {}
        self._closed = self._status_soon = False
        rcl, impl = node.rcl, self._impl
        self._feedback: Any = rcl.create_publisher(
            impl.FeedbackMessage, name + FEEDBACK, profile(FEEDBACK_QUALITY)
        )
        self._status: Any = rcl.create_publisher(GoalStatusArray, name + STATUS, profile(STATUS_QUALITY))
        # The goal's service comes last: a client that sees it finds the others, too.
        self._services = [
            LateService(node, impl.GetResultService, name + GET_RESULT, self._tell_result),
            LateService(node, CancelGoal, name + CANCEL_GOAL, self._cancel),
            LateService(node, impl.SendGoalService, name + SEND_GOAL, self._judge),
        ]
        node.keep(self)

    @property
    def abandoned(self) -> bool:
        """Whether no node listens to the feedback."""
        return bool(self._node.rcl.count_subscribers(self.name + FEEDBACK) == 0)

    def close(self) -> None:
        """Stop offering the action."""
        if self._closed:
            return
        self._under_way.close()
        if self._status_soon:
            self._send_status()
        self._closed = True
        for service in self._services:
            service.close(late=True)
        for publisher in (self._feedback, self._status):
            self._node.destroy_entity_later(self._node.rcl.destroy_publisher, publisher)
        self._node.forget(self)

    def _judge(self, request: Any, respond: Respond) -> None:
        identity = goal_id(request.goal_id)
        known = identity in self._goals
        refusal = "" if known else self._under_way.judge(request.goal)
        stamp = self._node.rcl.get_clock().now().to_msg()
        # ROS 2 has no field for the reason of a rejection.
        respond(self._impl.SendGoalService.Response(accepted=refusal is None, stamp=stamp))
        if refusal is not None:
            return
        goal = self._goals[identity] = _ServedGoal(GoalInfo(goal_id=request.goal_id, stamp=stamp))
        self._publish_status()
        goal.status = EXECUTING
        feedback, ended = partial(self._publish_feedback, request.goal_id), partial(self._finish, goal)
        self._under_way.begin(identity, request.goal, feedback, ended)
        self._publish_status()

    def _publish_feedback(self, identity: Any, message: Any) -> None:
        if not self._closed and not self._node.ended:
            self._feedback.publish(self._impl.FeedbackMessage(goal_id=identity, feedback=message))

    def _finish(self, goal: _ServedGoal, outcome: GoalOutcome) -> None:
        """Send a goal's outcome to the clients that requested it, and store it for later requests."""
        if self._node.ended:
            return
        goal.status = NUMBERS[outcome.status]
        goal.response = self._impl.GetResultService.Response(status=goal.status, result=outcome.result)
        for respond in goal.asking:
            respond(goal.response)
        goal.asking.clear()
        self._publish_status()
        self._node.loop.call_later(RESULT_KEPT, self._goals.pop, goal_id(goal.info.goal_id), None)

    def _cancel(self, request: Any, respond: Respond) -> None:
        """Cancel as ``action_msgs/srv/CancelGoal`` defines: one goal, all up to a time, or all."""
        info = request.goal_info
        meant = self._meant(info)
        agreed = [goal for goal in meant if self._under_way.cancel(goal_id(goal.info.goal_id))]
        for goal in agreed:
            if goal.response is None:
                goal.status = CANCELING
        answer = CancelGoal.Response
        if agreed or (not meant and _is_none(info.goal_id)):
            code = answer.ERROR_NONE
        elif meant:
            code = answer.ERROR_REJECTED
        else:
            known = goal_id(info.goal_id) in self._goals
            code = answer.ERROR_GOAL_TERMINATED if known else answer.ERROR_UNKNOWN_GOAL_ID
        respond(answer(goals_canceling=[goal.info for goal in agreed], return_code=code))
        if agreed:
            self._publish_status()

    def _meant(self, info: Any) -> list[_ServedGoal]:
        identity, until = goal_id(info.goal_id), (info.stamp.sec, info.stamp.nanosec)
        active = {known: goal for known, goal in self._goals.items() if goal.response is None}
        if _is_none(info.goal_id) and until == (0, 0):
            return list(active.values())
        return [
            goal
            for known, goal in active.items()
            if known == identity
            or (until != (0, 0) and (goal.info.stamp.sec, goal.info.stamp.nanosec) <= until)
        ]

    def _tell_result(self, request: Any, respond: Respond) -> None:
        goal = self._goals.get(goal_id(request.goal_id))
        if goal is None:
            respond(self._impl.GetResultService.Response(status=UNKNOWN))
        elif goal.response is None:
            goal.asking.append(respond)
        else:
            respond(goal.response)

    def _publish_status(self) -> None:
        """Publish the status of all goals: at once while they are few, otherwise several changes together."""
        if len(self._goals) <= FEW_GOALS:
            self._send_status()
        elif not self._status_soon:
            self._status_soon = True
            self._node.loop.call_later(STATUS_TOGETHER, self._send_status)

    def _send_status(self) -> None:
        self._status_soon = False
        if self._closed or self._node.ended:
            return
        listed = [GoalStatus(goal_info=goal.info, status=goal.status) for goal in self._goals.values()]
        self._status.publish(GoalStatusArray(status_list=listed))


@dataclass(eq=False)
class _SentGoal:
    """The state of a goal of the client; times are those of its last requests.

    Attributes:
        due: it is to be sent, perhaps again.
        over: it has ended according to the status topic.
    """

    identity: str
    request: Any = None
    due: bool = False
    sent: bool = False
    accepted: bool = False
    repeated: bool = False
    over: bool = False
    result_asked: float = 0.0
    cancel_asked: float = 0.0


class Ros2GoalWire:
    """Transfers goals from a `ActionClient` to the servers of the graph.

    A lost answer (a server answers before it has discovered the client, or a network fails) leaves no caller waiting:
    acceptance and end are also visible in the status topic, and then the request is repeated.
    """

    def __init__(self, node: Ros2Node, name: str, type_name: str) -> None:
        self.name = name
        self.sender = ActionClient(
            node.clock, node.log, node.factory, name, type_name, node.leaving_goals, node.orphans
        )
        self.sender.wire = self  # pyright: ignore[reportAttributeAccessIssue]
        self._node = node
        self._type_name = type_name
        self._impl: Any = node.schema.message_class(type_name).Impl
        self._goals: dict[str, _SentGoal] = {}
        self._cancelling: dict[str, _SentGoal] = {}
        """Goals with an unanswered request to cancel; used by any thread."""
        self._there = False
        self._there_since = 0.0
        self._mismatch: str | None = None
        self._compared = 0.0
        self._servers: frozenset[bytes] = frozenset()
        self._detector = FailureDetector(self._probe, self.sender.server_present, self._check_liveness)
        self._looking: Any = None
        self._calls: dict[Any, Any] = {}
        self._sending: Any = None
        self._closed = False
        rcl, impl = node.rcl, self._impl
        self._goal_client: Any = rcl.create_client(impl.SendGoalService, name + SEND_GOAL)
        self._cancel_client: Any = rcl.create_client(
            CancelGoal, name + CANCEL_GOAL, qos_profile=QoSProfile(depth=CANCEL_DEPTH)
        )
        self._result_client: Any = rcl.create_client(impl.GetResultService, name + GET_RESULT)
        self._feedback: Handoff[Any] = Handoff(node.loop, FEEDBACK_WAITING, self._take_feedback)
        self._subscriptions = [
            rcl.create_subscription(
                impl.FeedbackMessage, name + FEEDBACK, self._feedback.put, profile(FEEDBACK_QUALITY)
            ),
            rcl.create_subscription(
                GoalStatusArray,
                name + STATUS,
                lambda told: self._post(self._take_status, told),
                profile(STATUS_QUALITY),
                event_callbacks=SubscriptionEventCallbacks(
                    matched=lambda _: self._post(self._look), use_default_callbacks=False
                ),
            ),
        ]
        self._forget_hook = node.add_exit_hook(self._cancel_all)
        node.unsent[self._cancelled] = STOPPING_ROBOTS

    @classmethod
    def client(cls, node: Ros2Node, name: str, type_name: str) -> ActionClient:
        """Make an action client for the port, and register its wire at the node."""
        return node.keep(cls(node, name, type_name)).sender

    # Requests of the sender:

    @property
    def offered(self) -> bool:
        """Whether a server offers the action."""
        if self._closed or self._node.ended:
            return False
        self._note_presence()
        if not self._there:
            self._keep_looking()
        # A server of another type counts, too: `send_goal` reports the mismatch.
        return self._there or self._mismatch is not None

    def new_id(self) -> str:
        """Return the id of a new goal."""
        return self._node.orphans.hashed_id()

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Send a goal."""
        self._mismatch = mismatch(self._node, "action", self.name, self._type_name)
        if self._mismatch is not None:
            raise CallFailed(self._mismatch)
        request = self._impl.SendGoalService.Request(goal_id=id_message(goal_id), goal=goal)
        goal_sent = self._goals[goal_id] = _SentGoal(goal_id, request)
        self._note_servers()
        self._keep_looking()
        self._send_when_settled(goal_sent)

    def cancel_goal(self, goal_id: str) -> None:
        """Ask the server to cancel a goal."""
        self._keep_looking()
        self._ask_to_cancel(self._goals.get(goal_id) or _SentGoal(goal_id))

    def adopt_goal(self, identity: str) -> None:
        """Follow a goal of an earlier run."""
        goal = self._goals[identity] = _SentGoal(identity, sent=True, accepted=True)
        self._detector.goal_begins()
        self._ask_for_result(goal)
        self._keep_looking()

    def forget_goal(self, identity: str) -> None:
        """Forget a goal that has ended."""
        self._goals.pop(identity, None)
        if not self._goals:
            self._detector.rest()
            self._forget_calls()

    def close(self) -> None:
        """Leave when the last messages have arrived."""
        if self._closed:
            return
        self._closed = True
        self._forget_hook()
        self._feedback.close()
        for timer in (self._looking, self._sending):
            if timer is not None:
                timer.cancel()
        node = self._node
        for client in (self._goal_client, self._cancel_client, self._result_client):
            node.destroy_entity_later(node.rcl.destroy_client, client, self._cancelled)
        for subscription in self._subscriptions:
            node.destroy_entity_later(node.rcl.destroy_subscription, subscription)
        node.forget(self)

    def _cancelled(self, patience: float = REPEATING_LAST) -> bool:
        """Repeat requests to cancel that are not answered after *patience* seconds. Return whether all are answered."""
        late = time.monotonic() - patience
        for goal in list(self._cancelling.values()):
            if goal.cancel_asked < late:
                self._ask_to_cancel(goal)
        return not self._cancelling

    def _cancel_all(self) -> None:
        """Exit hook: cancel the active goals, because after the client's end nothing watches the robot."""
        for goal in list(self._goals.values()):
            if goal.sent and not goal.over and goal.identity not in self._cancelling:
                self._ask_to_cancel(goal)

    def _ask_to_cancel(self, goal: _SentGoal) -> None:
        goal.cancel_asked = time.monotonic()
        self._cancelling[goal.identity] = goal
        request = CancelGoal.Request(goal_info=GoalInfo(goal_id=id_message(goal.identity)))
        self._cancel_client.call_async(request).add_done_callback(partial(self._cancel_answered, goal))

    def _cancel_answered(self, goal: _SentGoal, call: Any) -> None:
        """Handle an answer, on the executor's thread: the loop may no longer run."""
        if call.exception() is not None or (answer := call.result()) is None:
            return
        agreed = any(goal_id(info.goal_id) == goal.identity for info in answer.goals_canceling)
        # A request to cancel may overtake its goal.
        if agreed or goal.accepted or answer.return_code != CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID:
            self._cancelling.pop(goal.identity, None)
        self._post(self._take_answer, partial(self.sender.cancel_answered, goal.identity), agreed)

    # Answers, on the loop:

    def _answered(self, goal: _SentGoal, answer: Any) -> None:
        if answer.accepted:
            self._accept(goal.identity)
        elif not goal.accepted:
            # The server also refuses what it has already accepted; then its status is about to arrive.
            self._node.loop.call_later(SETTLING if goal.repeated else 0.0, self._reject, goal)

    def _reject(self, goal: _SentGoal) -> None:
        if not goal.accepted:
            self.sender.rejected(goal.identity)

    def _accept(self, identity: str) -> None:
        goal = self._goals.get(identity)
        if goal is None:
            self.sender.accepted(identity)
        elif not goal.accepted:
            goal.accepted = True
            self._detector.goal_begins()
            self.sender.accepted(identity)
            self._ask_for_result(goal)

    def _ask_for_result(self, goal: _SentGoal) -> None:
        if goal.identity not in self._goals or self._closed or self._node.ended:
            return
        goal.result_asked = time.monotonic()
        request = self._impl.GetResultService.Request(goal_id=id_message(goal.identity))
        self._call(self._result_client, request, lambda answer: self._take_result(goal.identity, answer))

    def _take_result(self, identity: str, answer: Any) -> None:
        self._cancelling.pop(identity, None)
        if identity not in self._goals:
            return
        self._feedback.deliver_all()
        status = ENDS.get(answer.status)
        if status is None:
            text = f"the server of action {self.name} does not know goal {identity}: it was restarted"
            self.sender.fail(identity, ServerLost(text))
        else:
            self.sender.ended(identity, GoalOutcome(status, answer.result, text_of(answer.result)))

    def _take_feedback(self, message: Any) -> None:
        identity = goal_id(message.goal_id)
        if identity in self._goals:
            self._detector.heard()
            self._accept(identity)
            self.sender.feedback(identity, message.feedback)

    def _take_status(self, told: Any) -> None:
        self.sender.goals_under_way(
            goal_id(entry.goal_info.goal_id) for entry in told.status_list if entry.status in UNDER_WAY
        )
        for entry in told.status_list:
            identity = goal_id(entry.goal_info.goal_id)
            goal = self._goals.get(identity)
            if goal is not None:
                self._detector.heard()
                goal.over = entry.status in ENDS
                self._accept(identity)

    # Checking the server:

    def _keep_looking(self) -> None:
        if self._looking is None and not self._closed:
            self._looking = self._node.loop.call_later(LOOKING, self._look_again)

    def _look_again(self) -> None:
        self._looking = None
        self._look()
        if self.sender.busy:
            self._keep_looking()

    def _look(self) -> None:
        if self._closed or self._node.ended:
            return
        self._note_presence()
        if self._there and self._note_servers():
            self._greet_newcomers()
        if not self._goals:
            return
        now = time.monotonic()
        for goal in list(self._goals.values()):
            if goal.accepted and goal.over and now > goal.result_asked + REPEATING:
                self._ask_for_result(goal)
        self._cancelled(REPEATING)
        if self._there:
            goals = self._goals.values()
            self._detector.check(
                now,
                under_way=any(goal.accepted and not goal.over for goal in goals),
                waiting=any(goal.sent and not goal.accepted for goal in goals),
            )

    def _note_presence(self) -> None:
        rcl = self._node.rcl
        clients = (self._goal_client, self._cancel_client, self._result_client)
        there = all(client.service_is_ready() for client in clients) and bool(
            rcl.count_publishers(self.name + FEEDBACK)
        )
        if there != self._there:
            self._there = there
            self._there_since = time.monotonic()
            self._mismatch = None
            self.sender.server_present(there)
        elif not there and time.monotonic() > self._compared + COMPARING:
            self._compared = time.monotonic()
            self._mismatch = mismatch(self._node, "action", self.name, self._type_name)
            if self._mismatch is not None:
                self.sender.server_present(True)

    def _note_servers(self) -> bool:
        """Update the set of servers. Return whether there is a new one."""
        servers = action_servers(self._node.rcl, self.name)
        if servers <= self._servers:
            return False
        self._servers |= servers
        self._there_since = time.monotonic()
        self._detector.reset()
        return True

    def _greet_newcomers(self) -> None:
        """Check goals after a new server appeared: it may have replaced a dead one that the graph still lists.

        If so, it does not know the goal and answers that; a goal that was not accepted is sent to it, unless it was
        abandoned.
        """
        for goal in list(self._goals.values()):
            if goal.accepted:
                self._node.loop.call_later(SETTLING, self._ask_for_result, goal)
            elif self.sender.wants(goal.identity):
                goal.repeated = True
                self._send_when_settled(goal)

    def _send_when_settled(self, goal: _SentGoal) -> None:
        """Send a goal as soon as the server knows the client: earlier messages or answers would be lost.

        Goals are sent in order, because with pre-emption the newest one must win.
        """
        goal.due = True
        if self._sending is None:
            self._send_due()

    def _send_due(self) -> None:
        self._sending = None
        if self._closed or self._node.ended:
            return
        rest = self._there_since + SETTLING - time.monotonic()
        if rest > 0.0:
            self._sending = self._node.loop.call_later(rest, self._send_due)
            return
        for goal in [goal for goal in self._goals.values() if goal.due]:
            goal.due = False
            if self.sender.wants(goal.identity):
                self._node.lifetime.send(self._send, goal)
            elif not goal.sent:
                dropped = CallFailed(f"action {self.name}: the goal was dropped before it was sent")
                self.sender.fail(goal.identity, dropped)

    def _send(self, goal: _SentGoal) -> None:
        goal.sent = True
        self._call(self._goal_client, goal.request, partial(self._answered, goal))

    def _probe(self) -> None:
        """Send a request that every server answers immediately: the result of an unknown goal."""
        request = self._impl.GetResultService.Request(goal_id=id_message(new_goal_id()))
        self._call(self._result_client, request, lambda _: self._detector.probe_answered())

    def _check_liveness(self) -> None:
        suspects = action_servers(self._node.rcl, self.name)

        def report(missing: frozenset[bytes]) -> None:
            # With several servers it is unknown which one has our goals.
            if not self._closed and suspects == action_servers(self._node.rcl, self.name):
                self._detector.looked(missing != suspects)

        if suspects:
            self._node.check_liveness(lambda rcl: action_servers(rcl, self.name), suspects, report)

    # Between the threads:

    def _call(self, client: Any, request: Any, take: Callable[[Any], None]) -> None:
        def finished(future: Any) -> None:
            self._calls.pop(future, None)
            if future.exception() is None and future.result() is not None:
                self._post(self._take_answer, take, future.result())

        call = client.call_async(request)
        self._calls[call] = client
        call.add_done_callback(finished)

    def _forget_calls(self) -> None:
        """Drop pending calls: those of a dead server would wait forever."""
        for call in list(self._calls):
            client = self._calls.pop(call, None)
            if client is not None:  # otherwise it was answered just now, on the executor's thread
                client.remove_pending_request(call)

    def _take_answer(self, take: Callable[[Any], None], answer: Any) -> None:
        self._detector.heard()
        take(answer)

    def _post(self, action: Callable[..., None], *arguments: Any) -> None:
        def on_loop() -> None:
            if not self._closed:
                action(*arguments)

        post(self._node.loop, on_loop)
