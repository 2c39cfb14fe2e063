"""The graph's own log: each line is a message on ``/rosout``."""

from jacaros.ros.errors import RosError
from jacaros.ros.node import Node, Publisher
from jacaros.ros.qos import QoS

TOPIC = "/rosout"
QUALITY = QoS(durability="transient_local", depth=1000)
"""ROS 2's profile of this topic; on ROS 1 only the depth counts, because the topic is not latched there."""
ROS1_QUALITY = QoS(depth=100)
ROS1_TYPE, ROS2_TYPE = "rosgraph_msgs/msg/Log", "rcl_interfaces/msg/Log"
ROS1_LEVELS = {"debug": 1, "info": 2, "warn": 4, "error": 8, "fatal": 16}
ROS2_LEVELS = {"debug": 10, "info": 20, "warn": 30, "error": 40, "fatal": 50}


class RosoutWriter:
    """Publishes on ``/rosout`` (``rcl_interfaces/msg/Log``, on ROS 1 ``rosgraph_msgs/msg/Log``).

    Args:
        node: the backend; the publisher is made for the first line.
    """

    def __init__(self, node: Node) -> None:
        self._node = node
        self._publisher: Publisher | None = None

    def write(self, level: str, text: str) -> None:
        """Write one line; see `jacaros.ros.backend.Backend.rosout`."""
        ros1 = self._node.ros_version == 1
        number = checked_level(level, ROS1_LEVELS if ros1 else ROS2_LEVELS)
        if self._publisher is None:
            kind, qos = (ROS1_TYPE, ROS1_QUALITY) if ros1 else (ROS2_TYPE, QUALITY)
            self._publisher = self._node.publisher(TOPIC, kind, qos)
        now, name = self._node.clock.now(), self._node.node_name
        if ros1:
            message = self._publisher.message(header={"stamp": now}, level=number, name=name, msg=text)
        else:
            # ROS 2 names loggers as Python does.
            logger = name.strip("/").replace("/", ".")
            message = self._publisher.message(stamp=now, level=number, name=logger, msg=text)
        self._publisher.publish(message)


def checked_level(level: str, numbers: dict[str, int]) -> int:
    """Return the number of a level.

    Raises:
        RosError: the level is unknown.
    """
    if level not in numbers:
        raise RosError(f"unknown log level {level!r}: expected one of {', '.join(numbers)}")
    return numbers[level]
