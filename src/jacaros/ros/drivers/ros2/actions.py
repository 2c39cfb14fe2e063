"""Actions of ROS 2, built from their three services and two topics below ``<name>/_action``.

rclpy's own action classes are not used: their state belongs to the executor's threads, they need the decision about a
goal before their callback returns, and on Jazzy an answer that arrives too early is lost. The protocol is that of the
design article "Actions" (design.ros2.org), which every client library speaks.
"""

from collections.abc import Callable
from typing import Any

from action_msgs.msg import GoalInfo, GoalStatus, GoalStatusArray  # type: ignore[import-not-found]
from action_msgs.srv import CancelGoal  # type: ignore[import-not-found]
from unique_identifier_msgs.msg import UUID  # type: ignore[import-not-found]

from jacaros.ros.action import ActionPolicy, Execute, Outcome, ServedGoals
from jacaros.ros.drivers.ros2.graph import profile
from jacaros.ros.drivers.ros2.node import Ros2Node
from jacaros.ros.drivers.ros2.services import LateService
from jacaros.ros.protocols.ros2_actions import (
    ACCEPTED,
    CANCEL_GOAL,
    CANCELING,
    EXECUTING,
    FEEDBACK,
    FEEDBACK_QUALITY,
    GET_RESULT,
    NUMBERS,
    RESULT_KEPT,
    SEND_GOAL,
    STATUS,
    STATUS_QUALITY,
    UNKNOWN,
)

Respond = Callable[[Any], None]


def goal_id(message: Any) -> str:
    """Read a goal's id from a message, as 32 hexadecimal digits."""
    return bytes(message.uuid).hex()


def id_message(identity: str) -> Any:
    """Make the message of a goal's id."""
    return UUID(uuid=list(bytes.fromhex(identity)))


class _ServedGoal:
    """Publishes one goal: its status, feedback and outcome."""

    def __init__(self, server: "Ros2ActionServer", info: Any) -> None:
        self.info = info
        self.status = ACCEPTED
        self.response: Any = None
        self.asking: list[Respond] = []
        self._server = server

    def feedback(self, message: Any) -> None:
        """Publish feedback."""
        self._server.publish_feedback(self.info.goal_id, message)

    def ended(self, outcome: Outcome) -> None:
        """Publish the outcome."""
        self._server.finish(self, outcome)


class Ros2ActionServer:
    """Action server of the ``ros2`` backend."""

    def __init__(
        self, node: Ros2Node, name: str, type_name: str, execute: Execute, policy: ActionPolicy
    ) -> None:
        self.name = name
        self._node = node
        self._impl: Any = node.schema.message_class(type_name).Impl
        self._under_way = ServedGoals(node.clock, node.factory, name, type_name, execute, policy, node.log)
        self._goals: dict[str, _ServedGoal] = {}
        self._closed = False
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

    def publish_feedback(self, identity: Any, message: Any) -> None:
        """Publish feedback of a goal."""
        if not self._closed and not self._node.ended:
            self._feedback.publish(self._impl.FeedbackMessage(goal_id=identity, feedback=message))

    def finish(self, goal: _ServedGoal, outcome: Outcome) -> None:
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

    def close(self) -> None:
        """Stop offering the action."""
        if self._closed:
            return
        self._under_way.close()
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
        goal = self._goals[identity] = _ServedGoal(self, GoalInfo(goal_id=request.goal_id, stamp=stamp))
        self._publish_status()
        goal.status = EXECUTING
        self._under_way.begin(identity, request.goal, goal.feedback, goal.ended)
        self._publish_status()

    def _cancel(self, request: Any, respond: Respond) -> None:
        """Cancel as ``action_msgs/srv/CancelGoal`` defines: one goal, all up to a time, or all."""
        meant = self._meant(request.goal_info)
        agreed = [goal for goal in meant if self._under_way.cancel(goal_id(goal.info.goal_id))]
        for goal in agreed:
            if goal.response is None:
                goal.status = CANCELING
        respond(self._cancel_response(request.goal_info, meant, agreed))
        if agreed:
            self._publish_status()

    def _meant(self, info: Any) -> list[_ServedGoal]:
        identity, until = goal_id(info.goal_id), (info.stamp.sec, info.stamp.nanosec)
        one, timed = int(identity, 16) != 0, until != (0, 0)
        return [
            goal
            for known, goal in self._goals.items()
            if goal.response is None
            and (
                (not one and not timed)
                or (one and known == identity)
                or (timed and (goal.info.stamp.sec, goal.info.stamp.nanosec) <= until)
            )
        ]

    def _cancel_response(self, info: Any, meant: list[_ServedGoal], agreed: list[_ServedGoal]) -> Any:
        response = CancelGoal.Response(goals_canceling=[goal.info for goal in agreed])
        identity = goal_id(info.goal_id)
        if agreed:
            response.return_code = CancelGoal.Response.ERROR_NONE
        elif meant:
            response.return_code = CancelGoal.Response.ERROR_REJECTED
        elif int(identity, 16) == 0:
            response.return_code = CancelGoal.Response.ERROR_NONE
        elif identity in self._goals:
            response.return_code = CancelGoal.Response.ERROR_GOAL_TERMINATED
        else:
            response.return_code = CancelGoal.Response.ERROR_UNKNOWN_GOAL_ID
        return response

    def _tell_result(self, request: Any, respond: Respond) -> None:
        goal = self._goals.get(goal_id(request.goal_id))
        if goal is None:
            respond(self._impl.GetResultService.Response(status=UNKNOWN))
        elif goal.response is None:
            goal.asking.append(respond)
        else:
            respond(goal.response)

    def _publish_status(self) -> None:
        if self._closed or self._node.ended:
            return
        listed = [GoalStatus(goal_info=goal.info, status=goal.status) for goal in self._goals.values()]
        self._status.publish(GoalStatusArray(status_list=listed))
