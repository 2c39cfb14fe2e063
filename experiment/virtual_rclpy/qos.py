"""``rclpy.qos``: quality of service."""

from dataclasses import dataclass
from enum import Enum
from typing import Literal

from jacaros.robots.ros.qos import QoS


class ReliabilityPolicy(Enum):
    """Whether lost messages are repeated."""

    RELIABLE = "reliable"
    BEST_EFFORT = "best_effort"


class DurabilityPolicy(Enum):
    """Whether late subscriptions receive the last messages."""

    VOLATILE = "volatile"
    TRANSIENT_LOCAL = "transient_local"


@dataclass(frozen=True)
class QoSProfile:
    """A quality of service."""

    depth: int = 10
    reliability: ReliabilityPolicy = ReliabilityPolicy.RELIABLE
    durability: DurabilityPolicy = DurabilityPolicy.VOLATILE


qos_profile_sensor_data = QoSProfile(depth=5, reliability=ReliabilityPolicy.BEST_EFFORT)


def qos_of(given: QoSProfile | int) -> QoS:
    """Return the quality of service of a profile, or of a depth."""
    profile = QoSProfile(depth=given) if isinstance(given, int) else given
    reliability: Literal["reliable", "best_effort"] = profile.reliability.value
    durability: Literal["volatile", "transient_local"] = profile.durability.value
    return QoS(reliability, durability, profile.depth)
