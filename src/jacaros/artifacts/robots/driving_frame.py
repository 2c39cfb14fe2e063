"""The frame in which a robot drives: odometry's own, or one that localisation corrects, such as ``map``."""

from dataclasses import replace

from jacaros.artifacts.robots.odometry import Odometry
from jacaros.plane.pose import Pose, normalised
from jacaros.ros.backend import Backend
from jacaros.ros.errors import TransformUnavailable
from jacaros.ros.message import to_seconds

OUTDATED = 2.0
"""Seconds by which a transform may be older than odometry; localisation publishes one with every scan."""


class DrivingFrame:
    """Convert odometry to another frame (REP 105), by the newest transform between the two.

    Odometry drifts, so a point of its frame moves over time; localisation publishes on tf the pose of that frame in
    ``map``.

    Args:
        ros: the graph; its tf is subscribed to from now on.
        name: name of the frame.

    Raises:
        CapabilityMissing: the graph has no tf.
    """

    def __init__(self, ros: Backend, name: str) -> None:
        self._ros, self.name = ros, name
        ros.tf_listen()

    def placed(self, odometry: Odometry) -> Odometry | None:
        """Return the odometry with the pose in this frame; None while the transform is unknown."""
        header = odometry.sample.message.header
        try:
            transform = self._ros.tf_lookup(self.name, header.frame_id)
        except TransformUnavailable:
            return None
        told = to_seconds(header.stamp)
        # Both stamps are from the robot's clock, which may be wrong but is the same for both.
        if told and transform.stamp and told - transform.stamp > OUTDATED:
            return None
        position = transform.apply(odometry.position)
        heading = normalised(odometry.pose.yaw + transform.yaw)
        return replace(odometry, position=position, pose=Pose(position[0], position[1], heading))
