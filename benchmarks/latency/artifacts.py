"""The artifacts of the agents: the other half of the echo, and the bumper and the load of bumper.asl."""

from jacaros.artifacts import internal_operation, operation
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.node import Sample

INT32, TWIST = "std_msgs/msg/Int32", "geometry_msgs/msg/Twist"


class Reply(RosArtifact):
    """Publishes velocity commands."""

    def open(self) -> None:
        """Open the command topic."""
        self._commands = self.publisher("cmd_vel", TWIST)

    @operation
    def reply(self, number: float) -> None:
        """Publish a command with the number of the message that it answers."""
        command = self._commands.message()
        command.linear.x = number
        self._commands.publish(command)


class Bumper(RosArtifact):
    """Signals numbered bumps, and stops the wheels."""

    def open(self) -> None:
        """Listen to the bumper, and open the command topic."""
        self._commands = self.publisher("cmd_vel", TWIST)
        self.subscription("bumper", INT32, self._take)

    def _take(self, sample: Sample) -> None:
        self.start(self.bump, int(sample.message.data), cause=sample.cause)

    @internal_operation
    def bump(self, number: int) -> None:
        """Signal a bump."""
        self.signal("bumped", number)

    @operation
    def stop(self, number: int) -> None:
        """Publish a zero velocity; the roll rate, unused by robots on wheels, holds the number of the answered bump."""
        command = self._commands.message()
        command.angular.x = float(number)
        self._commands.publish(command)


class Load(RosArtifact):
    """Signals a number of readings, acknowledged when they are queued, and when all have been handled."""

    def open(self) -> None:
        """Listen to the order, and open the topics of the acknowledgements."""
        self._waiting = self.publisher("readings/waiting", INT32)
        self._handled = self.publisher("readings/handled", INT32)
        self.subscription("readings", INT32, self._take)

    def _take(self, sample: Sample) -> None:
        self.start(self.burst, int(sample.message.data), cause=sample.cause)

    @internal_operation
    def burst(self, count: int) -> None:
        """Signal the readings, numbered down to 1."""
        for number in range(count, 0, -1):
            self.signal("reading", number)
        self._waiting.publish(self._waiting.message(data=count))

    @operation
    def handled(self) -> None:
        """Publish that the last reading has been handled."""
        self._handled.publish(self._handled.message(data=1))
