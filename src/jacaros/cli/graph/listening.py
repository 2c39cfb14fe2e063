"""Listen to a graph for a while: one message of a topic, message rates, frames."""

import asyncio
from collections.abc import Iterable
from contextlib import suppress
from typing import Any

from jacaros.cli.graph.joining import Joined
from jacaros.ros.backend import TopicInfo
from jacaros.ros.errors import RosError
from jacaros.ros.qos import QoS
from jacaros.ros.waiting import within

RATE_OVER = 2.0
"""Seconds for which messages are counted."""
FRAMES_OVER = 2.0
"""Seconds in which each moving frame is published at least once (trees as in REP 105 are published at 10 Hz or more)."""

TF_TYPE = "tf2_msgs/msg/TFMessage"
_FRAMES = ("/tf", "/tf_static")


def hearing(info: TopicInfo) -> QoS:
    """Return the quality of service to receive from all publishers, latched messages included if all of them latch."""
    offers = [each.qos for each in info.publishers]
    keeps = bool(offers) and all(qos is not None and qos.durability == "transient_local" for qos in offers)
    sure = bool(offers) and all(qos is not None and qos.reliability == "reliable" for qos in offers)
    return QoS("reliable" if sure else "best_effort", "transient_local" if keeps else "volatile", 5)


async def one_message(joined: Joined, info: TopicInfo, timeout: float) -> Any:
    """Return the next message of a topic; None after *timeout* seconds."""
    heard: asyncio.Future[Any] = asyncio.get_running_loop().create_future()

    def take(sample: Any) -> None:
        if not heard.done():
            heard.set_result(sample.message)

    subscription = joined.backend.subscription(
        info.name, info.types[0], take, hearing(info), on_event=lambda event: None
    )
    try:
        return await within(joined.clock, heard, timeout)
    except TimeoutError:
        return None
    finally:
        subscription.close()


async def rates(joined: Joined, topics: Iterable[TopicInfo]) -> dict[str, float]:
    """Return the rates of topics in Hz, measured for `RATE_OVER` seconds, without topics that cannot be received."""
    stamps: dict[str, list[float]] = {}
    subscriptions = []

    def count(sample: Any) -> None:
        stamps[sample.topic].append(sample.stamp)

    for info in topics:
        if not info.publishers or len(info.types) != 1:
            continue
        with suppress(RosError):  # the type is not installed
            subscriptions.append(
                joined.backend.subscription(
                    info.name, info.types[0], count, QoS("best_effort"), on_event=lambda event: None
                )
            )
            stamps[info.name] = []
    await joined.clock.sleep(RATE_OVER)
    for subscription in subscriptions:
        subscription.close()
    return {name: _rate(times) for name, times in stamps.items()}


def _rate(times: list[float]) -> float:
    """Return the rate in Hz, with one decimal."""
    if len(times) < 2 or times[-1] <= times[0]:
        return round(len(times) / RATE_OVER, 1)
    return round((len(times) - 1) / (times[-1] - times[0]), 1)


async def frames(joined: Joined) -> dict[str, str]:
    """Return the frames on ``/tf`` and ``/tf_static``, each with its parent; the parent of a root is empty."""
    found: dict[str, str] = {}

    def take(sample: Any) -> None:
        for each in sample.message.transforms:
            parent = each.header.frame_id.lstrip("/")
            found[each.child_frame_id.lstrip("/")] = parent
            found.setdefault(parent, "")

    topics = joined.contents.topics
    subscriptions = []
    # Some nodes publish static frames only once the other frames have a subscription, so they may not be publishers yet.
    if any(name in topics and topics[name].publishers for name in _FRAMES):
        for name in _FRAMES:
            with suppress(RosError):
                made = joined.backend.subscription(
                    name, TF_TYPE, take, _of_frames(name), on_event=lambda event: None
                )
                subscriptions.append(made)
    if subscriptions:
        await joined.clock.sleep(FRAMES_OVER)
    for subscription in subscriptions:
        subscription.close()
    return found


def _of_frames(name: str) -> QoS:
    # Many nodes publish frames at the same time, each its own; static frames are latched for late joiners.
    if name == "/tf_static":
        return QoS(durability="transient_local", depth=100)
    return QoS("best_effort", depth=100)


def root(frames: dict[str, str], frame: str) -> str:
    """Return the root of the tree that contains *frame*."""
    seen = {frame}
    while (parent := frames.get(frame, "")) and parent not in seen:
        seen.add(parent)
        frame = parent
    return frame
