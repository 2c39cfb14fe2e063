"""The frame in which a robot drives: odometry's own, or one that localisation keeps true, such as ``map``."""

from dataclasses import replace

from jacaros.artifacts.robots.control import Pose, unwrapped
from jacaros.artifacts.robots.odometry import Odometry
from jacaros.ros.backend import Backend
from jacaros.ros.errors import TransformUnavailable
from jacaros.ros.message import to_seconds

OUTDATED = 2.0
"""Seconds by which a transform may be older than odometry; localisation gives one with every scan."""


class DrivingFrame:
    """Gives odometry in another frame (REP 105), by the newest transform of tf between the two.

    Odometry drifts, and a point of its frame is another place after a while; localisation tells on tf where that frame
    is in ``map`` now.

    Args:
        ros: the graph; listens to its tf from now on.
        name: of the frame.

    Raises:
        CapabilityMissing: the graph has no tf.
    """

    def __init__(self, ros: Backend, name: str) -> None:
        self._ros, self.name = ros, name
        ros.tf_listen()

    def placed(self, odometry: Odometry) -> Odometry | None:
        """The same with the pose in this frame; None while localisation does not tell where that is."""
        header = odometry.sample.message.header
        try:
            transform = self._ros.tf_lookup(self.name, header.frame_id)
        except TransformUnavailable:
            return None
        told = to_seconds(header.stamp)
        # The robot stamps both: its clock may be wrong, but it is one.
        if told and transform.stamp and told - transform.stamp > OUTDATED:
            return None
        position = transform.apply(odometry.position)
        heading = unwrapped(odometry.pose.heading + transform.yaw)
        return replace(odometry, position=position, pose=Pose(position[0], position[1], heading))
