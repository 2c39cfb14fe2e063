"""actionlib's topics, on a graph inside the process: goals that the server never got."""

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest
from graph_lab import GraphLab

from jacaros.robots.ros.action import ActionPolicy, GoalStatus, ServerGoal
from jacaros.robots.ros.action_client import ActionClient, OrphanPolicy
from jacaros.robots.ros.actionlib import ActionlibServer, ActionlibWire
from jacaros.robots.ros.errors import CallTimedOut, GoalRejected
from jacaros.robots.ros.protocols.actionlib import OVERTAKEN, STATUS_PERIOD, part_type
from jacaros.robots.ros.protocols.rosbridge_messages import BridgeSchema

COUNT = "jacaros_interfaces/action/Count"


class Actionlib(GraphLab):
    """A server and a client of ``/count``; what the client publishes on its goal topic can be swallowed.

    Attributes:
        server: the server.
        began, stopped: targets of the goals that the server has begun, and of those that it was to cancel.
        swallowed: goal messages that are lost from now on.
        sent: goal messages that left the client.
    """

    def __init__(self) -> None:
        super().__init__()
        self.began: list[int] = []
        self.stopped: list[int] = []
        self.swallowed = 0
        self.sent = 0

    async def open(self) -> ActionClient:
        schema = BridgeSchema()
        for part in ("ActionGoal", "ActionResult", "ActionFeedback"):
            schema.fields(part_type(COUNT, part))
        robot, here = await self.node("robot"), await self.node("client")
        policy = ActionPolicy(lambda goal: None if goal.target >= 0 else "less than nothing")
        self.server = ActionlibServer(robot, "/count", COUNT, self._count, policy)
        sender = ActionClient(self.clock, print, here.factory, "/count", COUNT)
        sender.wire = ActionlibWire(here, sender)
        goals = sender.wire._goal
        deliver = goals.publish

        def publish(message: Any) -> None:
            self.sent += 1
            if self.swallowed:
                self.swallowed -= 1
            else:
                deliver(message)

        goals.publish = sender.wire._goals._send = publish  # type: ignore[method-assign]
        return sender

    async def run_again(self, orphans: OrphanPolicy, name: str = "client") -> ActionClient:
        """Kill the client, and give the one of the next run, with a node called *name*."""
        self.graph.vanish("/client")
        here = await self.node(name, orphans=orphans)
        sender = ActionClient(
            self.clock, here.log, here.factory, "/count", COUNT, here.leaving_goals, here.orphans
        )
        sender.wire = ActionlibWire(here, sender)
        return sender

    async def _count(self, goal: ServerGoal) -> Any:
        self.began.append(goal.request.target)
        try:
            await self.clock.sleep(goal.request.period)
        except asyncio.CancelledError:
            self.stopped.append(goal.request.target)
            raise
        return {"last": goal.request.target}


async def test_the_goal_of_a_killed_run_is_cancelled_before_the_next_run_sends_one(lab: Actionlib) -> None:
    client = await lab.open()
    await client.send({"target": 3, "period": 900.0}, timeout=20)
    client = await lab.run_again("cancel")
    goal = await client.send({"target": 4, "period": 0.5}, timeout=20)
    assert lab.stopped == [3]
    assert (await goal.outcome(5)).status is GoalStatus.SUCCEEDED
    assert lab.began == [3, 4]
    found = "action /count is still executing a goal of an earlier run of this node"
    assert f"warning: {found}; cancelling it" in lab.log


@pytest.mark.parametrize(
    ("orphans", "name", "told"),
    [("keep", "client", 1), ("cancel", "client2", 0)],
    ids=["kept", "of another node"],
)
async def test_the_goal_of_a_killed_run_goes_on_by_request_or_if_it_is_of_another_node(
    lab: Actionlib, orphans: OrphanPolicy, name: str, told: int
) -> None:
    client = await lab.open()
    await client.send({"target": 3, "period": 900.0}, timeout=20)
    client = await lab.run_again(orphans, name)
    await client.send({"target": 4, "period": 0.5}, timeout=20)
    await lab.clock.sleep(5)
    assert lab.stopped == []
    found = "action /count is still executing a goal of an earlier run of this node; the robot may be moving"
    assert [line for line in lab.log if "earlier run" in line] == [f"warning: {found}"] * told


async def test_a_server_is_ready_after_its_first_message_on_all_topics(lab: Actionlib) -> None:
    """A publisher is seen a moment before it knows its subscriber; a result in that moment would be lost."""
    client = await lab.open()
    wire = client.wire
    assert isinstance(wire, ActionlibWire)
    result = wire._result
    wire._result = SimpleNamespace(publisher_count=0)  # type: ignore[assignment]
    await lab.clock.sleep(2.0)
    assert not wire.offered
    wire._result = result
    assert not wire.offered
    await lab.clock.sleep(1.1 * STATUS_PERIOD)
    assert wire.offered


async def test_a_goal_that_was_lost_on_its_way_is_sent_again(lab: Actionlib) -> None:
    client = await lab.open()
    lab.swallowed = 1
    begun = lab.clock.elapsed
    goal = await client.send({"target": 3, "period": 0.5}, timeout=20)
    assert 1.0 <= lab.clock.elapsed - begun < 3.0
    assert (await goal.outcome(5)).status is GoalStatus.SUCCEEDED
    assert lab.began == [3]
    assert lab.sent == 2


async def test_a_goal_that_arrived_is_sent_once(lab: Actionlib) -> None:
    client = await lab.open()
    goal = await client.send({"target": 3, "period": 9.0}, timeout=20)
    assert (await goal.outcome(20)).status is GoalStatus.SUCCEEDED
    assert lab.sent == 1


async def test_an_abandoned_goal_is_not_sent_again(lab: Actionlib) -> None:
    client = await lab.open()
    lab.swallowed = 1
    with pytest.raises(CallTimedOut):
        await client.send({"target": 3, "period": 0.5}, timeout=0.5)
    await lab.clock.sleep(10)
    assert (lab.sent, lab.began) == (1, [])


async def test_a_duplicate_goal_is_executed_once(lab: Actionlib) -> None:
    client = await lab.open()
    sent: list[Any] = []
    goals = client.wire._goal  # type: ignore[attr-defined]
    deliver = goals.publish

    def twice(message: Any) -> None:
        sent.append(message)
        deliver(message)
        deliver(message)

    goals.publish = twice
    goal = await client.send({"target": 3, "period": 0.5}, timeout=20)
    assert (await goal.outcome(5)).status is GoalStatus.SUCCEEDED
    await lab.clock.sleep(1)
    goals.publish(sent[0])
    await lab.clock.sleep(1)
    assert lab.began == [3]


async def test_a_client_that_ends_cancels_its_goals_also_where_the_server_is_quiet(lab: Actionlib) -> None:
    """Its status messages may be late on a bad network, and the robot drives on meanwhile."""
    client = await lab.open()
    await client.send({"target": 3, "period": 60.0}, timeout=20)
    lab.server._status.publish = lambda message: None  # type: ignore[method-assign]
    await lab.clock.sleep(1.5)
    assert not client.ready
    client.close()
    await lab.clock.sleep(0.1)
    assert lab.stopped == [3]


@pytest.mark.parametrize("period", [0.1, 8.0])
async def test_a_lost_goal_does_not_come_after_a_newer_one(lab: Actionlib, period: float) -> None:
    """A server that pursues one goal at a time would leave the newer one for it; who waits for it hears of that."""
    client = await lab.open()
    lab.swallowed = 1
    older = asyncio.create_task(client.send({"target": 3, "period": 0.5}))
    await lab.clock.sleep(0.3)
    newer = await client.send({"target": 4, "period": period}, timeout=5)
    assert (await newer.outcome(20)).status is GoalStatus.SUCCEEDED
    end = await (await older).outcome(3)
    assert (end.status, end.text) == (GoalStatus.CANCELED, OVERTAKEN)
    await lab.clock.sleep(8)
    assert lab.began == [4]


async def test_a_lost_goal_is_sent_again_when_a_newer_one_was_refused(lab: Actionlib) -> None:
    client = await lab.open()
    lab.swallowed = 1
    older = asyncio.create_task(client.send({"target": 3, "period": 0.5}, timeout=5))
    await lab.clock.sleep(0.3)
    with pytest.raises(GoalRejected):
        await client.send({"target": -1}, timeout=5)
    assert (await (await older).outcome(5)).status is GoalStatus.SUCCEEDED
    assert lab.began == [3]
