"""A world on the memory graph, and goals for its robots, checked against the ground truth."""

import math
from collections.abc import Awaitable, Callable
from typing import Any

from jacaros.robots.ros.action import GoalOutcome
from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import SimNode, World
from jacaros.runtime.clock import VirtualClock, run

NAVIGATE = "nav2_msgs/action/NavigateToPose"


def pose(x: float, y: float, yaw: float = 0.0, frame: str = "map") -> dict[str, Any]:
    turn = {"z": math.sin(yaw / 2), "w": math.cos(yaw / 2)}
    return {"header": {"frame_id": frame}, "pose": {"position": {"x": x, "y": y}, "orientation": turn}}


class Lab:
    """A world on the memory graph, and a client of its robots."""

    def __init__(self, world: World, clock: VirtualClock, backend: Any, node: SimNode) -> None:
        self.world, self.clock, self.backend, self.node = world, clock, backend, node
        self.feedback: list[Any] = []

    async def send(self, name: str, type_name: str, **goal: Any) -> Any:
        client = self.backend.action_client(name, type_name)
        return await client.send(goal, self.feedback.append, timeout=5.0)

    async def do(self, name: str, type_name: str, **goal: Any) -> GoalOutcome:
        handle = await self.send(name, type_name, **goal)
        outcome: GoalOutcome = await handle.outcome(timeout=300.0)
        return outcome

    async def go(
        self, x: float, y: float, yaw: float = 0.0, frame: str = "map", robot: str = ""
    ) -> GoalOutcome:
        return await self.do(f"{robot}/navigate_to_pose", NAVIGATE, pose=pose(x, y, yaw, frame))

    async def stands(self, robot: str | None = None) -> None:
        """Assert that nothing moves half a second later."""
        await self.clock.sleep(0.6)
        before = self.world.robot(robot).pose
        await self.clock.sleep(0.5)
        assert self.world.robot(robot).pose == before


def in_world(source: str, body: Callable[[Lab], Awaitable[None]], seed: int | None = None) -> Lab:
    clock = VirtualClock()
    labs = []

    async def main() -> None:
        backend = open_backend("memory", clock, "test")
        await backend.start()
        beside = open_backend("memory", clock, "world", graph=backend.graph)  # type: ignore[attr-defined]
        await beside.start()
        world = World.load(source, seed)
        node = SimNode(world, beside, clock)
        node.start()
        labs.append(Lab(world, clock, backend, node))
        await body(labs[0])
        node.close()
        await beside.close()
        await backend.close()

    run(main, clock)
    return labs[0]


def near(world: World, x: float, y: float, yaw: float, robot: str | None = None) -> None:
    there = world.robot(robot)
    assert math.hypot(there.x - x, there.y - y) < 0.08
    assert abs(math.sin(there.yaw - yaw)) < 0.08
    assert math.cos(there.yaw - yaw) > 0.0


def bumps(world: World) -> list[Any]:
    return [event for event in world.log if event.kind in ("bump", "collision")]
