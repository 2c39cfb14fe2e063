"""A laboratory for sensors: the messages of a topic while the robot of a world drives."""

from typing import Any

from navigation_lab import Lab, in_world

from jacaros.robots.world import World


def heard(
    topic: str, kind: str, seconds: float, speed: float, turn_rate: float = 0.0, world: str = "patrol"
) -> tuple[World, list[Any]]:
    """Return the messages of a topic while the robot drives."""
    messages: list[Any] = []

    async def body(lab: Lab) -> None:
        lab.backend.subscription(topic, kind, lambda sample: messages.append(sample.message))
        await lab.drive(seconds, speed, turn_rate)

    return in_world(body, world).world, messages
