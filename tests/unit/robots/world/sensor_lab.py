"""A laboratory for sensors: the messages of a topic while the robot of a world drives."""

from typing import Any

from jacaros.robots.ros.open import open_backend
from jacaros.robots.world import SimNode, World
from jacaros.runtime.clock import VirtualClock, run


def heard(
    topic: str, kind: str, seconds: float, speed: float, turn_rate: float = 0.0, world: str = "patrol"
) -> tuple[World, list[Any]]:
    """Return the messages of a topic while the robot drives."""
    clock, loaded = VirtualClock(), World.load(world)
    messages: list[Any] = []

    async def main() -> None:
        backend = open_backend("memory", clock, "test")
        await backend.start()
        node = SimNode(loaded, backend, clock)
        node.start()
        backend.subscription(topic, kind, lambda sample: messages.append(sample.message))
        publisher = backend.publisher("/cmd_vel", "geometry_msgs/msg/Twist")
        for _ in range(round(seconds * 10)):
            publisher.publish(publisher.message(linear={"x": speed}, angular={"z": turn_rate}))
            await clock.sleep(0.1)
        node.close()
        await backend.close()

    run(main, clock)
    return loaded, messages
