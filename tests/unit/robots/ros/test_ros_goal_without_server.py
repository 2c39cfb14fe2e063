"""Sending a goal to a server that was seen, but is gone when the goal is sent."""

import asyncio
from typing import Any

import pytest

from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.errors import ServerUnavailable
from jacaros.robots.ros.typestore import DefinitionSchema
from jacaros.runtime.clock import VirtualClock, run

COUNT = "jacaros_interfaces/action/Count"


class Carrier:
    """A wire that finds no server for the first goals.

    Args:
        clock: of the client.
        absent: number of goals without a server.
    """

    offered = True

    def __init__(self, clock: VirtualClock, absent: float) -> None:
        self.sent: list[str] = []
        self._absent = absent
        self._loop = asyncio.get_running_loop()
        self.sender = ActionClient(clock, print, DefinitionSchema(), "/count", COUNT)
        self.sender.wire = self

    def new_id(self) -> str:
        return f"goal{len(self.sent)}"

    def send_goal(self, goal_id: str, goal: Any) -> None:
        self.sent.append(goal_id)
        if len(self.sent) <= self._absent:
            self._loop.call_soon(self.sender.fail, goal_id, ServerUnavailable("no server"))
        else:
            self._loop.call_soon(self.sender.accepted, goal_id)

    def cancel_goal(self, goal_id: str) -> None:
        pass

    def forget_goal(self, goal_id: str) -> None:
        pass

    def close(self) -> None:
        pass


def test_it_is_sent_again_as_long_as_there_is_time() -> None:
    clock = VirtualClock()

    async def scene() -> None:
        carrier = Carrier(clock, absent=3)
        goal = await carrier.sender.send({"target": 1}, timeout=2.0)
        assert goal.goal_id == "goal3"
        assert len(carrier.sent) == 4
        assert clock.elapsed < 1.0

    run(scene, clock)


def test_the_timeout_reports_that_no_server_offers_the_action() -> None:
    clock = VirtualClock()

    async def scene() -> None:
        carrier = Carrier(clock, absent=float("inf"))
        with pytest.raises(
            ServerUnavailable, match=r"no server offered action /count \(.*Count\) within 2 s"
        ):
            await carrier.sender.send({"target": 1}, timeout=2.0)
        assert 1.8 <= clock.elapsed <= 2.0
        assert not carrier.sender.busy

    run(scene, clock)
