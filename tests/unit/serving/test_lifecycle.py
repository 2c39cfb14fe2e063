"""The agents' node as a managed node: what each state means for agents, robot and goals."""

import asyncio
from pathlib import Path
from typing import Any

import pytest

import jacaros
from jacaros import Mas, PythonAgent
from jacaros.robots.ros.errors import GoalRejected
from jacaros.serving.ros.lifecycle import LABELS, Lifecycle
from jacaros.serving.ros.opening import open_door

ROBOT = Path(__file__).parents[3] / "examples" / "01_out_and_back" / "out_and_back.jcm"
COUNTER = """
{ offer(goal, count(n(number), m(out(number)))) }
n(0). !run.
+!run <- -n(N); +n(N+1); .wait(100); !run.
+!count(N, N+1).
"""
MESSAGES = "lifecycle_msgs/srv/"


class Manager:
    """Another node that manages the agents' node."""

    def __init__(self, mas: Mas, node: str = "mas") -> None:
        self.node: Any = mas.system.ros.companion("manager")
        self._of = node
        self.events: list[tuple[str, str]] = []
        kind = "lifecycle_msgs/msg/TransitionEvent"
        self.node.subscription(f"{node}/transition_event", kind, lambda sample: self._hear(sample.message))

    def _hear(self, event: Any) -> None:
        self.events.append((event.start_state.label, event.goal_state.label))

    async def call(self, service: str, kind: str, **fields: Any) -> Any:
        return await self.node.client(f"{self._of}/{service}", MESSAGES + kind).call(fields, timeout=5)

    async def change(self, label: str) -> bool:
        answer = await self.call("change_state", "ChangeState", transition={"label": label})
        return bool(answer.success)

    async def state(self) -> str:
        return str((await self.call("get_state", "GetState")).current_state.label)


def managed(body: Any, project: Any = None, **options: Any) -> None:
    """Run *body* with a system under a manager, which opens its door."""

    async def main() -> None:
        async with Mas(project, seed=1, on_print=lambda *_: None, on_log=lambda *_: None, **options) as mas:
            lifecycle = Lifecycle(mas.system, lambda: open_door(mas.system))
            await body(mas, lifecycle, Manager(mas, mas.system.ros.name))

    jacaros.run(main(), clock="fast")


def test_agents_wait_until_they_are_activated() -> None:
    async def body(mas: Mas, lifecycle: Lifecycle, manager: Manager) -> None:
        bob = mas.add_agent("bob", COUNTER)
        await mas.sleep(1)
        assert (await manager.state(), bob.ask("n(X)")) == ("unconfigured", {"X": 0})
        assert await manager.change("configure")
        await mas.sleep(1)
        assert (await manager.state(), bob.ask("n(X)")) == ("inactive", {"X": 0})
        assert await manager.change("activate")
        await mas.sleep(1)
        before = bob.ask("n(X)")["X"]
        assert before > 5
        assert await manager.change("deactivate")
        await mas.sleep(1)
        still = bob.ask("n(X)")["X"]
        assert still - before <= 1
        assert await manager.change("activate")
        await mas.sleep(1)
        assert bob.ask("n(X)")["X"] > still + 5
        assert manager.events[:4] == [
            ("unconfigured", "configuring"),
            ("configuring", "inactive"),
            ("inactive", "activating"),
            ("activating", "active"),
        ]

    managed(body, world="none")


def test_goals_are_rejected_unless_the_node_is_active() -> None:
    async def body(mas: Mas, lifecycle: Lifecycle, manager: Manager) -> None:
        mas.add_agent("bob", COUNTER)
        client = manager.node.action_client("bob/count", "jacaros_interfaces/action/Achieve")
        assert not client.ready
        await manager.change("configure")
        with pytest.raises(GoalRejected, match="not active"):
            await client.send({"goal": "[3]"}, timeout=5)
        await manager.change("activate")
        outcome = await (await client.send({"goal": "[3]"}, timeout=5)).outcome()
        assert outcome.result.results == '{"m": 4}'
        await manager.change("deactivate")
        assert await manager.change("cleanup")
        assert not client.ready

    managed(body, world="none")


def test_the_robot_stands_still_while_inactive_and_goes_on() -> None:
    async def body(mas: Mas, lifecycle: Lifecycle, manager: Manager) -> None:
        assert mas.world is not None
        robot = mas.world.robot()
        await manager.change("configure")
        await manager.change("activate")
        await mas.sleep(2)
        assert robot.speed > 0.1
        await manager.change("deactivate")
        await mas.sleep(1)
        place = robot.pose
        assert robot.speed == 0.0
        await mas.sleep(5)
        assert robot.pose == place
        await manager.change("activate")
        await mas.sleep(2)
        assert robot.pose != place

    managed(body, ROBOT)


class Courier(PythonAgent):
    """Drives ahead, counts its steps in two tasks, and tidies up at its end."""

    async def run(self) -> None:
        self.steps, self.tidied = [0, 0], False
        await self.make_artifact("wheels", "ArtCmdVel")
        try:
            await asyncio.gather(self.act("move", 1000), self.count(0), self.start(self.count(1)))
        finally:
            self.tidied = True

    async def count(self, place: int) -> None:
        while True:
            await self.sleep(0.1)
            self.steps[place] += 1


def test_an_agent_in_python_stops_while_inactive_and_goes_on() -> None:
    async def body(mas: Mas, lifecycle: Lifecycle, manager: Manager) -> None:
        assert mas.world is not None
        robot = mas.world.robot()
        made: list[Courier] = []

        class Mine(Courier):
            async def run(self) -> None:
                made.append(self)
                await super().run()

        courier = mas.add_agent("courier", Mine)
        await mas.sleep(1)
        assert not made
        await manager.change("configure")
        await manager.change("activate")
        await mas.sleep(3)
        (found,) = made
        assert min(found.steps) > 10
        assert robot.speed > 0.1
        await manager.change("deactivate")
        await mas.sleep(1)
        steps, place = list(found.steps), robot.pose
        assert robot.speed == 0.0
        await mas.sleep(5)
        assert (found.steps, robot.pose) == (steps, place)
        await manager.change("activate")
        await mas.sleep(3)
        assert min(found.steps) > max(steps) + 10
        assert robot.pose != place
        await manager.change("deactivate")
        courier.kill()
        await mas.sleep(1)
        assert found.tidied

    managed(body, world="patrol")


def test_a_transition_that_does_not_fit_the_state_fails() -> None:
    async def body(mas: Mas, lifecycle: Lifecycle, manager: Manager) -> None:
        assert not await manager.change("activate")
        assert not await manager.change("rest")
        assert await manager.state() == "unconfigured"
        found = (
            await manager.call("get_available_transitions", "GetAvailableTransitions")
        ).available_transitions
        assert [each.transition.label for each in found] == ["configure", "shutdown"]
        states = (await manager.call("get_available_states", "GetAvailableStates")).available_states
        assert {each.id: each.label for each in states} == LABELS

    managed(body, world="none")


def test_shutdown_ends_the_run() -> None:
    async def body(mas: Mas, lifecycle: Lifecycle, manager: Manager) -> None:
        mas.add_agent("bob", COUNTER)
        await manager.change("configure")
        await manager.change("activate")
        assert await manager.change("shutdown")
        assert await mas.system.ended() == 0

    managed(body, world="none")


def test_a_failed_transition_leaves_the_state_and_is_logged() -> None:
    async def main() -> None:
        log: list[str] = []

        def broken() -> Any:
            raise ValueError("no door")

        async with Mas(world="none", on_log=lambda text, _: log.append(text)) as mas:
            Lifecycle(mas.system, broken)
            manager = Manager(mas)
            assert not await manager.change("configure")
            assert await manager.state() == "unconfigured"
        assert "[ros] error: configure failed: no door" in log

    jacaros.run(main(), clock="fast")
