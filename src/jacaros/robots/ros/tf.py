"""Coordinate transforms over the topics ``/tf`` and ``/tf_static``: publishing, subscribing, looking up, waiting."""

import asyncio
from collections.abc import Callable
from typing import Any

from jacaros.robots.ros.errors import CapabilityMissing, TransformUnavailable, UnknownInterface
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.node import Node, Publisher, Sample
from jacaros.robots.ros.protocols.transform import Transform, TransformBuffer
from jacaros.robots.ros.qos import QoS
from jacaros.robots.ros.waiting import WaitLog, within

TF = QoS(depth=100)
TF_STATIC = QoS(durability="transient_local", depth=1)
ALL_STATIC = QoS(durability="transient_local", depth=100)
"""For the subscription: there may be many publishers of static transforms, each with a latched message."""
QUIET = 1.0
"""Seconds for which a wait is not logged: the newest transforms usually arrive soon."""
JUMP = 0.1
"""Seconds by which the clock must go back to count as a restart of time; less is a correction of the machine's
clock."""
MESSAGE = "tf2_msgs/msg/TFMessage"


class TransformBroadcaster:
    """Publishes on ``/tf`` and ``/tf_static``; both publishers are made on first use.

    Args:
        node: the backend.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publishers: dict[bool, Publisher] = {}
        self._static: dict[str, Any] = {}

    def send(self, transform: Any, static: bool) -> None:
        """Publish one transform; see `jacaros.robots.ros.backend.Backend.tf_broadcast`."""
        _require_type(self._node)
        message = self._node.message(MESSAGE, transforms=[transform])
        if static:
            # Late subscribers receive only one latched message, so it contains all static transforms.
            sent = message.transforms[0]
            self._static[sent.child_frame_id] = sent
            message = self._node.message(MESSAGE, transforms=list(self._static.values()))
        self._publisher(static).publish(message)

    def _publisher(self, static: bool) -> Publisher:
        if static not in self._publishers:
            topic, qos = ("/tf_static", TF_STATIC) if static else ("/tf", TF)
            self._publishers[static] = self._node.publisher(topic, MESSAGE, qos)
        return self._publishers[static]


class TransformListener:
    """Stores the transforms published on ``/tf`` and ``/tf_static`` since its subscription.

    Args:
        node: the backend.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._listening = False
        self._buffer = TransformBuffer(node.log)
        self._latest = 0.0
        self._reported: set[str] = set()
        self._waiting: list[Callable[[], None]] = []

    def listen(self) -> None:
        """Subscribe, unless that was done. Raises `CapabilityMissing`."""
        if self._listening:
            return
        _require_type(self._node)
        self._listening = True
        self._node.subscription("/tf", MESSAGE, lambda sample: self._take(sample, False), TF)
        self._node.subscription("/tf_static", MESSAGE, lambda sample: self._take(sample, True), ALL_STATIC)

    def lookup(self, target: str, source: str, stamp: float | None) -> Transform:
        """Look up a transform; see `jacaros.robots.ros.backend.Backend.tf_lookup`."""
        self.listen()
        return self._buffer.lookup(target, source, stamp)

    async def wait(self, target: str, source: str, stamp: float | None, timeout: float | None) -> Transform:
        """Look up a transform as soon as it is possible; see `jacaros.robots.ros.backend.Backend.tf_wait`."""
        try:
            return self.lookup(target, source, stamp)
        except TransformUnavailable as problem:
            if problem.reason == "too_old":  # the past does not come back
                raise
        what = f"transform from {source} to {target}"
        help = "is the node that publishes it running?"
        with WaitLog(self._node.clock, self._node.log, what, help, QUIET).during():
            return await self._arrival(target, source, stamp, timeout)

    async def _arrival(
        self, target: str, source: str, stamp: float | None, timeout: float | None
    ) -> Transform:
        arrival: asyncio.Future[Transform] = asyncio.get_running_loop().create_future()

        def look_again() -> None:
            if arrival.done():
                return
            try:
                arrival.set_result(self._buffer.lookup(target, source, stamp))
            except TransformUnavailable as problem:
                if problem.reason == "too_old":
                    arrival.set_exception(problem)

        self._waiting.append(look_again)
        try:
            return await within(self._node.clock, arrival, timeout)
        except TimeoutError:
            try:
                return self._buffer.lookup(target, source, stamp)
            except TransformUnavailable as problem:
                text = f"{problem} (waited {timeout:g} s)"
                raise TransformUnavailable(text, problem.reason) from None
        finally:
            self._waiting.remove(look_again)

    def _take(self, sample: Sample, static: bool) -> None:
        now = self._node.clock.now()
        if now < self._latest - JUMP:
            self._buffer.clear(f"the clock went back by {self._latest - now:.6g} s")
        self._latest = now
        for stamped in sample.message.transforms:
            transform = stamped.transform
            shift, turn = transform.translation, transform.rotation
            fault = self._buffer.insert(
                stamped.header.frame_id,
                stamped.child_frame_id,
                Transform(
                    (shift.x, shift.y, shift.z),
                    (turn.x, turn.y, turn.z, turn.w),
                    to_seconds(stamped.header.stamp),
                ),
                static,
            )
            if fault is not None and fault not in self._reported:
                self._reported.add(fault)
                self._node.log(f"{sample.topic}: {fault}; transform ignored")
        for look_again in list(self._waiting):
            look_again()


def _require_type(node: Node) -> None:
    try:
        node.message(MESSAGE)
    except UnknownInterface as problem:
        raise CapabilityMissing(f"the {node.name} backend has no transforms here: {problem}") from None
