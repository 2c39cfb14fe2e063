"""The frames of one robot: their names, its transforms and ``amcl_pose``, and poses given in any frame.

The tree follows REP 105: ``map``, ``odom``, ``base_footprint``, ``base_link``, ``base_scan``. Frames of a robot with a
namespace have it as a prefix (``robot_1/odom``), and its ``robot_1/map`` equals the ``map`` shared by all robots.
"""

import math
from contextlib import suppress
from typing import Any

from jacaros.robots.plane.pose import Placement
from jacaros.robots.ros.errors import CapabilityMissing, RosError, TransformUnavailable, UnknownInterface
from jacaros.robots.ros.node import Capability, Publisher
from jacaros.robots.ros.qos import QoS
from jacaros.robots.world.graph.on_graph import LATCHED, RobotOnGraph
from jacaros.robots.world.physics.localisation import OdometryMoves

MAP, ODOMETRY, FOOTPRINT, BASE, SCAN = "map", "odom", "base_footprint", "base_link", "base_scan"
POSE = "geometry_msgs/msg/PoseStamped"
POSE_WITH_COVARIANCE = "geometry_msgs/msg/PoseWithCovarianceStamped"
_PATIENCE = 1.0
_HERE = Placement(0.0, 0.0)


class FrameUnknown(Exception):
    """Raised for a pose in a frame that tf does not know."""


async def on_map(at: RobotOnGraph, stamped: Any) -> Placement:
    """Transform a ``geometry_msgs/msg/PoseStamped`` to the map; its stamp is ignored, as in Nav2's planner.

    Raises:
        FrameUnknown: its frame is unknown.
    """
    pose = pose_of(stamped.pose)
    frame = stamped.header.frame_id.strip("/")
    own = frame.removeprefix(at.frame_prefix)
    if own == MAP:
        return pose
    if own == ODOMETRY:
        return at.localisation.map_to_odom.then(pose)
    if own in (FOOTPRINT, BASE, SCAN):
        return at.localisation.pose().then(pose)
    if not frame:
        raise FrameUnknown(f"the pose has no frame; set header.frame_id to '{MAP}'")
    try:
        found = await at.backend.tf_wait(MAP, frame, timeout=_PATIENCE)
    except (TransformUnavailable, CapabilityMissing) as problem:
        raise FrameUnknown(f"unknown frame '{frame}': {problem}") from None
    x, y, _ = found.translation
    return Placement.from_quaternion(x, y, found.rotation).then(pose)


def pose_of(pose: Any) -> Placement:
    """Return a ``geometry_msgs/msg/Pose`` in the plane."""
    place, rotation = pose.position, pose.orientation
    return Placement.from_quaternion(place.x, place.y, (rotation.x, rotation.y, rotation.z, rotation.w))


def pose_fault(pose: Any) -> str | None:
    """Return why a ``geometry_msgs/msg/Pose`` is invalid, or None."""
    place, rotation = pose.position, pose.orientation
    turn = (rotation.x, rotation.y, rotation.z, rotation.w)
    if not all(math.isfinite(value) for value in (place.x, place.y, *turn)):
        return "the pose contains NaN or infinity"
    if sum(value * value for value in turn) < 1e-6:
        return "the orientation of the pose is zero and not a rotation; write w: 1 for straight ahead"
    return None


def _write(pose: Any, place: Placement) -> None:
    """Write a place into a ``geometry_msgs/msg/Pose``."""
    pose.position.x, pose.position.y = place.x, place.y
    pose.orientation.z, pose.orientation.w = place.quaternion()


def stamped_pose(at: RobotOnGraph, place: Placement, frame: str) -> Any:
    """Return a ``geometry_msgs/msg/PoseStamped`` of now in a frame of the robot."""
    message = at.backend.message(POSE)
    at.fill_header(message.header, frame)
    _write(message.pose, place)
    return message


class RobotTransforms:
    """Publishes one robot's frames while there are subscribers.

    ``map`` to ``odom`` and ``odom`` to ``base_footprint`` are published on ``/tf`` at 20 Hz. ``base_footprint`` to
    ``base_link`` to ``base_scan``, all at the same place, and the robot's own ``map`` if it has a namespace, are published
    on ``/tf_static``, once.
    """

    def __init__(self, at: RobotOnGraph) -> None:
        self._at = at
        self._publisher = self._join()
        self._static_is_out = False
        if at.backend.name != "memory":
            # Other graphs do not report subscriptions to /tf_static alone.
            self._publish_static()

    def _join(self) -> Publisher | None:
        backend = self._at.backend
        if Capability.TRANSFORMS not in backend.capabilities:
            return None
        # Not `tf_broadcast`, which does not report subscriptions.
        try:
            return self._at.keep(backend.publisher("/tf", "tf2_msgs/msg/TFMessage", QoS(depth=100)))
        except UnknownInterface:  # not every ROS 2 installation has tf2_msgs
            return None

    def publish(self, ticks: int) -> None:
        """Publish the estimated pose at every tick."""
        at, publisher = self._at, self._publisher
        if publisher is None or not publisher.subscription_count:
            return
        self._publish_static()
        at.localisation.update(at.time.world.time)
        moved = self._transform(ODOMETRY, FOOTPRINT, at.robot.odometry.placement)
        corrected = self._transform(MAP, ODOMETRY, at.localisation.map_to_odom)
        publisher.publish(publisher.message(transforms=[moved, corrected]))

    def _publish_static(self) -> None:
        if self._static_is_out or self._publisher is None:
            return
        self._static_is_out = True
        transforms = [self._transform(FOOTPRINT, BASE), self._transform(BASE, SCAN)]
        if self._at.frame_prefix:
            transforms.append(self._transform("", MAP))
            transforms[-1].header.frame_id = MAP
        with suppress(RosError):  # the type exists, as that of the publisher did
            for transform in transforms:
                self._at.backend.tf_broadcast(transform, static=True)

    def _transform(self, parent: str, child: str, place: Placement = _HERE) -> Any:
        message = self._at.backend.message("geometry_msgs/msg/TransformStamped")
        self._at.fill_header(message.header, parent)
        message.child_frame_id = self._at.frame_prefix + child
        translation, rotation = message.transform.translation, message.transform.rotation
        translation.x, translation.y = place.x, place.y
        rotation.z, rotation.w = place.quaternion()
        return message


class AmclPose:
    """Publishes the estimated pose of one robot on the map; idle until the first subscription.

    It is published after motion, latched, as by ``nav2_amcl`` and ROS 1's ``amcl``; the distances are the defaults of
    Nav2's.
    """

    def __init__(self, at: RobotOnGraph) -> None:
        self._at = at
        self._publisher = at.publisher("/amcl_pose", POSE_WITH_COVARIANCE, LATCHED)
        self._is_wanted = False
        self._moves = OdometryMoves(at.robot.odometry)
        self._variances: tuple[float, float] | None = None

    def publish(self, ticks: int) -> None:
        """Publish the pose if the robot has moved, or the accuracy of its pose has changed."""
        self._is_wanted = self._is_wanted or bool(self._publisher.subscription_count)
        if not self._is_wanted:
            return
        localisation, time = self._at.localisation, self._at.time.world.time
        if not localisation.settled:
            localisation.update(time)
        if not self._moves.enough() and localisation.variances is self._variances:
            return
        localisation.update(time)
        self._moves.begin()
        self._variances = variances = localisation.variances
        message = self._publisher.message()
        # An array owned by the message; a list of 36 numbers would be checked one by one.
        covariance = message.pose.covariance
        covariance[0] = covariance[7] = variances[0]
        covariance[35] = variances[1]
        self._at.fill_header(message.header, MAP)
        _write(message.pose.pose, localisation.pose())
        self._publisher.publish(message)
