"""The charge in a ``sensor_msgs/msg/BatteryState``."""

import math

MORE_THAN_FULL = 1.5
"""A driver that reports more than this uses percent: the message type defines a fraction of 1, but some drivers
ignore that."""


class Charge:
    """Read the charge of one robot's messages.

    Attributes:
        in_percent: whether a message has shown that the driver uses percent; it keeps doing so at 1 %.
    """

    def __init__(self) -> None:
        self.in_percent = False

    def share(self, percentage: float) -> float | None:
        """Return the charge as a fraction of 1, from the field of that name; None if the message has none."""
        if not (math.isfinite(percentage) and percentage >= 0.0):
            return None
        self.in_percent = self.in_percent or percentage > MORE_THAN_FULL
        return percentage / 100.0 if self.in_percent else percentage
