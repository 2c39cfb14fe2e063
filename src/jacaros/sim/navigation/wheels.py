"""The wheels of a navigating robot: commands on ``/cmd_vel``, from one driver at a time."""

from collections.abc import Iterator
from contextlib import contextmanager

from jacaros.ros.backend import Backend
from jacaros.ros.node import Publisher
from jacaros.runtime.clock import Clock
from jacaros.sim.navigation.driver import STOP, Command

PERIOD = 0.1
"""Seconds between two commands."""
OVERTAKEN = "preempted by a newer goal"


class Overtaken(Exception):
    """Raised when another goal has claimed the wheels."""


class Claim:
    """A claim of the wheels, until another goal claims them."""

    def __init__(self, wheels: "Wheels") -> None:
        self._wheels = wheels

    async def drive(self, command: Command) -> None:
        """Publish a command, and wait until the next one is due.

        Raises:
            Overtaken: a newer goal has claimed the wheels.
        """
        if self._wheels.holder is not self:
            raise Overtaken(OVERTAKEN)
        self._wheels.send(command)
        await self._wheels.clock.sleep(PERIOD)
        if self._wheels.holder is not self:
            raise Overtaken(OVERTAKEN)


class Wheels:
    """Commands the base of one robot, as any other node would.

    Args:
        backend: graph.
        topic: topic of the commands.
        clock: sets the rate of commands.
    """

    def __init__(self, backend: Backend, topic: str, clock: Clock) -> None:
        self.clock = clock
        self.holder: Claim | None = None
        self._backend, self._topic = backend, topic
        self._publisher: Publisher | None = None

    @contextmanager
    def claimed(self) -> Iterator[Claim]:
        """Claim the wheels from the current driver; afterwards stop the robot, unless another driver claimed them."""
        self.holder = claim = Claim(self)
        try:
            yield claim
        finally:
            if self.holder is claim:
                self.holder = None
                self.send(STOP)

    def send(self, command: Command) -> None:
        """Publish a command."""
        if self._publisher is None:  # no publisher before the first command
            self._publisher = self._backend.publisher(self._topic, "geometry_msgs/msg/Twist")
        message = self._publisher.message()
        message.linear.x, message.angular.z = command
        self._publisher.publish(message)

    def close(self) -> None:
        """Stop the robot if it is driving, and withdraw the topic."""
        if self._publisher is None:
            return
        if self.holder is not None:
            self.holder = None
            self.send(STOP)
        self._publisher.close()
        self._publisher = None
