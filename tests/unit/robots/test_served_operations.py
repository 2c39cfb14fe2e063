"""Services and actions that an artifact offers, from the side of their clients."""

import asyncio
from typing import Any

import pytest
from robot_lab import Lab, Watcher, made

from jacaros.artifacts import ArtifactId, InvalidArtifact, OperationFailed, internal_operation, operation
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.action import ActionPolicy, GoalStatus
from jacaros.robots.ros.errors import CallFailed

COUNT = "jacaros_interfaces/action/Count"
FOLLOW = "nav2_msgs/action/NavigateToPose"


class Desk(RosArtifact):
    """Takes orders."""

    def open(self) -> None:
        self.define_property("orders", 0)
        self.carried_out: int | None = None
        self.service("order", "std_srvs/srv/SetBool", self.order)
        self.service("map", "nav_msgs/srv/GetMap", self.give_map)
        self.service("ping", "std_srvs/srv/Trigger", lambda request: {"success": True, "message": "pong"})
        self.action_server("carry", COUNT, self.carry, ActionPolicy(preempt=True))
        self.action_server("go", FOLLOW, self.go)

    @internal_operation
    def order(self, request: Any, reply: Any) -> None:
        """Count orders; none is taken without data."""
        self.update_property("orders", self.value("orders") + 1)
        if not request.data:
            self.fail("nothing is ordered")
        reply.set(success=True, message=f"number {self.value('orders')}")

    @internal_operation
    def give_map(self, request: Any, reply: Any) -> None:
        """Have no map."""
        self.fail("there is no map")

    @internal_operation
    async def carry(self, goal: Any, reply: Any) -> None:
        """Carry something until `done`."""
        target = goal.request.target
        self.carried_out = None
        self.define_property("order", target)
        try:
            goal.feedback(current=1)
            await self.until(lambda: self.carried_out is not None)
            reply.set(last=self.carried_out)
        finally:
            self.remove_property("order", target)

    @internal_operation
    async def go(self, goal: Any, reply: Any) -> None:
        """Go nowhere."""
        self.fail("no path", "aborted", 203)

    @operation
    def done(self, number: int) -> None:
        """Execute the order."""
        self.carried_out = number


pytestmark = [pytest.mark.world("empty"), made(Desk, "r1")]


async def test_a_request_is_an_operation_of_the_artifact(lab: Lab, watcher: Watcher) -> None:
    client = lab.backend.client("/r1/order", "std_srvs/srv/SetBool")
    first = await client.call({"data": True}, 5)
    assert (first.success, first.message) == (True, "number 1")
    refused = await client.call({"data": False}, 5)
    assert (refused.success, refused.message) == (False, "nothing is ordered")
    assert watcher.holds("orders") == [(1,)]  # the step that failed is undone


async def test_a_failure_that_the_response_has_no_place_for_fails_the_call(lab: Lab) -> None:
    await lab.make(Desk, "r1")
    client = lab.backend.client("/r1/map", "nav_msgs/srv/GetMap")
    with pytest.raises(CallFailed, match="there is no map"):
        await client.call({}, 5)


async def test_a_plain_function_answers_as_it_is(lab: Lab) -> None:
    await lab.make(Desk, "r1")
    answer = await lab.backend.client("/r1/ping", "std_srvs/srv/Trigger").call({}, 5)
    assert answer.message == "pong"


async def test_a_goal_waits_for_an_operation_of_an_agent(lab: Lab) -> None:
    desk = await lab.make(Desk, "r1")
    seen = lab.watch(desk)
    told: list[int] = []
    client = lab.backend.action_client("/r1/carry", COUNT)
    goal = await client.send({"target": 7}, lambda feedback: told.append(feedback.current), 5)
    await lab.sleep(1)
    assert seen.holds("order") == [(7,)]
    await lab.do(desk, "done", 8)
    outcome = await goal.outcome(5)
    assert (outcome.status, outcome.result.last, told) == (GoalStatus.SUCCEEDED, 8, [1])
    assert not seen.holds("order")


async def test_a_cancelled_goal_has_run_its_finally(lab: Lab, watcher: Watcher) -> None:
    client = lab.backend.action_client("/r1/carry", COUNT)
    goal = await client.send({"target": 7}, timeout=5)
    await lab.sleep(1)
    assert await goal.cancel(5)
    assert (await goal.outcome(5)).status is GoalStatus.CANCELED
    assert not watcher.holds("order")


async def test_a_newer_goal_begins_when_the_older_has_ended(lab: Lab) -> None:
    desk = await lab.make(Desk, "r1")
    seen = lab.watch(desk)
    client = lab.backend.action_client("/r1/carry", COUNT)
    older = await client.send({"target": 7}, timeout=5)
    await lab.sleep(1)
    newer = await client.send({"target": 8}, timeout=5)
    assert (await older.outcome(5)).text == "preempted by a newer goal"
    await lab.sleep(1)
    assert seen.holds("order") == [(8,)]
    await lab.do(desk, "done", 1)
    assert (await newer.outcome(5)).status is GoalStatus.SUCCEEDED


async def test_a_failing_goal_is_aborted_with_the_code_of_its_reason(lab: Lab) -> None:
    await lab.make(Desk, "r1")
    goal = await lab.backend.action_client("/r1/go", FOLLOW).send({}, timeout=5)
    outcome = await goal.outcome(5)
    assert (outcome.status, outcome.text, outcome.result.error_code) == (GoalStatus.ABORTED, "no path", 203)


async def test_clients_are_notified_when_the_artifact_is_disposed(lab: Lab, artifact: ArtifactId) -> None:
    client = lab.backend.action_client("/r1/carry", COUNT)
    goal = await client.send({"target": 7}, timeout=5)
    await lab.sleep(1)
    lab.workspace.dispose_artifact(artifact)
    assert (await goal.outcome(5)).status is GoalStatus.ABORTED
    await asyncio.sleep(0)
    assert not client.ready


async def test_an_operation_with_other_parameters_cannot_serve(lab: Lab) -> None:
    class Wrong(RosArtifact):
        """Offers what takes no reply."""

        def open(self) -> None:
            self.service("order", "std_srvs/srv/SetBool", self.order)

        @internal_operation
        def order(self, request: Any) -> None:
            """Take it."""

    with pytest.raises((OperationFailed, InvalidArtifact), match="two parameters, request and reply"):
        await lab.make(Wrong)
