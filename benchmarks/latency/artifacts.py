"""The other half of the echo: one operation that publishes one command."""

from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.env import operation


class Reply(RosArtifact):
    """Publishes velocity commands."""

    def open(self) -> None:
        """Open the command topic."""
        self._commands = self.publisher("cmd_vel", "geometry_msgs/msg/Twist")

    @operation
    def reply(self, number: float) -> None:
        """Publish a command that says which message it answers."""
        command = self._commands.message()
        command.linear.x = number
        self._commands.publish(command)
