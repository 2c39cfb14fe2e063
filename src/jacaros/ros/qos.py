"""Quality of service, in the words of ROS 2; ROS 1 knows the depth and latching alone."""

from dataclasses import dataclass
from typing import Literal

from jacaros.ros.errors import RosError

Reliability = Literal["reliable", "best_effort"]
Durability = Literal["volatile", "transient_local"]


@dataclass(frozen=True)
class QoS:
    """How messages of a publisher or subscription are kept and delivered.

    Attributes:
        reliability: ``reliable`` repeats lost messages, ``best_effort`` does not.
        durability: ``transient_local`` publishers keep their last messages for late subscriptions; on ROS 1
            such a publisher is latched and keeps one.
        depth: messages kept while a receiver is behind; the oldest is dropped first.
        deadline: a publisher promises, and a subscription expects, a message every so many seconds; None: no promise.
            Only where the backend has the capability ``deadlines``.
    """

    reliability: Reliability = "reliable"
    durability: Durability = "volatile"
    depth: int = 10
    deadline: float | None = None

    def __post_init__(self) -> None:
        if self.reliability not in ("reliable", "best_effort"):
            raise RosError(f"reliability is reliable or best_effort, not {self.reliability!r}")
        if self.durability not in ("volatile", "transient_local"):
            raise RosError(f"durability is volatile or transient_local, not {self.durability!r}")
        if isinstance(self.depth, bool) or not isinstance(self.depth, int) or self.depth < 1:
            raise RosError(f"depth is a whole number from 1 on, not {self.depth!r}")
        if self.deadline is not None and not self.deadline > 0.0:
            raise RosError(f"deadline is a number of seconds above zero, not {self.deadline!r}")


DEFAULT_QOS = QoS()
"""Reliable, volatile, ten messages: what ROS 2 gives to those who do not ask."""

SENSOR_DATA = QoS(reliability="best_effort", depth=5)
"""ROS 2's profile for sensor streams: a late reading is worthless, so it is not repeated."""

LATCHED = QoS(durability="transient_local", depth=1)
"""The last message waits for late subscriptions: maps, robot descriptions, static transforms."""


def incompatibility(offered: QoS, requested: QoS) -> str | None:
    """Tell why a subscription's request cannot be met by a publisher's offer; None when it can.

    The rules are those of DDS: a request may not be stricter than the offer.
    """
    if requested.reliability == "reliable" and offered.reliability == "best_effort":
        return "the subscription asks for reliable, the publisher offers best_effort"
    if requested.durability == "transient_local" and offered.durability == "volatile":
        return "the subscription asks for transient_local, the publisher offers volatile"
    if requested.deadline is not None and (offered.deadline is None or offered.deadline > requested.deadline):
        promised = "none" if offered.deadline is None else f"{offered.deadline:g} s"
        return f"the subscription asks for a deadline of {requested.deadline:g} s, the publisher promises {promised}"
    return None
