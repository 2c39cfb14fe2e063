"""Nav2's actions, as the embedded world offers them where ``nav2_msgs`` is not installed."""

from jacaros_interfaces.action import NavigateToPose

__all__ = ["NavigateToPose"]
