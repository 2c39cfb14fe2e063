"""The part of ``tf2_ros`` that the baselines use, in Python alone.

The wheels of ROS 2 do not include ``tf2_ros``, which needs a C++ library. With this folder on ``PYTHONPATH`` the baselines
run on the wheels, and on the virtual clock. A full ROS 2 installation has the genuine module.
"""

from typing import Any

from geometry_msgs.msg import TransformStamped
from rclpy.node import Node
from rclpy.qos import DurabilityPolicy, QoSProfile
from rclpy.time import Time
from tf2_msgs.msg import TFMessage

from jacaros.robots.ros.errors import TransformUnavailable
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.protocols.transform import Transform, TransformBuffer

STATIC = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL)


class TransformException(Exception):
    """Raised when a transform is not available."""


class Buffer:
    """Keeps the transforms of the last ten seconds."""

    def __init__(self) -> None:
        self.transforms = TransformBuffer(lambda text: None)

    def can_transform(self, target_frame: str, source_frame: str, time: Time) -> bool:
        """Return whether the transform is available now."""
        try:
            self.lookup_transform(target_frame, source_frame, time)
        except TransformException:
            return False
        return True

    def lookup_transform(self, target_frame: str, source_frame: str, time: Time) -> Any:
        """Return the ``TransformStamped`` at *time*, the newest one for time 0.

        Raises:
            TransformException: the transform is not available.
        """
        stamp = time.nanoseconds / 1e9 if time.nanoseconds else None
        try:
            found = self.transforms.lookup(target_frame, source_frame, stamp)
        except TransformUnavailable as problem:
            raise TransformException(str(problem)) from None
        message = TransformStamped()
        message.header.frame_id, message.child_frame_id = target_frame, source_frame
        message.header.stamp = Time(nanoseconds=round(found.stamp * 1e9)).to_msg()
        shift, turn = message.transform.translation, message.transform.rotation
        shift.x, shift.y, shift.z = found.translation
        turn.x, turn.y, turn.z, turn.w = found.rotation
        return message


class TransformListener:
    """Fills a buffer from ``/tf`` and ``/tf_static``, while the node spins."""

    def __init__(self, buffer: Buffer, node: Node) -> None:
        self.buffer = buffer
        node.create_subscription(TFMessage, "/tf", lambda message: self._take(message, False), 100)
        node.create_subscription(TFMessage, "/tf_static", lambda message: self._take(message, True), STATIC)

    def _take(self, message: Any, static: bool) -> None:
        for stamped in message.transforms:
            shift, turn = stamped.transform.translation, stamped.transform.rotation
            transform = Transform(
                (shift.x, shift.y, shift.z),
                (turn.x, turn.y, turn.z, turn.w),
                to_seconds(stamped.header.stamp),
            )
            self.buffer.transforms.insert(stamped.header.frame_id, stamped.child_frame_id, transform, static)
