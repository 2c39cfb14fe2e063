"""Listening for a while: one message of a topic, how often messages come, which frames there are."""

import asyncio
from collections.abc import Iterable
from contextlib import suppress
from typing import Any

from jacaros.cli.graph.joining import Joined
from jacaros.ros.errors import RosError
from jacaros.ros.graph import TopicInfo
from jacaros.ros.qos import QoS
from jacaros.ros.waiting import within

RATE_OVER = 2.0
"""Seconds over which messages are counted."""
FRAMES_OVER = 2.0
"""Seconds in which every moving frame is told at least once (REP 105's trees are published ten times a second or more)."""

TF_TYPE = "tf2_msgs/msg/TFMessage"
_FRAMES = ("/tf", "/tf_static")


def hearing(info: TopicInfo) -> QoS:
    """What to ask for in order to hear all publishers of a topic, and their kept messages if all of them keep some."""
    offers = [each.qos for each in info.publishers]
    keeps = bool(offers) and all(qos is not None and qos.durability == "transient_local" for qos in offers)
    sure = bool(offers) and all(qos is not None and qos.reliability == "reliable" for qos in offers)
    return QoS("reliable" if sure else "best_effort", "transient_local" if keeps else "volatile", 5)


async def one_message(joined: Joined, info: TopicInfo, timeout: float) -> Any:
    """The next message of a topic; None when none comes in *timeout* seconds."""
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
    """Messages a second by topic, counted for `RATE_OVER` seconds; topics that cannot be heard are left out."""
    stamps: dict[str, list[float]] = {}
    subscriptions = []

    def count(sample: Any) -> None:
        stamps[sample.topic].append(sample.stamp)

    for info in topics:
        if not info.publishers or len(info.types) != 1:
            continue
        with suppress(RosError):  # a type that is not installed here
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
    """Messages a second, with one decimal."""
    if len(times) < 2 or times[-1] <= times[0]:
        return round(len(times) / RATE_OVER, 1)
    return round((len(times) - 1) / (times[-1] - times[0]), 1)


async def frames(joined: Joined) -> dict[str, str]:
    """The frames of ``/tf`` and ``/tf_static``: each with the frame that it hangs on; empty for the uppermost ones."""
    found: dict[str, str] = {}

    def take(sample: Any) -> None:
        for each in sample.message.transforms:
            parent = each.header.frame_id.lstrip("/")
            found[each.child_frame_id.lstrip("/")] = parent
            found.setdefault(parent, "")

    topics = joined.contents.topics
    subscriptions = []
    # A node may publish static frames only when it hears of a listener for the others, and so be no publisher yet.
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
    # Many nodes send frames at once, each its own; static ones are kept for late comers.
    if name == "/tf_static":
        return QoS(durability="transient_local", depth=100)
    return QoS("best_effort", depth=100)


def root(frames: dict[str, str], frame: str) -> str:
    """The uppermost frame of the tree in which *frame* is."""
    seen = {frame}
    while (parent := frames.get(frame, "")) and parent not in seen:
        seen.add(parent)
        frame = parent
    return frame
