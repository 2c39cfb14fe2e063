"""``rclpy.action``: action clients.

They send to the action servers of the memory graph without the care that JaCaROS's own client takes: a goal goes out
immediately, whatever became of the goals before.
"""

from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

from jacaros.robots.ros.action import GoalOutcome, GoalStatus
from virtual_rclpy.messages import Interface
from virtual_rclpy.node import Node
from virtual_rclpy.task import Future

_STATUS = {GoalStatus.SUCCEEDED: 4, GoalStatus.CANCELED: 5, GoalStatus.ABORTED: 6}
"""``action_msgs/msg/GoalStatus``."""


class ClientGoalHandle:
    """A goal that its server has accepted or rejected."""

    def __init__(
        self, client: "ActionClient", goal_id: str, accepted: bool, cancel: Callable[[], None]
    ) -> None:
        self.accepted = accepted
        self._client, self._goal_id, self._cancel = client, goal_id, cancel
        self.result, self.cancelled = Future(client.graph), Future(client.graph)

    def cancel_goal(self) -> Any:
        """Ask the server to cancel the goal, and wait for its answer."""
        answer = self.cancel_goal_async()
        self._client.graph.wait(answer.done)
        return answer.result()

    def get_result_async(self) -> Future:
        """Return the future of ``status`` and ``result``."""
        return self.result

    def cancel_goal_async(self) -> Future:
        """Ask the server to cancel the goal."""
        self._cancel()
        return self.cancelled


class ActionClient:
    """Sends goals of one action."""

    closed = False
    """Whether the graph may take it for gone: it lives as long as the program."""

    def __init__(
        self, node: Node, action_type: Interface, action_name: str, *, callback_group: Any = None
    ) -> None:
        self.graph = node.graph
        self.name = node.backend.resolve(action_name)
        self._new_id = node.backend.new_goal_id
        self._feedback: dict[str, Callable[[Any], object] | None] = {}
        self._sent: dict[str, tuple[Any, Future]] = {}
        self._handles: dict[str, ClientGoalHandle] = {}

    def server_is_ready(self) -> bool:
        """Return whether a server offers the action."""
        return self.graph.graph.find("action", self.name) is not None

    def wait_for_server(self, timeout_sec: float | None = None) -> bool:
        """Wait until a server offers the action; return False at the timeout, in seconds."""
        return self.graph.wait_for(self.server_is_ready, timeout_sec)

    def send_goal_async(self, goal: Any, feedback_callback: Callable[[Any], object] | None = None) -> Future:
        """Send a goal; the future's result is its `ClientGoalHandle`."""
        goal_id, answer = self._new_id(), Future(self.graph)
        server = self.graph.graph.find("action", self.name)
        if server is not None:
            self._sent[goal_id], self._feedback[goal_id] = (server, answer), feedback_callback
            self.graph.graph.tell(server.take, goal_id, goal, self)
        return answer

    # What the server tells:

    def accepted(self, goal_id: str) -> None:
        """The server has accepted a goal."""
        self._answered(goal_id, True)

    def rejected(self, goal_id: str, text: str = "") -> None:
        """The server has rejected a goal."""
        self._answered(goal_id, False)
        self._handles[goal_id].result.arrive(SimpleNamespace(status=0, result=None))  # unknown

    def _answered(self, goal_id: str, accepted: bool) -> None:
        server, answer = self._sent.pop(goal_id)

        def cancel() -> None:
            self.graph.graph.tell(server.cancel, goal_id, self)

        self._handles[goal_id] = ClientGoalHandle(self, goal_id, accepted, cancel)
        answer.arrive(self._handles[goal_id])

    def feedback(self, goal_id: str, message: Any) -> None:
        """The server has sent feedback."""
        callback = self._feedback.get(goal_id)
        if callback is not None:
            self.graph.call(callback, SimpleNamespace(feedback=message))

    def ended(self, goal_id: str, outcome: GoalOutcome) -> None:
        """A goal is over."""
        handle = self._handles[goal_id]
        handle.result.arrive(SimpleNamespace(status=_STATUS[outcome.status], result=outcome.result))

    def cancel_answered(self, goal_id: str, agreed: bool) -> None:
        """The server has answered a request to cancel a goal."""
        self._handles[goal_id].cancelled.arrive(SimpleNamespace(goals_canceling=[goal_id] if agreed else []))
