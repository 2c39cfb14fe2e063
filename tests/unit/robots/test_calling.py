"""Operations over services: outputs, reasons, refusals, and requests that do not fit."""

import asyncio
from typing import Any

import pytest
from robot_lab import Lab

from jacaros.artifacts import Out, operation
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.action import SERVER_LOST_AFTER
from jacaros.robots.ros.open import open_backend

TRIGGER, SET_BOOL = "std_srvs/srv/Trigger", "std_srvs/srv/SetBool"


class Arm(RosArtifact):
    """Asks services."""

    def open(self) -> None:
        self.gripper = self.client("/grip", SET_BOOL)
        self.starter = self.client("/start", TRIGGER)
        self.emptier = self.client("/empty", "std_srvs/srv/Empty")

    @operation
    async def grip(self, closed: Any, message: Out) -> None:
        """Open or close; a refusal is a failure."""
        response = await self.call(self.gripper, 2.0, must_succeed=True, data=closed)
        message.set(response.message)

    @operation
    async def start_it(self, success: Out, message: Out) -> None:
        """Give what the service says."""
        response = await self.call(self.starter, 2.0)
        success.set(response.success)
        message.set(response.message)

    @operation
    async def ask_slowly(self) -> None:
        """Wait for an answer for up to a minute."""
        await self.call(self.client("/slow", TRIGGER), 60.0)

    @operation
    async def empty(self) -> None:
        """Request a transform that no node publishes."""
        await self.call(self.emptier, 2.0, must_succeed=True)


async def test_the_fields_of_a_response_come_back(lab: Lab) -> None:
    lab.backend.service("/start", TRIGGER, lambda request: {"success": False, "message": "no fuel"})
    artifact = await lab.make(Arm)
    success, message = Out(), Out()
    await lab.do(artifact, "start_it", success, message)
    assert (success.value, message.value) == (False, "no fuel")


async def test_a_service_that_refuses_fails_the_operation_that_wants_success(lab: Lab) -> None:
    said = {"success": False, "message": "jammed"}
    lab.backend.service("/grip", SET_BOOL, lambda request: said)
    artifact = await lab.make(Arm)
    refused = await lab.call(artifact, "grip", True, Out())
    assert refused.reason == 'refused("jammed")'
    assert refused.message == "service /grip refused: jammed"
    said.update(success=True, message="closed")
    out = Out()
    await lab.do(artifact, "grip", True, out)
    assert out.value == "closed"


async def test_a_server_that_disappears_during_a_call_is_lost_and_not_late(lab: Lab) -> None:
    graph: Any = lab.backend
    base = open_backend("memory", lab.clock, "base", log=lambda text: None, graph=graph.graph)
    await base.start()
    never = asyncio.get_running_loop().create_future()
    base.service("/slow", TRIGGER, lambda request: never)
    arm = await lab.make(Arm)
    waiting = lab.begin(arm, "ask_slowly")
    await lab.sleep(1)
    graph.graph.vanish("/base")
    began = lab.clock.elapsed
    await waiting.done
    assert waiting.reason == "server_lost"
    assert lab.clock.elapsed - began == pytest.approx(SERVER_LOST_AFTER)


async def test_a_request_that_does_not_fit_is_never_sent(lab: Lab) -> None:
    asked: list[Any] = []
    lab.backend.service("/grip", SET_BOOL, asked.append)
    artifact = await lab.make(Arm)
    wrong = await lab.call(artifact, "grip", "tight", Out())
    assert wrong.reason == 'wrong_value("data")'
    assert asked == []


async def test_wanting_success_of_a_service_that_says_nothing_about_it_is_a_mistake_of_the_artifact(
    lab: Lab,
) -> None:
    lab.backend.service("/empty", "std_srvs/srv/Empty", lambda request: None)
    artifact = await lab.make(Arm)
    ended = await lab.call(artifact, "empty")
    assert not ended.ok
    assert any("has no field `success`" in line for line in lab.logged)


async def test_dropping_a_call_does_not_wait(lab: Lab) -> None:
    async def slow(request: Any) -> dict[str, Any]:
        await lab.sleep(1)
        return {"success": True}

    lab.backend.service("/start", TRIGGER, slow)
    artifact = await lab.make(Arm)
    asking = lab.begin(artifact, "start_it", Out(), Out())
    await lab.sleep(0.1)
    await asking.drop(0.01)
    assert asking.execution.ended
    await lab.sleep(2)
    assert not asking.done.done()
