"""Quality of service in rclpy's terms."""

from typing import Any

import rclpy.duration  # type: ignore[import-not-found]
import rclpy.qos  # type: ignore[import-not-found]

from jacaros.ros.qos import QoS

_FOREVER = 2**62
"""Nanoseconds from which on a deadline is none; the middlewares have several numbers for it."""


def profile(qos: QoS) -> Any:
    """Give rclpy's profile."""
    reliability, durability = rclpy.qos.ReliabilityPolicy, rclpy.qos.DurabilityPolicy
    told: dict[str, Any] = {}
    if qos.deadline is not None:
        told["deadline"] = rclpy.duration.Duration(seconds=qos.deadline)
    return rclpy.qos.QoSProfile(
        depth=qos.depth,
        reliability=reliability.RELIABLE if qos.reliability == "reliable" else reliability.BEST_EFFORT,
        durability=durability.TRANSIENT_LOCAL if qos.durability == "transient_local" else durability.VOLATILE,
        **told,
    )


def quality(given: Any) -> QoS:
    """Read rclpy's profile of somebody's endpoint."""
    reliability, durability = rclpy.qos.ReliabilityPolicy, rclpy.qos.DurabilityPolicy
    nanoseconds = given.deadline.nanoseconds
    return QoS(
        reliability="best_effort" if given.reliability == reliability.BEST_EFFORT else "reliable",
        durability="transient_local" if given.durability == durability.TRANSIENT_LOCAL else "volatile",
        depth=max(1, given.depth),  # not every middleware tells it
        deadline=nanoseconds * 1e-9 if 0 < nanoseconds < _FOREVER else None,
    )
