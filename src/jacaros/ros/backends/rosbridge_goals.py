"""Action clients and servers of `RosbridgeBackend`: the side of ROS 1 or that of ROS 2, as soon as it is known which."""

from typing import Any

from jacaros.ros.action import ActionPolicy, Execute
from jacaros.ros.action_calling import GoalSender, GoalWire
from jacaros.ros.actionlib_client import ActionlibWire
from jacaros.ros.actionlib_server import ActionlibServer
from jacaros.ros.backends.rosbridge_actionlib import ActionTopics
from jacaros.ros.backends.rosbridge_actions import Ros2Goals, Ros2GoalService
from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.errors import CallFailed, ServerLost

LOST_LINK = "the connection to the rosbridge server was lost during goal {}; whether it goes on is not known"


class BridgeActionClient(GoalSender):
    """Action client of `RosbridgeBackend`."""

    def __init__(self, node: BridgeNode, name: str, type_name: str) -> None:
        super().__init__(
            node.clock, node.log, node.factory, name, type_name, node.leaving_goals, node.orphans
        )
        self._node = node
        self._wire = _Wire(node, self)
        self.wire = self._wire
        if node.attached:
            self.join()

    def join(self) -> None:
        """The link is up."""
        self._wire.join()

    def lost(self) -> None:
        """The link is down, and what a goal does meanwhile would be told to nobody."""
        for goal_id in list(self._goals):
            self.fail(goal_id, ServerLost(LOST_LINK.format(goal_id)))

    def close(self) -> None:
        """Give the client up."""
        super().close()
        self._node.members.drop(self)


class _Wire:
    """The `GoalWire` that fits the robot's ROS."""

    def __init__(self, node: BridgeNode, sender: GoalSender) -> None:
        self._node = node
        self._sender = sender
        self._version = 0
        self._fitting: GoalWire | None = None

    def join(self) -> None:
        if self._version != self._node.ros_version:
            self.close()
            self._version = self._node.ros_version
            self._fitting = (
                ActionlibWire(ActionTopics(self._node), self._sender)
                if self._version == 1
                else Ros2Goals(self._node, self._sender)
            )
        if self._sender.busy:
            _ = self.offered  # begins to ask

    @property
    def offered(self) -> bool:
        return self._fitting is not None and self._node.connected and self._fitting.offered

    def new_id(self) -> str:
        return self._known.new_id()

    def send_goal(self, goal_id: str, goal: Any) -> None:
        self._known.send_goal(goal_id, goal)

    def cancel_goal(self, goal_id: str) -> None:
        self._known.cancel_goal(goal_id)

    def adopt_goal(self, goal_id: str) -> None:
        self._known.adopt_goal(goal_id)

    def forget_goal(self, goal_id: str) -> None:
        if self._fitting is not None:
            self._fitting.forget_goal(goal_id)

    def close(self) -> None:
        if self._fitting is not None:
            self._fitting.close()

    @property
    def _known(self) -> GoalWire:
        if self._fitting is None or not self._node.attached:
            raise CallFailed(f"action {self._sender.name}: there is no connection to the rosbridge server")
        return self._fitting


class BridgeActionServer:
    """Action server of `RosbridgeBackend`."""

    def __init__(
        self, node: BridgeNode, name: str, type_name: str, execute: Execute, policy: ActionPolicy
    ) -> None:
        self.name = name
        self._node = node
        self._offer = (name, type_name, execute, policy)
        self._service: ActionlibServer | Ros2GoalService | None = None
        if node.attached:
            self.join()

    def join(self) -> None:
        """The link is up: offer the action."""
        if self._node.ros_version == 1:
            self._service = ActionlibServer(ActionTopics(self._node), *self._offer)
        else:
            self._service = Ros2GoalService(self._node, *self._offer)

    def lost(self) -> None:
        """The link is down: clients see the action go away, so nothing is to go on behind their backs."""
        if self._service is not None:
            self._service.abandon()
            self._service = None

    def close(self) -> None:
        """Stop to offer the action."""
        self._node.members.drop(self)
        if self._service is not None:
            self._service.close()
            self._service = None

    def goal(self, message: dict[str, Any]) -> None:
        """Take a goal of the bridge (ROS 2)."""
        if isinstance(self._service, Ros2GoalService):
            self._service.goal(message)

    def cancel(self, goal_id: str) -> None:
        """Take a request for cancelling of the bridge (ROS 2)."""
        if isinstance(self._service, Ros2GoalService):
            self._service.cancel(goal_id)
