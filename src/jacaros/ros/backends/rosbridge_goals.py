"""Action clients and servers of `RosbridgeBackend`: the side of ROS 1 or that of ROS 2, as soon as it is known which."""

from typing import Any, Protocol

from jacaros.ros.action import ActionPolicy, Execute
from jacaros.ros.action_calling import GoalSender
from jacaros.ros.backends.rosbridge_actionlib import Ros1Goals, Ros1GoalService
from jacaros.ros.backends.rosbridge_actions import Ros2Goals, Ros2GoalService
from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.errors import CallFailed


class _Goals(Protocol):
    @property
    def offered(self) -> bool: ...
    def new_id(self) -> str: ...
    def send_goal(self, goal_id: str, goal: Any) -> None: ...
    def cancel_goal(self, goal_id: str) -> None: ...
    def forget_goal(self, goal_id: str) -> None: ...
    def close(self) -> None: ...
    def join(self) -> None: ...
    def lost(self) -> None: ...


class _GoalService(Protocol):
    def join(self) -> None: ...
    def lost(self) -> None: ...
    def close(self) -> None: ...
    def goal(self, message: dict[str, Any]) -> None: ...
    def cancel(self, goal_id: str) -> None: ...


class BridgeActionClient(GoalSender):
    """Action client of `RosbridgeBackend`."""

    def __init__(self, node: BridgeNode, name: str, type_name: str) -> None:
        super().__init__(node.clock, node.log, node.factory, name, type_name)
        self._node = node
        self._wire = _Wire(node, self)
        self.wire = self._wire
        if node.attached:
            self.join()

    def join(self) -> None:
        """The link is up."""
        self._wire.join()

    def lost(self) -> None:
        """The link is down."""
        self._wire.lost()

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
        self._goals: _Goals | None = None

    def join(self) -> None:
        if self._version != self._node.ros_version:
            self.close()
            self._version = self._node.ros_version
            self._goals = (Ros1Goals if self._version == 1 else Ros2Goals)(self._node, self._sender)
        elif self._goals is not None:
            self._goals.join()
        if self._sender.busy:
            _ = self.offered  # begins to ask

    def lost(self) -> None:
        if self._goals is not None:
            self._goals.lost()

    @property
    def offered(self) -> bool:
        return self._goals is not None and self._goals.offered

    def new_id(self) -> str:
        return self._known.new_id()

    def send_goal(self, goal_id: str, goal: Any) -> None:
        self._known.send_goal(goal_id, goal)

    def cancel_goal(self, goal_id: str) -> None:
        self._known.cancel_goal(goal_id)

    def forget_goal(self, goal_id: str) -> None:
        if self._goals is not None:
            self._goals.forget_goal(goal_id)

    def close(self) -> None:
        if self._goals is not None:
            self._goals.close()

    @property
    def _known(self) -> _Goals:
        if self._goals is None:
            raise CallFailed(f"action {self._sender.name}: there is no connection to the rosbridge server")
        return self._goals


class BridgeActionServer:
    """Action server of `RosbridgeBackend`."""

    def __init__(
        self, node: BridgeNode, name: str, type_name: str, execute: Execute, policy: ActionPolicy
    ) -> None:
        self.name = name
        self._node = node
        self._arguments = (node, name, type_name, execute, policy)
        self._version = 0
        self._service: _GoalService | None = None
        if node.attached:
            self.join()

    def join(self) -> None:
        """The link is up."""
        if self._version != self._node.ros_version:
            if self._service is not None:
                self._service.close()
            self._version = self._node.ros_version
            self._service = (Ros1GoalService if self._version == 1 else Ros2GoalService)(*self._arguments)
        if self._service is not None:
            self._service.join()

    def lost(self) -> None:
        """The link is down."""
        if self._service is not None:
            self._service.lost()

    def close(self) -> None:
        """Stop to offer the action."""
        self._node.members.drop(self)
        if self._service is not None:
            self._service.close()
            self._service = None

    def goal(self, message: dict[str, Any]) -> None:
        """Take a goal of the bridge (ROS 2)."""
        if self._service is not None:
            self._service.goal(message)

    def cancel(self, goal_id: str) -> None:
        """Take a request for cancelling of the bridge (ROS 2)."""
        if self._service is not None:
            self._service.cancel(goal_id)
