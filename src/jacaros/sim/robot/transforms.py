"""The transforms of one robot (map, odometry, base and laser), and its ``amcl_pose``.

The estimated pose is published after motion, latched, as by ``nav2_amcl`` and ROS 1's ``amcl``; the distances are the
defaults of Nav2's.
"""

import math
from typing import Any

from jacaros.plane.pose import Placement, distance
from jacaros.ros.errors import RosError, UnknownInterface
from jacaros.ros.message import stamp
from jacaros.ros.node import Capability, Publisher
from jacaros.ros.qos import QoS
from jacaros.sim.navigation.frames import BASE, CAMERA, FOOTPRINT, MAP, ODOMETRY, SCAN
from jacaros.sim.navigation.localisation import FOUND
from jacaros.sim.robot.on_graph import RobotOnGraph
from jacaros.sim.robot.sensors.rendering import CAMERA_HEIGHT

_TRANSFORM = "geometry_msgs/msg/TransformStamped"
_HERE = Placement(0.0, 0.0)


class RobotTransforms:
    """Publishes one robot's frames while there are subscribers.

    ``map`` to ``odom`` and ``odom`` to ``base_footprint`` are published on ``/tf`` at 20 Hz. ``base_footprint`` to
    ``base_link`` to ``base_scan``, all at the same place, ``base_link`` to ``camera_optical_frame``, and the robot's own
    ``map`` if it has a namespace, are published on ``/tf_static``, once.
    """

    def __init__(self, at: RobotOnGraph) -> None:
        self._time, self._robot, self._backend = at.time, at.robot, at.backend
        self._localisation = at.localisation
        self._prefix = at.frame_prefix
        self._publisher = self._join(at)
        self._static_is_out = False
        if at.backend.name != "memory":
            # Other graphs do not report subscriptions to /tf_static alone.
            self._publish_static()

    def _join(self, at: RobotOnGraph) -> Publisher | None:
        if Capability.TRANSFORMS not in self._backend.capabilities:
            return None
        # Not `tf_broadcast`, which does not report subscriptions.
        try:
            return at.keep(self._backend.publisher("/tf", "tf2_msgs/msg/TFMessage", QoS(depth=100)))
        except UnknownInterface:  # not every ROS 2 installation has tf2_msgs
            return None

    def publish(self, ticks: int) -> None:
        """Publish the estimated pose at every tick."""
        del ticks
        publisher = self._publisher
        if publisher is None or not publisher.subscription_count:
            return
        self._publish_static()
        self._localisation.update(self._time.world.time)
        moved = self._transform(ODOMETRY, FOOTPRINT, self._robot.odometry.placement)
        corrected = self._transform(MAP, ODOMETRY, self._localisation.map_to_odom)
        publisher.publish(publisher.message(transforms=[moved, corrected]))

    def _publish_static(self) -> None:
        if self._static_is_out or self._publisher is None:
            return
        self._static_is_out = True
        pairs = [(FOOTPRINT, BASE), (BASE, SCAN)]
        try:
            for parent, child in pairs:
                self._backend.tf_broadcast(self._transform(parent, child, _HERE), static=True)
            self._backend.tf_broadcast(self._of_camera(), static=True)
            if self._prefix:
                own_map = self._transform("", MAP, _HERE)
                own_map.header.frame_id = MAP
                self._backend.tf_broadcast(own_map, static=True)
        except RosError:  # the type exists, as that of the publisher did
            return

    def _of_camera(self) -> Any:
        message = self._transform(BASE, CAMERA, _HERE)
        message.transform.translation.z = CAMERA_HEIGHT
        rotation = message.transform.rotation
        rotation.x, rotation.y, rotation.z, rotation.w = -0.5, 0.5, -0.5, 0.5
        return message

    def _transform(self, parent: str, child: str, place: Placement) -> Any:
        message = self._backend.message(_TRANSFORM)
        stamp(message.header.stamp, self._time.now())
        message.header.frame_id = self._prefix + parent
        message.child_frame_id = self._prefix + child
        translation, rotation = message.transform.translation, message.transform.rotation
        translation.x, translation.y = place.x, place.y
        rotation.z, rotation.w = place.quaternion()
        return message


UPDATE_DISTANCE = 0.25
"""Metres of odometry between two messages (``update_min_d``)."""
UPDATE_ANGLE = 0.2
"""Radians of odometry between two messages (``update_min_a``)."""

TYPE = "geometry_msgs/msg/PoseWithCovarianceStamped"
_LATCHED = QoS(durability="transient_local", depth=1)


class AmclPose:
    """Publishes the estimated pose of one robot on the map; idle until the first subscription."""

    def __init__(self, at: RobotOnGraph) -> None:
        self._time, self._robot, self._localisation = at.time, at.robot, at.localisation
        self._frame = at.frame_prefix + MAP
        self._publisher = at.publisher("/amcl_pose", TYPE, _LATCHED)
        self._is_wanted = False
        self._at = (math.inf, math.inf, 0.0)
        self._variances: tuple[float, float] | None = None

    def publish(self, ticks: int) -> None:
        """Publish the pose if the robot has moved, or the accuracy of its pose has changed."""
        del ticks
        if not self._is_wanted:
            if not self._publisher.subscription_count:
                return
            self._is_wanted = True
        localisation = self._localisation
        if localisation.variances is not FOUND:
            localisation.update(self._time.world.time)
        if localisation.variances is self._variances and not self._has_moved():
            return
        localisation.update(self._time.world.time)
        odometry = self._robot.odometry
        self._at = (odometry.x, odometry.y, odometry.yaw)
        self._variances = localisation.variances
        self._send(localisation.pose(), localisation.variances)

    def _has_moved(self) -> bool:
        odometry = self._robot.odometry
        x, y, yaw = self._at
        turned = abs(math.remainder(odometry.yaw - yaw, math.tau))
        return turned >= UPDATE_ANGLE or distance((x, y), (odometry.x, odometry.y)) >= UPDATE_DISTANCE

    def _send(self, place: Placement, variances: tuple[float, float]) -> None:
        message = self._publisher.message()
        # An array owned by the message; a list of 36 numbers would be checked one by one.
        covariance = message.pose.covariance
        covariance[0] = covariance[7] = variances[0]
        covariance[35] = variances[1]
        stamp(message.header.stamp, self._time.now())
        message.header.frame_id = self._frame
        pose = message.pose.pose
        pose.position.x, pose.position.y = place.x, place.y
        pose.orientation.z, pose.orientation.w = place.quaternion()
        self._publisher.publish(message)
