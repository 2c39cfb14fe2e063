"""Where a robot believes to be, as the localisation of ROS tells it: ``amcl_pose``, latched, when the robot has moved.

The semantics are those of ``nav2_amcl`` and of ROS 1's ``amcl``; the distances are the defaults of Nav2's.
"""

import math

from jacaros.ros.backend import Backend
from jacaros.ros.message import stamp
from jacaros.ros.qos import QoS
from jacaros.sim.navigation.frames import MAP
from jacaros.sim.navigation.localisation import FOUND, Localisation
from jacaros.sim.navigation.placement import Placement, distance
from jacaros.sim.robot import Robot
from jacaros.sim.world_time import WorldTime

UPDATE_DISTANCE = 0.25
"""Metres of odometry between two messages (``update_min_d``)."""
UPDATE_ANGLE = 0.2
"""Radians of odometry between two messages (``update_min_a``)."""

TYPE = "geometry_msgs/msg/PoseWithCovarianceStamped"
_LATCHED = QoS(durability="transient_local", depth=1)


class AmclPose:
    """Publishes the pose of one robot on the map; nothing is worked out until somebody has listened.

    Args:
        time: the world, on a clock.
        robot: which of its robots.
        localisation: where it believes to be.
        backend: the graph; it is started already.
        prefix: of the robot's topics.
        frame_prefix: of its frames.
    """

    def __init__(
        self,
        time: WorldTime,
        robot: Robot,
        localisation: Localisation,
        backend: Backend,
        prefix: str,
        frame_prefix: str,
    ) -> None:
        self._time, self._robot, self._localisation = time, robot, localisation
        self._frame = frame_prefix + MAP
        self._publisher = backend.publisher(f"{prefix}/amcl_pose", TYPE, _LATCHED)
        self._is_wanted = False
        self._at = (math.inf, math.inf, 0.0)
        self._variances: tuple[float, float] | None = None

    def publish(self) -> None:
        """Publish the pose if the robot has moved, or its place is known more or less well than before.

        The world has caught up.
        """
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
        # An array of the message's own; a list of 36 numbers would be looked at one by one.
        covariance = message.pose.covariance
        covariance[0] = covariance[7] = variances[0]
        covariance[35] = variances[1]
        stamp(message.header.stamp, self._time.now())
        message.header.frame_id = self._frame
        pose = message.pose.pose
        pose.position.x, pose.position.y = place.x, place.y
        pose.orientation.z, pose.orientation.w = place.quaternion()
        self._publisher.publish(message)

    def close(self) -> None:
        """Leave the topic."""
        self._publisher.close()
