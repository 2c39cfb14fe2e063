"""Commands of a peer about actions."""

import asyncio
from collections import defaultdict
from typing import Any

from jacaros.robots.ros.action import Abort, ActionPolicy
from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.message import plain
from jacaros.runtime.clock import Clock

COUNT = "jacaros_interfaces/action/Count"


class ActionCommands:
    """Serving and using actions; a part of `peer.Peer`."""

    _backend: Backend
    _clock: Clock

    def __init__(self) -> None:
        self._action_servers: dict[str, Any] = {}
        self._action_clients: dict[tuple[str, str], Any] = {}
        self._sends: dict[str, asyncio.Task[Any]] = {}
        self._goals: dict[str, Any] = {}
        self._waits: dict[str, asyncio.Task[Any]] = {}
        self._feedback: dict[str, list[Any]] = defaultdict(list)
        self._deeds: dict[str, list[Any]] = defaultdict(list)
        self._together = 0

    # The server's side

    def serve_action(
        self,
        name: str,
        behaviour: str = "count",
        type_name: str = COUNT,
        preempt: bool = False,
        may_cancel: bool = True,
    ) -> str:
        """Offer an action; it refuses negative targets."""
        deeds = self._deeds[name]

        def accept(goal: Any) -> str | None:
            return "the target is negative" if goal.target < 0 else None

        async def execute(goal: Any) -> Any:
            deeds.append(["begin", goal.request.target])
            try:
                return await getattr(self, f"_do_{behaviour}")(goal)
            finally:
                deeds.append(["end", goal.request.target, goal.cancel_requested])

        policy = ActionPolicy(accept, None if may_cancel else (lambda goal: False), preempt)
        server = self._action_servers[name] = self._backend.action_server(name, type_name, execute, policy)
        return server.name

    def unserve_action(self, name: str) -> None:
        self._action_servers.pop(name).close()

    def deeds(self, name: str) -> list[Any]:
        """What the action's code did: begin and end of each goal by its target, and whether cancelling was requested."""
        return self._deeds[name]

    async def _do_count(self, goal: Any) -> Any:
        for number in range(1, goal.request.target + 1):
            await self._clock.sleep(goal.request.period)
            goal.feedback(current=number)
        return {"last": goal.request.target, "message": "counted"}

    async def _do_count_together(self, goal: Any) -> Any:
        """Begin to count when three goals are under way."""
        self._together += 1
        while self._together < 3:
            await self._clock.sleep(0.01)
        return await self._do_count(goal)

    async def _do_count_and_tell_where(self, goal: Any) -> Any:
        """When it is cancelled it takes a moment to stop, and says how far it came."""
        number = 0
        try:
            while number < goal.request.target:
                await self._clock.sleep(goal.request.period)
                number += 1
                goal.feedback({"current": number})
        except asyncio.CancelledError:
            await self._clock.sleep(0.05)
            return {"last": number, "message": "stopped"}
        return {"last": number}

    async def _do_stop_slowly(self, goal: Any) -> Any:
        try:
            return await self._do_count(goal)
        finally:
            await self._clock.sleep(0.5)

    async def _do_nothing(self, goal: Any) -> None:
        return None

    async def _do_give_up(self, goal: Any) -> Any:
        raise Abort("cannot count so far", {"last": 1})

    async def _do_give_up_without_a_result(self, goal: Any) -> Any:
        raise Abort("cannot count")

    async def _do_fail(self, goal: Any) -> Any:
        raise ValueError("no numbers today")

    async def _do_answer_wrongly(self, goal: Any) -> Any:
        return {"total": 1}

    async def _do_tell_wrongly(self, goal: Any) -> Any:
        goal.feedback(currant=1)

    # The client's side

    async def send_goal(
        self, key: str, name: str, fields: Any, timeout: float | None = None, type_name: str = COUNT
    ) -> str:
        """Send a goal; gives its id."""
        client = self._action_client(name, type_name)
        handle = await client.send(
            fields, on_feedback=lambda m: self._feedback[key].append(plain(m)), timeout=timeout
        )
        self._goals[key] = handle
        return str(handle.goal_id)

    def begin_send(self, key: str, name: str, fields: Any, timeout: float | None = None) -> None:
        self._sends[key] = asyncio.get_running_loop().create_task(self.send_goal(key, name, fields, timeout))

    async def end_send(self, key: str) -> str:
        return str(await self._sends.pop(key))

    async def give_up_send(self, key: str) -> bool:
        task = self._sends.pop(key)
        task.cancel()
        await asyncio.wait([task])
        return task.cancelled()

    def feedback(self, key: str) -> list[int]:
        """Numbers of the feedback so far."""
        return [message["current"] for message in self._feedback[key]]

    def told(self, key: str) -> list[Any]:
        """Feedback so far."""
        return self._feedback[key]

    async def outcome(self, key: str, timeout: float | None = None) -> dict[str, Any]:
        outcome = await self._goals[key].outcome(timeout)
        return {"status": str(outcome.status), "result": plain(outcome.result), "text": outcome.text}

    def begin_outcome(self, key: str, timeout: float | None = None, waiter: str = "") -> None:
        self._waits[key + waiter] = asyncio.get_running_loop().create_task(self.outcome(key, timeout))

    def outcome_known(self, key: str) -> bool:
        return self._waits[key].done()

    async def end_outcome(self, key: str) -> dict[str, Any]:
        outcome: dict[str, Any] = await self._waits.pop(key)
        return outcome

    async def cancel_goal(self, key: str, timeout: float | None = None) -> bool:
        agreed: bool = await self._goals[key].cancel(timeout)
        return agreed

    def action_ready(self, name: str, type_name: str = COUNT) -> bool:
        return bool(self._action_client(name, type_name).ready)

    def close_action_client(self, name: str, type_name: str = COUNT) -> None:
        self._action_clients.pop((name, type_name)).close()

    def goal_message(self, name: str, type_name: str = COUNT, **fields: Any) -> Any:
        return plain(self._action_client(name, type_name).goal(**fields))

    def _action_client(self, name: str, type_name: str) -> Any:
        if (name, type_name) not in self._action_clients:
            self._action_clients[name, type_name] = self._backend.action_client(name, type_name)
        return self._action_clients[name, type_name]
