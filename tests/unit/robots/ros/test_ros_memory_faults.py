"""Faults that tests inject into the graph inside the process."""

import asyncio
from typing import Any

import pytest
from graph_lab import GraphLab

from jacaros.robots.ros.action import SERVER_LOST_AFTER, GoalStatus
from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.drivers.memory.graph import both, delayed, dropped, duplicated
from jacaros.robots.ros.errors import CallFailed, RosError, ServerLost, ServiceUnavailable
from jacaros.robots.ros.parameter import DeclaredParameter
from jacaros.robots.ros.qos import QoS

ADD, COUNT, INT = "example_interfaces/srv/AddTwoInts", "jacaros_interfaces/action/Count", "std_msgs/msg/Int32"


class Lab(GraphLab):
    """Two nodes, what one publishes on /n, and what the other got and when."""

    def __init__(self) -> None:
        super().__init__()
        self.got: list[tuple[float, int]] = []

    async def open(self) -> tuple[Backend, Backend]:
        here, there = await self.node("here"), await self.node("there")
        self.publisher = here.publisher("/n", INT, QoS(durability="transient_local", depth=1))
        there.subscription(
            "/n",
            INT,
            lambda sample: self.got.append((round(self.clock.elapsed, 3), sample.message.data)),
            QoS(durability="transient_local", depth=100),
        )
        return here, there

    async def publish(self, count: int, apart: float = 0.1) -> None:
        for number in range(count):
            self.publisher.publish(self.publisher.message(data=number))
            await self.clock.sleep(apart)

    async def count(self, goal: Any) -> Any:
        for number in range(goal.request.target):
            await self.clock.sleep(goal.request.period)
            goal.feedback(current=number)
        return {"last": goal.request.target}


async def goal_of_counting(lab: Lab) -> Any:
    """A goal that counts to 100, a second each."""
    here, there = await lab.open()
    there.action_server("/count", COUNT, lab.count)
    return await here.action_client("/count", COUNT).send({"target": 100, "period": 1.0})


async def test_messages_can_be_delayed_and_two_delays_add_up(lab: Lab) -> None:
    await lab.open()
    end = lab.graph.disturb("/n", delayed(0.25))
    await lab.publish(2)
    await lab.clock.sleep(1.0)
    assert lab.got == [(0.25, 0), (0.35, 1)]
    end()
    await lab.publish(1)
    assert lab.got[2:] == [(1.2, 0)]
    lab.graph.disturb("/n", both(delayed(1.0), delayed(2.0)))
    await lab.publish(1)
    await lab.clock.sleep(5.0)
    assert lab.got[3:] == [(4.3, 0)]


def test_a_jitter_lets_messages_overtake_each_other_in_the_same_way_each_time() -> None:
    seen = []

    async def scene(lab: Lab) -> None:
        await lab.open()
        lab.graph.disturb("/n", delayed(0.0, jitter=1.0, seed=4))
        await lab.publish(20)
        await lab.clock.sleep(2.0)
        seen.append(lab.got)

    for _ in range(2):
        Lab.play(scene)
    numbers = [number for _, number in seen[0]]
    assert sorted(numbers) == list(range(20)) != numbers
    assert seen[0] == seen[1]


async def test_messages_can_be_dropped_and_later_subscriptions_are_disturbed_too(lab: Lab) -> None:
    _, there = await lab.open()
    lab.graph.disturb("/n", dropped(0.5, seed=1))
    await lab.publish(200)
    assert 60 < len(lab.got) < 140
    lab.graph.disturb("/n", dropped())
    lab.got.clear()
    late: list[Any] = []
    there.subscription("/n", INT, late.append)
    await lab.publish(20)
    assert (lab.got, late) == ([], [])


async def test_messages_can_come_several_times_and_late(lab: Lab) -> None:
    await lab.open()
    lab.graph.disturb("/n", both(delayed(0.5), duplicated(3, apart=0.1)))
    await lab.publish(1, apart=2.0)
    assert lab.got == [(0.5, 0), (0.6, 0), (0.7, 0)]


async def test_a_vanished_node_is_silent(lab: Lab) -> None:
    here, there = await lab.open()
    hooked: list[str] = []
    here.add_exit_hook(lambda: hooked.append("ran"))
    lab.graph.vanish("/here")
    await lab.publish(2)
    assert (lab.got, hooked) == ([], [])
    assert (await there.contents()).nodes == ("/there",)
    with pytest.raises(RosError, match="was taken away"):
        here.publisher("/n", INT)
    with pytest.raises(RosError, match="unknown node, service or action: /nobody"):
        lab.graph.vanish("/nobody")


async def test_a_vanished_service_does_not_answer_and_its_loss_is_found_out(lab: Lab) -> None:
    here, there = await lab.open()
    ended: list[str] = []

    async def handle(request: Any) -> Any:
        try:
            await lab.clock.sleep(1.0)
        finally:
            ended.append("handler")

    there.service("/add", ADD, handle)
    client = here.client("/add", ADD)
    call = asyncio.get_running_loop().create_task(client.call({}))
    await lab.clock.sleep(0.5)
    lab.graph.vanish("/add")
    with pytest.raises(CallFailed, match="went away during the call"):
        await call
    assert (lab.clock.elapsed, ended, client.ready) == (0.5 + SERVER_LOST_AFTER, ["handler"], False)


async def test_a_server_in_the_place_of_a_vanished_one_does_not_know_its_goals(lab: Lab) -> None:
    here, there = await lab.open()
    there.action_server("/count", COUNT, lab.count)
    goal = await here.action_client("/count", COUNT).send({"target": 100, "period": 1.0})
    lab.graph.vanish("/count")
    await lab.clock.sleep(1.0)
    there.action_server("/count", COUNT, lab.count)
    with pytest.raises(ServerLost, match="was replaced by another"):
        await goal.outcome()
    assert lab.clock.elapsed == pytest.approx(1.0)


async def test_an_interrupted_graph_is_found_again_without_a_restart(lab: Lab) -> None:
    here, there = await lab.open()
    there.service("/add", ADD, lambda request: {"sum": request.a + request.b})
    connection: list[bool] = []
    ended: list[bool] = []
    here.on_connection(connection.append)
    here.on_connection(ended.append)()
    client = here.client("/add", ADD)
    await lab.publish(1)
    lab.graph.interrupt()
    await lab.publish(3)
    assert [number for _, number in lab.got] == [0]
    assert (here.connected, client.ready, lab.publisher.subscription_count) == (False, False, 0)
    with pytest.raises(ServiceUnavailable):
        await client.call({"a": 1, "b": 2}, timeout=0.5)
    call = asyncio.get_running_loop().create_task(client.call({"a": 1, "b": 2}))
    await lab.clock.sleep(1.0)
    lab.graph.restore()
    assert (await call).sum == 3
    await lab.clock.sleep(0.0)
    assert [number for _, number in lab.got] == [0, 2]  # what is latched comes again
    assert (connection, ended) == ([False, True], [])


async def test_a_short_interruption_does_not_lose_a_goal(lab: Lab) -> None:
    here, there = await lab.open()
    there.action_server("/count", COUNT, lab.count)
    client = here.action_client("/count", COUNT)
    feedback: list[int] = []
    goal = await client.send(
        {"target": 4, "period": 0.5}, on_feedback=lambda message: feedback.append(message.current)
    )
    await lab.clock.sleep(0.7)
    lab.graph.interrupt()
    await lab.clock.sleep(SERVER_LOST_AFTER - 0.5)  # the goal ends meanwhile
    lab.graph.restore()
    outcome = await goal.outcome(timeout=1.0)
    assert (outcome.status, outcome.result.last, feedback) == (GoalStatus.SUCCEEDED, 4, [0])


async def test_a_long_interruption_loses_a_goal(lab: Lab) -> None:
    goal = await goal_of_counting(lab)
    lab.graph.interrupt()
    with pytest.raises(ServerLost):
        await goal.outcome(timeout=60.0)


async def test_parameters_cannot_be_reached_in_an_interrupted_graph(lab: Lab) -> None:
    here, there = await lab.open()
    there.parameters().declare("speed", DeclaredParameter(1.0))
    lab.graph.interrupt()
    with pytest.raises(ServiceUnavailable, match="parameters of node /there"):
        await here.parameters("/there").get("speed", timeout=1.0)
    lab.graph.restore()
    assert await here.parameters("/there").get("speed", timeout=1.0) == 1.0


async def test_what_is_late_does_not_reach_a_closed_subscription(lab: Lab) -> None:
    _, there = await lab.open()
    got: list[Any] = []
    subscription = there.subscription("/n", INT, got.append)
    lab.graph.disturb("/n", delayed(1.0))
    await lab.publish(1)
    subscription.close()
    await lab.clock.sleep(5.0)
    assert got == []
    assert lab.got, "the other subscription has heard it"


async def test_one_silence_is_logged_once_however_many_deadlines_pass(lab: Lab) -> None:
    here, there = await lab.open()
    quality = QoS(deadline=0.5)
    there.subscription("/d", INT, lambda sample: None, quality)
    publisher = here.publisher("/d", INT, quality)
    for _ in range(2):
        publisher.publish(publisher.message(data=1))
        await lab.clock.sleep(10.0)
    assert sum("deadline" in line for line in lab.log) == 2
