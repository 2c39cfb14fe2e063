"""Actions of the bridge, both ways, as rosbridge for ROS 2 carries them."""

import asyncio
import base64
import itertools
import uuid
from typing import TYPE_CHECKING, Any

from conversion import Mismatch, from_json, to_json

from jacaros.robots.ros.action import Abort, GoalStatus, ServerGoal
from jacaros.robots.ros.errors import GoalRejected, ServerUnavailable, ServiceError
from jacaros.robots.ros.names import action_type, feedback_type, goal_type, result_type

if TYPE_CHECKING:
    from connection import Connection
    from server import Bridge

SERVER_TIMEOUT = 1.0
"""Seconds for which the bridge looks for an action's server."""
NUMBERS = {GoalStatus.SUCCEEDED: 4, GoalStatus.CANCELED: 5, GoalStatus.ABORTED: 6}


class SentGoals:
    """Goals of the clients, and the status topics where they appear.

    Args:
        bridge: whose clients send them.
    """

    def __init__(self, bridge: "Bridge") -> None:
        self._bridge = bridge
        self._handles: dict[str, Any] = {}
        self._statuses: dict[str, dict[str, int]] = {}
        self.under_way: list[str] = []
        """Actions with a client of the bridge's own."""

    async def send(self, connection: "Connection", message: dict[str, Any]) -> None:
        """Send a goal and see it through, as the server's own thread for it does."""
        node, number, action = self._bridge.node, message.get("id"), message["action"]
        kind = action_type(message["action_type"])

        def fail(text: str) -> None:
            connection.status("error", f"send_action_goal Exception: {number}", number)
            end = {"values": text, "status": 0, "result": False, "id": number}
            connection.send({"op": "action_result", "action": action, **end})

        def feedback(given: Any) -> None:
            values = to_json(node, feedback_type(kind), given, False)
            connection.send({"op": "action_feedback", "action": action, "values": values, "id": number})

        client = node.action_client(action, kind)
        self.under_way.append(action)
        key = uuid.uuid4().bytes
        try:
            goal = from_json(node, goal_type(kind), message.get("args") or {}, False)
            if not client.ready:
                await asyncio.sleep(0)
            async with asyncio.timeout(SERVER_TIMEOUT if not client.ready else None):
                handle = await client.send(goal, feedback if message.get("feedback") else None)
            self._handles[str(number)] = (handle, action, key)
            self.note(action, key, 2)
            outcome = await handle.outcome()
            self.note(action, key, NUMBERS[outcome.status])
            values = to_json(node, result_type(kind), outcome.result, False)
            end = {"values": values, "status": NUMBERS[outcome.status], "result": True, "id": number}
            connection.send({"op": "action_result", "action": action, **end})
        except GoalRejected:
            fail("Action goal was rejected")
        except (TimeoutError, ServerUnavailable):
            fail("No action server available")
        except Mismatch as problem:
            fail(str(problem))
        except ServiceError:
            pass  # the server died: the genuine bridge waits on, and says nothing
        finally:
            self._handles.pop(str(number), None)
            self.under_way.remove(action)

    async def cancel(self, message: dict[str, Any]) -> None:
        """Request cancellation without an answer to the client."""
        handle, action, key = self._handles.get(str(message.get("id")), (None, "", b""))
        if handle is not None and await handle.cancel() and handle.end is None:
            self.note(action, key, 3)

    def note(self, action: str, key: bytes, number: int) -> None:
        """Change a goal's status and publish it."""
        goals = self._statuses.setdefault(action, {})
        if goals.get(key.hex(), 0) < 4:
            goals[key.hex()] = number
        for connection in list(self._bridge.connections):
            connection.tell_status(action)

    def status_array(self, action: str) -> dict[str, Any]:
        """What the status topic of an action shows."""
        found = []
        for key, number in self._statuses.get(action, {}).items():
            name = base64.b64encode(bytes.fromhex(key)).decode()
            info = {"goal_id": {"uuid": name}, "stamp": {"sec": 0, "nanosec": 0}}
            found.append({"goal_info": info, "status": number})
        return {"status_list": found}


class AdvertisedAction:
    """An action that a client serves."""

    _numbers = itertools.count(1)

    def __init__(self, connection: "Connection", name: str, type_name: str) -> None:
        self.name = name
        self._connection = connection
        self._type = action_type(type_name)
        self._node = connection.bridge.node
        self._goals: dict[str, tuple[ServerGoal, asyncio.Future[dict[str, Any]]]] = {}
        self._server = self._node.action_server(name, self._type, self._execute)

    async def _execute(self, goal: ServerGoal) -> Any:
        number = f"action_goal:{self.name}:{next(self._numbers)}"
        future: asyncio.Future[dict[str, Any]] = asyncio.get_running_loop().create_future()
        self._goals[number] = (goal, future)
        arguments = to_json(self._node, goal_type(self._type), goal.request, False)
        sent = {"op": "send_action_goal", "id": number, "action": self.name, "action_type": self._type}
        self._connection.send({**sent, "args": arguments, "feedback": True})
        try:
            message = await self._end(goal, future, number)
        finally:
            del self._goals[number]
        if not message["result"]:
            raise Abort("aborted by the client")
        result = from_json(self._node, result_type(self._type), message.get("values") or {}, False)
        if message["status"] == 4 or (message["status"] == 5 and goal.cancel_requested):
            return result
        raise Abort("", result)

    async def _end(self, goal: ServerGoal, future: "asyncio.Future[Any]", number: str) -> Any:
        while True:
            try:
                return await asyncio.shield(future)
            except asyncio.CancelledError:
                if not goal.cancel_requested or future.cancelled():
                    raise
                self._connection.send({"op": "cancel_action_goal", "id": number, "action": self.name})

    def feedback(self, message: dict[str, Any]) -> None:
        """Pass feedback of the client on."""
        if message["id"] in self._goals:
            goal, _ = self._goals[message["id"]]
            goal.feedback(from_json(self._node, feedback_type(self._type), message["values"], False))

    def result(self, message: dict[str, Any]) -> None:
        """Pass the end on."""
        if message["id"] in self._goals:
            _, future = self._goals[message["id"]]
            if not future.done():
                future.set_result(message)

    def close(self) -> None:
        """The client has gone, or no longer offers the action: its goals are aborted."""
        self._server.close()
