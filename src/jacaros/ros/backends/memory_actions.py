"""Action servers and clients of `jacaros.ros.backends.memory`."""

from typing import Any

from jacaros.ros.action import ActionPolicy, Execute, Outcome
from jacaros.ros.action_calling import GoalSender
from jacaros.ros.action_serving import ServedGoals
from jacaros.ros.backends.memory_graph import MemoryGraph
from jacaros.ros.backends.memory_members import GoalLine, GraphActionServer
from jacaros.ros.backends.memory_node import MemoryNode
from jacaros.ros.errors import CallFailed


class MemoryActionServer:
    """Action server of `MemoryBackend`."""

    def __init__(
        self, node: MemoryNode, name: str, type_name: str, execute: Execute, policy: ActionPolicy
    ) -> None:
        self.name = name
        self.type_name = type_name
        self.vanished = False
        self._node = node
        self._graph = node.graph
        self._goals = ServedGoals(node.clock, node.factory, name, type_name, execute, policy, node.log)
        self._graph.offer_action(self)

    def take(self, goal_id: str, request: Any, wire: GoalLine) -> None:
        """Judge a goal and begin with it."""
        if self.vanished:
            return
        refusal = self._goals.judge(request)
        if refusal is not None:
            self._graph.tell(wire.sender.rejected, goal_id, refusal)
            return
        self._graph.tell(wire.sender.accepted, goal_id)
        self._goals.begin(goal_id, request, _News(self._graph, wire, goal_id))

    def cancel(self, goal_id: str, wire: GoalLine) -> None:
        """Handle a request for cancelling."""
        if not self.vanished:
            self._graph.tell(wire.sender.cancel_answered, goal_id, self._goals.cancel(goal_id))

    def close(self) -> None:
        """Stop to offer the action."""
        self._goals.close()
        self._leave()

    def vanish(self) -> None:
        """Be gone without a word: the clients of goals under way learn nothing."""
        self.vanished = True
        self._goals.abandon()
        self._leave()

    def _leave(self) -> None:
        self._graph.withdraw_action(self)
        self._node.forget(self)


class _News:
    """Brings the news of one goal to its client."""

    def __init__(self, graph: MemoryGraph, wire: GoalLine, goal_id: str) -> None:
        self._graph = graph
        self._wire = wire
        self._goal_id = goal_id

    def feedback(self, message: Any) -> None:
        if self._graph.up:  # else it is lost, as messages are
            self._graph.tell(self._wire.sender.feedback, self._goal_id, message)

    def ended(self, outcome: Outcome) -> None:
        self._graph.tell(self._wire.sender.ended, self._goal_id, outcome)


class MemoryGoalWire:
    """Carries goals from a `GoalSender` to the servers of the graph."""

    def __init__(self, node: MemoryNode, name: str, type_name: str) -> None:
        self.name = name
        self.graph = node.graph
        self.sender = GoalSender(node.clock, node.log, node.factory, name, type_name, node.leaving_goals)
        self.sender.wire = self
        self._node = node
        self._type_name = type_name
        self._servers: dict[str, GraphActionServer] = {}
        self.graph.connect(self)
        self._forget_hook = node.add_exit_hook(self._cancel_all)

    @property
    def offered(self) -> bool:
        """Whether a server offers the action."""
        return self.graph.action_server(self.name) is not None

    def new_id(self) -> str:
        """Number the node's goals."""
        return self._node.new_goal_id()

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Hand a goal to the server."""
        server = self.graph.action_server(self.name)
        if server is None:
            raise CallFailed(f"action {self.name} is not offered any more")
        if server.type_name != self._type_name:
            raise CallFailed(f"action {self.name} is of type {server.type_name}, not {self._type_name}")
        if not self._node.lifetime.admits():
            raise CallFailed(f"action {self.name}: the node is leaving the graph")
        self._servers[goal_id] = server
        self.graph.tell(server.take, goal_id, goal, self)

    def cancel_goal(self, goal_id: str) -> None:
        """Ask the goal's server to cancel it."""
        server = self._servers.get(goal_id)
        if server is not None and not self._node.vanished:
            self.graph.tell(server.cancel, goal_id, self)

    def adopt_goal(self, goal_id: str) -> None:
        """Never called: a graph inside the process has no earlier runs."""

    def forget_goal(self, goal_id: str) -> None:
        """The goal is over."""
        self._servers.pop(goal_id, None)

    def close(self) -> None:
        """Cancel the goals, and leave."""
        self.sender.close()  # which calls this again, when they are cancelled
        self._forget_hook()
        self.graph.disconnect(self)
        self._node.forget(self)

    def _cancel_all(self) -> None:
        """Cancel what is under way, as an exit hook."""
        for goal_id in list(self._servers):
            self.cancel_goal(goal_id)

    def server_came(self) -> None:
        """A server is there."""
        vanished = any(server.vanished for server in self._servers.values())
        self.sender.server_present(True, same=not vanished)

    def server_went(self) -> None:
        """There is no server any more."""
        self.sender.server_present(False)
