"""``rclpy.time``: moments."""

from typing import Any

from virtual_rclpy.messages import Interface


class Time:
    """A moment, in nanoseconds since the epoch; 0 stands for the newest one in look-ups of transforms."""

    def __init__(self, *, nanoseconds: int = 0) -> None:
        self.nanoseconds = nanoseconds

    def to_msg(self) -> Any:
        """Return the ``builtin_interfaces/msg/Time``."""
        sec, nanosec = divmod(self.nanoseconds, 1_000_000_000)
        return Interface("builtin_interfaces/msg/Time")(sec=sec, nanosec=nanosec)
