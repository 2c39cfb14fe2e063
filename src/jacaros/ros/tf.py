"""Sending coordinate transforms."""

from typing import Any, Protocol

from jacaros.ros.backend import Publisher
from jacaros.ros.errors import CapabilityMissing, UnknownInterface
from jacaros.ros.qos import QoS

TF = QoS(depth=100)
TF_STATIC = QoS(durability="transient_local", depth=1)
MESSAGE = "tf2_msgs/msg/TFMessage"


class _Node(Protocol):
    name: str

    def message(self, type_name: str, /, **fields: Any) -> Any: ...
    def publisher(self, topic: str, type_name: str, qos: QoS = ...) -> Publisher: ...


class TransformBroadcaster:
    """Publishes on ``/tf`` and ``/tf_static``; both topics are joined at their first use.

    Args:
        node: the backend that publishes.
    """

    def __init__(self, node: _Node) -> None:
        self._node = node
        self._publishers: dict[bool, Publisher] = {}
        self._static: dict[str, Any] = {}

    def send(self, transform: Any, static: bool) -> None:
        """Publish one transform; see `jacaros.ros.backend.Backend.tf_broadcast`."""
        self._require_type()
        message = self._node.message(MESSAGE, transforms=[transform])
        if static:
            # A latched topic shows late receivers one message only, so it holds all static transforms.
            sent = message.transforms[0]
            self._static[sent.child_frame_id] = sent
            message = self._node.message(MESSAGE, transforms=list(self._static.values()))
        self._publisher(static).publish(message)

    def _require_type(self) -> None:
        try:
            self._node.message(MESSAGE)
        except UnknownInterface as problem:
            raise CapabilityMissing(
                f"the {self._node.name} backend cannot send transforms here: {problem}"
            ) from None

    def _publisher(self, static: bool) -> Publisher:
        if static not in self._publishers:
            topic, qos = ("/tf_static", TF_STATIC) if static else ("/tf", TF)
            self._publishers[static] = self._node.publisher(topic, MESSAGE, qos)
        return self._publishers[static]
