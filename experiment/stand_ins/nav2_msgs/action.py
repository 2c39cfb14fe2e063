"""Nav2's actions, as the embedded world offers them where ``nav2_msgs`` is not installed."""

from jacaros_interfaces.action import DriveOnHeading, NavigateToPose, Spin

__all__ = ["DriveOnHeading", "NavigateToPose", "Spin"]
