"""Quality of service, in ROS 2's terms; ROS 1 has only the depth and latching."""

from collections.abc import Collection
from dataclasses import dataclass, replace
from typing import Literal, get_args

from jacaros.robots.ros.errors import RosError

Reliability = Literal["reliable", "best_effort"]
Durability = Literal["volatile", "transient_local", "best_available"]


@dataclass(frozen=True)
class QoS:
    """How messages of a publisher or subscription are stored and delivered.

    Attributes:
        reliability: ``reliable`` repeats lost messages, ``best_effort`` does not.
        durability: ``transient_local`` publishers store their last messages for late subscriptions; on ROS 1 such a
            publisher is latched and stores one. A subscription with ``best_available`` receives the stored messages
            if all publishers store them, and all later ones in any case.
        depth: messages stored while a receiver lags behind; the oldest is dropped first.
        deadline: maximum number of seconds between messages that a publisher promises and a subscription expects;
            None: none. Only with the capability ``deadlines``.
    """

    reliability: Reliability = "reliable"
    durability: Durability = "volatile"
    depth: int = 10
    deadline: float | None = None

    def __post_init__(self) -> None:
        if self.reliability not in ("reliable", "best_effort"):
            raise RosError(f"reliability: expected reliable or best_effort, found {self.reliability!r}")
        if self.durability not in get_args(Durability):
            raise RosError(f"durability: expected one of {get_args(Durability)}, found {self.durability!r}")
        if isinstance(self.depth, bool) or not isinstance(self.depth, int) or self.depth < 1:
            raise RosError(f"depth: expected a positive integer, found {self.depth!r}")
        if self.deadline is not None and not self.deadline > 0.0:
            raise RosError(f"deadline: expected a number of seconds above zero, found {self.deadline!r}")


DEFAULT_QOS = QoS()
"""Reliable, volatile, ten messages: ROS 2's default."""

SENSOR_DATA = QoS(reliability="best_effort", depth=5)
"""ROS 2's profile for sensor streams: a late reading is worthless, and is not repeated."""

STATE = replace(SENSOR_DATA, durability="best_available")
"""For properties: as `SENSOR_DATA`, and with the stored messages of latched topics."""

LATCHED = QoS(durability="transient_local", depth=1)
"""The last message is stored for late subscriptions: maps, robot descriptions, static transforms."""


def incompatibility(offered: QoS, requested: QoS) -> str | None:
    """Return why a publisher's offer does not meet a subscription's request; None if it does.

    The rules are those of DDS: a request must not be stricter than the offer.
    """
    if requested.reliability == "reliable" and offered.reliability == "best_effort":
        return "the subscription requests reliable, the publisher offers best_effort"
    if requested.durability == "transient_local" and offered.durability == "volatile":
        return "the subscription requests transient_local, the publisher offers volatile"
    if requested.deadline is not None and (offered.deadline is None or offered.deadline > requested.deadline):
        promised = "none" if offered.deadline is None else f"{offered.deadline:g} s"
        return f"the subscription requests a deadline of {requested.deadline:g} s, the publisher offers {promised}"
    return None


def available(requested: QoS, offers: Collection[QoS | None]) -> QoS:
    """Return the request with ``best_available`` replaced by what all *offers* meet (None: unknown).

    Stored messages are requested reliably if possible: a best-effort reader may miss them.
    """
    if requested.durability != "best_available":
        return requested
    known = [offer for offer in offers if offer is not None]
    if not known or any(offer.durability != "transient_local" for offer in known):
        return replace(requested, durability="volatile")
    sure = all(offer.reliability == "reliable" for offer in known)
    return replace(
        requested,
        durability="transient_local",
        reliability="reliable" if sure else requested.reliability,
    )
