"""A ROS graph inside the process: needs no installation, deterministic, as fast as the loop.

Topics, services, actions, parameters and quality of service behave as on ROS 2; the message classes have the original
definitions. A published message is passed by reference, one turn of the loop per message, in the
order of publishing; therefore messages are read-only from `publish` on.
"""

import asyncio
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from jacaros.robots.ros.action import SERVER_LOST_AFTER, ActionPolicy, ExecuteCallback, ServedGoals
from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.backend import Backend, GraphContents
from jacaros.robots.ros.drivers.memory.graph import (
    EntityKind,
    MemoryGraph,
    MemoryNode,
    MemoryPublisher,
    MemorySubscription,
)
from jacaros.robots.ros.errors import CallFailed, CallTimedOut, CapabilityMissing, ServiceUnavailable
from jacaros.robots.ros.names import request_type
from jacaros.robots.ros.node import Capability, Parts
from jacaros.robots.ros.parameter import DeclaredParameter, DeclaredParameters, ParameterValue
from jacaros.robots.ros.services import Handler, ServiceClient, ServiceServer, server_gone
from jacaros.robots.ros.waiting import Deadline, WaitLog, settle, within

__all__ = ["BACKEND", "MemoryBackend", "MemoryGraph"]


class MemoryService(ServiceServer[MemoryNode]):
    """Service of `MemoryBackend`."""

    def __init__(self, node: MemoryNode, name: str, type_name: str, handler: Handler) -> None:
        node.schema.offered(type_name)
        super().__init__(node, name, type_name, handler)
        self._graph = node.graph
        self._vanished = False
        self._answers: set[asyncio.Future[Any]] = set()
        self._graph.offer("service", name, self)

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
        self._graph.withdraw("service", self.name, self)

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
        node.schema.load(type_name)
        super().__init__(node, name, type_name)

    @property
    def ready(self) -> bool:
        """Whether a node offers the service."""
        return self._node.graph.find("service", self.name) is not None

    async def call(self, request: Any = None, timeout: float | None = None) -> Any:
        """Call the service and return its response."""
        node, clock = self._node, self._node.clock
        message = node.factory.checked(request_type(self.type_name), request)
        deadline = Deadline(clock, timeout)
        server = await awaited(node, "service", self.name, self._waiting, timeout)
        if server.type_name != self.type_name:
            raise CallFailed(f"service {self.name} is of type {server.type_name}, not {self.type_name}")
        answer = self._new_answer()
        server.handle(message, answer)
        try:
            return await within(clock, answer, deadline.left)
        except TimeoutError:
            raise CallTimedOut(f"service {self.name} did not answer within {timeout:g} s") from None


async def awaited(
    node: MemoryNode, kind: EntityKind, name: str, waiting: WaitLog, timeout: float | None
) -> Any:
    """Return a service or node as soon as it is in the graph.

    Args:
        node: the waiting node.
        kind, name: what it waits for.
        waiting: logs the waits.
        timeout: seconds.

    Raises:
        ServiceUnavailable: it has not appeared in time.
    """
    while (found := node.graph.find(kind, name)) is None:
        with waiting.during():
            try:
                await within(node.clock, node.graph.arrival(kind, name), timeout)
            except TimeoutError:
                raise ServiceUnavailable(f"no node offered {waiting.what} within {timeout:g} s") from None
    waiting.found()
    return found


class MemoryActionServer:
    """Action server of `MemoryBackend`."""

    def __init__(
        self, node: MemoryNode, name: str, type_name: str, execute: ExecuteCallback, policy: ActionPolicy
    ) -> None:
        node.schema.offered(type_name)
        self.name = name
        self.type_name = type_name
        self.vanished = False
        self._node = node
        self._graph = node.graph
        self._goals = ServedGoals(node.clock, node.factory, name, type_name, execute, policy, node.log)
        self._clients: set[ActionClient] = set()
        self._graph.offer("action", name, self)
        node.keep(self)

    def take(self, goal_id: str, request: Any, client: ActionClient) -> None:
        """Accept a goal and begin it, or reject it."""
        if self.vanished:
            return
        refusal = self._goals.judge(request)
        if refusal is not None:
            self._graph.tell(client.rejected, goal_id, refusal)
            return
        tell = self._graph.tell
        self._clients = {each for each in (*self._clients, client) if not each.closed}
        tell(client.accepted, goal_id)

        def feedback(message: Any) -> None:
            if self._graph.up:  # otherwise it is lost, as messages are
                tell(client.feedback, goal_id, message)

        self._goals.begin(goal_id, request, feedback, partial(tell, client.ended, goal_id))

    @property
    def abandoned(self) -> bool:
        """Whether the clients that have sent goals are closed."""
        return all(each.closed for each in self._clients)

    def cancel(self, goal_id: str, client: ActionClient) -> None:
        """Handle a request to cancel."""
        if not self.vanished:
            self._graph.tell(client.cancel_answered, goal_id, self._goals.cancel(goal_id))

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
        self._graph.withdraw("action", self.name, self)
        self._node.forget(self)


class MemoryGoalWire:
    """Transfers goals from an `ActionClient` to the servers of the graph."""

    def __init__(self, node: MemoryNode, client: ActionClient) -> None:
        self._node, self._client = node, client
        self._servers: dict[str, MemoryActionServer] = {}
        self._forget_server = node.graph.watch("action", client.name, self._server_present)
        self._forget_hook = node.add_exit_hook(self._cancel_all)

    @property
    def offered(self) -> bool:
        """Whether a server offers the action."""
        return self._node.graph.find("action", self._client.name) is not None

    def new_id(self) -> str:
        """Return a numbered id for a goal."""
        return self._node.new_goal_id()

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Pass a goal to the server."""
        name, kind, graph = self._client.name, self._client.type_name, self._node.graph
        server: MemoryActionServer | None = graph.find("action", name)
        if server is None:
            raise CallFailed(f"action {name} is no longer offered")
        if server.type_name != kind:
            raise CallFailed(f"action {name} is of type {server.type_name}, not {kind}")
        if not self._node.lifetime.admits():
            raise CallFailed(f"action {name}: the node is leaving the graph")
        self._servers[goal_id] = server
        graph.tell(server.take, goal_id, goal, self._client)

    def cancel_goal(self, goal_id: str) -> None:
        """Ask the goal's server to cancel it."""
        server = self._servers.get(goal_id)
        if server is not None and not self._node.vanished:
            self._node.graph.tell(server.cancel, goal_id, self._client)

    def adopt_goal(self, goal_id: str) -> None:
        """Never called: an in-process graph has no earlier runs."""

    def forget_goal(self, goal_id: str) -> None:
        """Forget a goal that has ended."""
        self._servers.pop(goal_id, None)

    def close(self) -> None:
        """Leave."""
        self._forget_hook()
        self._forget_server()
        self._node.forget(self._client)

    def _cancel_all(self) -> None:
        """Exit hook: cancel the active goals."""
        for goal_id in list(self._servers):
            self.cancel_goal(goal_id)

    def _server_present(self, present: bool) -> None:
        vanished = any(server.vanished for server in self._servers.values())
        self._client.server_present(present, same=not vanished)


def _action_client(node: MemoryNode, name: str, type_name: str) -> ActionClient:
    node.schema.load(type_name)
    client = ActionClient(node.clock, node.log, node.factory, name, type_name, node.leaving_goals)
    client.wire = MemoryGoalWire(node, client)
    return node.keep(client)


class MemoryParameters:
    """The parameters of a node, seen from another node or from itself."""

    def __init__(self, asker: MemoryNode, node: str) -> None:
        self.node = node
        self._asker = asker
        self._waiting = WaitLog(asker.clock, asker.log, f"parameters of node {node}")

    def declare(self, name: str, declaration: DeclaredParameter) -> ParameterValue:
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
        return self._asker.graph.parameter_listeners.listen(self.node, callback)

    def _require_own(self) -> None:
        if self.node != self._asker.node_name:
            raise CapabilityMissing(
                f"only {self.node} itself can declare its parameters; {self._asker.node_name} can only get and set them"
            )

    async def _store(self, timeout: float | None) -> DeclaredParameters:
        if self.node == self._asker.node_name:
            return self._asker.declared
        node: MemoryNode = await awaited(self._asker, "node", self.node, self._waiting, timeout)
        return node.declared


class MemoryBackend(MemoryNode):
    """A node in an in-process graph.

    Args:
        settings: names, clock and log.
        graph: the graph to join; default: a new one.
    """

    name = "memory"
    capabilities = frozenset(Capability) - {Capability.DISCOVERY, Capability.REGISTRATION}

    parts = Parts(
        publisher=MemoryPublisher,
        subscription=MemorySubscription,
        service=MemoryService,
        client=MemoryClient,
        action_client=_action_client,
        action_server=MemoryActionServer,
    )

    async def start(self) -> None:
        """Join the graph."""
        self.join()
        self.graph.join(self)
        self.set_connected(self.graph.up)

    async def close(self) -> None:
        """Run the exit hooks and leave the graph."""
        self.lifetime.stop()
        self.close_members()
        self.graph.withdraw("node", self.node_name, self)
        self.left()
        self.lifetime.left()

    def parameters(self, node: str | None = None) -> MemoryParameters:
        """Return the parameters of our own node, or of another."""
        return MemoryParameters(self, self.node_name if node is None else self.resolve(node))

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Return the contents of the graph."""
        if not self.graph.up:
            raise ServiceUnavailable("the graph is interrupted")
        return self.graph.contents()

    async def _publishers(self, topic: str) -> list[str]:
        return [publisher.node_name for publisher in self.graph.topic(topic).publishers]


BACKEND: type[Backend] = MemoryBackend
