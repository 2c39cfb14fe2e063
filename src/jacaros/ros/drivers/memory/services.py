"""Services, actions and parameters of `jacaros.ros.drivers.memory.backend`: servers and clients."""

import asyncio
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from jacaros.ros.action import SERVER_LOST_AFTER, ActionPolicy, Execute, ServedGoals
from jacaros.ros.action_client import ActionClient
from jacaros.ros.drivers.memory.graph import GoalLine, GraphActionServer, GraphService, MemoryNode
from jacaros.ros.errors import CallFailed, CallTimedOut, CapabilityMissing, ServiceUnavailable
from jacaros.ros.names import request_type
from jacaros.ros.parameter import Declaration, ParameterValue
from jacaros.ros.parameter_store import DeclaredParameters
from jacaros.ros.services import Handler, ServiceClient, ServiceServer, server_gone
from jacaros.ros.waiting import Absence, Deadline, Waiting, settle, within


class MemoryService(ServiceServer[MemoryNode]):
    """Service of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, name: str, type_name: str, handler: Handler) -> None:
        node.schema.offered(type_name)
        super().__init__(node, name, type_name, handler)
        self._graph = node.graph
        self._vanished = False
        self._answers: set[asyncio.Future[Any]] = set()
        self._graph.offer(self)

    def handle(self, request: Any, answer: asyncio.Future[Any]) -> None:
        """Run the handler for one call."""

        def done(response: Any, problem: CallFailed | None) -> None:
            if self._vanished:
                return
            self._answers.discard(answer)
            if self._graph.up:
                settle(answer, response, problem)
            else:
                self._graph.tell(settle, answer, response, problem)

        self._answers.add(answer)
        self.answer(request, done)

    def _leave(self) -> None:
        self._graph.withdraw(self)

    def vanish(self) -> None:
        """Disappear without notice: its clients detect that after a while."""
        self._vanished = True
        for answer in self._answers:
            self._node.clock.call_later(
                SERVER_LOST_AFTER, partial(settle, answer, None, server_gone(self.name))
            )
        self._answers.clear()
        self.close()


class MemoryClient(ServiceClient[MemoryNode]):
    """Client of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, name: str, type_name: str) -> None:
        node.schema.service(type_name)
        super().__init__(node, name, type_name)

    @property
    def ready(self) -> bool:
        """Whether a node offers the service."""
        return self._node.graph.server(self.name) is not None

    async def call(self, request: Any = None, timeout: float | None = None) -> Any:
        """Call the service and return its response."""
        clock = self._node.clock
        message = self._node.factory.checked(request_type(self.type_name), request)
        deadline = Deadline(clock, timeout)
        server = await self._server(timeout)
        if server.type_name != self.type_name:
            raise CallFailed(f"service {self.name} is of type {server.type_name}, not {self.type_name}")
        answer = self._new_answer()
        server.handle(message, answer)
        try:
            return await within(clock, answer, deadline.left)
        except TimeoutError:
            raise CallTimedOut(f"service {self.name} did not answer within {timeout:g} s") from None

    async def _server(self, timeout: float | None) -> GraphService:
        graph = self._node.graph
        server = graph.server(self.name)
        while server is None:
            await come(self._node, f"service {self.name}", self._described, timeout, self._absence)
            server = graph.server(self.name)
        self._absence.end(self._node.log, self._described)
        return server


async def come(node: MemoryNode, thing: str, what: str, timeout: float | None, absence: Absence) -> None:
    """Wait until an entity has appeared in the graph, and log the wait.

    Args:
        node: the waiting node.
        thing: its name for `MemoryGraph.arrival`.
        what: its name for the log.
        timeout: seconds.
        absence: number of earlier waits, see `Waiting`.

    Raises:
        ServiceUnavailable: it has not appeared in time.
    """
    with Waiting(node.clock, node.log, what, "is the node that offers it running?", absence=absence):
        try:
            await within(node.clock, node.graph.arrival(thing), timeout)
        except TimeoutError:
            raise ServiceUnavailable(f"no node offered {what} within {timeout:g} s") from None


class MemoryActionServer:
    """Action server of `MemoryBackend`."""

    def __init__(
        self, node: MemoryNode, name: str, type_name: str, execute: Execute, policy: ActionPolicy
    ) -> None:
        node.schema.offered(type_name)
        self.name = name
        self.type_name = type_name
        self.vanished = False
        self._node = node
        self._graph = node.graph
        self._goals = ServedGoals(node.clock, node.factory, name, type_name, execute, policy, node.log)
        self._graph.offer_action(self)
        node.keep(self)

    def take(self, goal_id: str, request: Any, wire: GoalLine) -> None:
        """Accept a goal and begin it, or reject it."""
        if self.vanished:
            return
        refusal = self._goals.judge(request)
        if refusal is not None:
            self._graph.tell(wire.sender.rejected, goal_id, refusal)
            return
        tell, sender = self._graph.tell, wire.sender
        tell(sender.accepted, goal_id)

        def feedback(message: Any) -> None:
            if self._graph.up:  # otherwise it is lost, as messages are
                tell(sender.feedback, goal_id, message)

        self._goals.begin(goal_id, request, feedback, partial(tell, sender.ended, goal_id))

    def cancel(self, goal_id: str, wire: GoalLine) -> None:
        """Handle a request to cancel."""
        if not self.vanished:
            self._graph.tell(wire.sender.cancel_answered, goal_id, self._goals.cancel(goal_id))

    def close(self) -> None:
        """Stop offering the action."""
        self._goals.close()
        self._leave()

    def vanish(self) -> None:
        """Disappear without notice: the clients of active goals learn nothing."""
        self.vanished = True
        self._goals.abandon()
        self._leave()

    def _leave(self) -> None:
        self._graph.withdraw_action(self)
        self._node.forget(self)


class MemoryGoalWire:
    """Transfers goals from a `ActionClient` to the servers of the graph."""

    def __init__(self, node: MemoryNode, name: str, type_name: str) -> None:
        node.schema.action(type_name)
        self.name = name
        self.graph = node.graph
        self.sender = ActionClient(node.clock, node.log, node.factory, name, type_name, node.leaving_goals)
        self.sender.wire = self
        self._node = node
        self._type_name = type_name
        self._servers: dict[str, GraphActionServer] = {}
        self.graph.connect(self)
        self._forget_hook = node.add_exit_hook(self._cancel_all)

    @classmethod
    def client(cls, node: MemoryNode, name: str, type_name: str) -> ActionClient:
        """Make an action client for the port, and register its wire at the node."""
        return node.keep(cls(node, name, type_name)).sender

    @property
    def offered(self) -> bool:
        """Whether a server offers the action."""
        return self.graph.action_server(self.name) is not None

    def new_id(self) -> str:
        """Return a numbered id for a goal."""
        return self._node.new_goal_id()

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Pass a goal to the server."""
        server = self.graph.action_server(self.name)
        if server is None:
            raise CallFailed(f"action {self.name} is no longer offered")
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
        """Never called: an in-process graph has no earlier runs."""

    def forget_goal(self, goal_id: str) -> None:
        """Forget a goal that has ended."""
        self._servers.pop(goal_id, None)

    def close(self) -> None:
        """Cancel the goals, and leave."""
        self.sender.close()  # which calls this again after they are cancelled
        self._forget_hook()
        self.graph.disconnect(self)
        self._node.forget(self)

    def _cancel_all(self) -> None:
        """Exit hook: cancel the active goals."""
        for goal_id in list(self._servers):
            self.cancel_goal(goal_id)

    def server_came(self) -> None:
        """Note that there is a server."""
        vanished = any(server.vanished for server in self._servers.values())
        self.sender.server_present(True, same=not vanished)

    def server_went(self) -> None:
        """Note that there is no server."""
        self.sender.server_present(False)


class MemoryParameters:
    """The parameters of a node, seen from another node or from itself."""

    def __init__(self, asker: MemoryNode, node: str) -> None:
        self.node = node
        self._asker = asker
        self._absence = Absence()

    def declare(self, name: str, declaration: Declaration) -> ParameterValue:
        """Declare a parameter of our own node."""
        self._require_own()
        return self._asker.declared.declare(name, declaration)

    def withdraw(self, name: str) -> None:
        """Undeclare a parameter of our own node."""
        self._require_own()
        self._asker.declared.withdraw(name)

    async def names(self, timeout: float | None = None) -> list[str]:
        """Names of the node's parameters."""
        return (await self._store(timeout)).names()

    async def get(self, name: str, timeout: float | None = None) -> ParameterValue:
        """Return a parameter's value."""
        return (await self._store(timeout)).get(name)

    async def set(self, name: str, value: ParameterValue, timeout: float | None = None) -> None:
        """Change a parameter."""
        (await self._store(timeout)).set(name, value)
        await asyncio.sleep(0)  # the change is reported first, as on real graphs in most cases

    def on_change(self, callback: Callable[[Mapping[str, ParameterValue]], None]) -> Callable[[], None]:
        """Call *callback* with changed parameters."""
        return self._asker.graph.listen_to_parameters(self.node, callback)

    def _require_own(self) -> None:
        if self.node != self._asker.node_name:
            raise CapabilityMissing(
                f"only {self.node} itself can declare its parameters; {self._asker.node_name} can only get and set them"
            )

    async def _store(self, timeout: float | None) -> DeclaredParameters:
        if self.node == self._asker.node_name:
            return self._asker.declared
        graph = self._asker.graph
        node = graph.node(self.node)
        what = f"parameters of node {self.node}"
        while node is None:
            await come(self._asker, f"node {self.node}", what, timeout, self._absence)
            node = graph.node(self.node)
        self._absence.end(self._asker.log, what)
        return node.declared
