"""Nav2's services, as the embedded world offers them where ``nav2_msgs`` is not installed."""

from jacaros_interfaces.srv import ClearEntireCostmap

__all__ = ["ClearEntireCostmap"]
