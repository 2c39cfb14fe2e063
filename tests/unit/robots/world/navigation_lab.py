"""A world on the memory graph, and goals for its robots, checked against the ground truth."""

import math
from collections.abc import Awaitable, Callable
from typing import Any

from jacaros.robots.ros.action import GoalOutcome
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.qos import QoS
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

    async def call(self, service: str, type_name: str, **request: Any) -> Any:
        return await self.backend.client(service, type_name).call(request, timeout=5.0)

    def hear(self, topic: str, type_name: str, *qos: QoS) -> list[Any]:
        """The messages of a topic from now on."""
        heard: list[Any] = []
        self.backend.subscription(topic, type_name, lambda sample: heard.append(sample.message), *qos)
        return heard

    def say(self, topic: str, type_name: str, **fields: Any) -> None:
        """Publish one message."""
        publisher = self.backend.publisher(topic, type_name)
        publisher.publish(publisher.message(**fields))

    async def drive(
        self, seconds: float, speed: float, turn_rate: float = 0.0, topic: str = "/cmd_vel"
    ) -> None:
        """Command velocities at 10 Hz."""
        publisher = self.backend.publisher(topic, "geometry_msgs/msg/Twist")
        for _ in range(round(seconds * 10)):
            publisher.publish(publisher.message(linear={"x": speed}, angular={"z": turn_rate}))
            await self.clock.sleep(0.1)

    async def stands(self, robot: str | None = None) -> None:
        """Assert that nothing moves half a second later."""
        await self.clock.sleep(0.6)
        before = self.world.robot(robot).pose
        await self.clock.sleep(0.5)
        assert self.world.robot(robot).pose == before


def in_world(
    body: Callable[[Lab], Awaitable[None]], source: str | World, seed: int | None = None, faults: str = ""
) -> Lab:
    """Run *body* beside a world."""
    clock = VirtualClock()
    labs = []

    async def main() -> None:
        backend = open_backend("memory", clock, "test", log=lambda text: None)
        await backend.start()
        beside: Any = open_backend("memory", clock, "world", graph=backend.graph)  # type: ignore[attr-defined]
        await beside.start()
        world = source if isinstance(source, World) else World.load(source, seed, faults or None)
        node = SimNode(world, beside, clock)
        try:
            node.start()
            labs.append(Lab(world, clock, backend, node))
            await body(labs[0])
        finally:
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


Lab.play = staticmethod(in_world)
