"""Frames of one robot: their names, and goals given in any of them.

The tree follows REP 105: ``map``, ``odom``, ``base_footprint``, ``base_link``, ``base_scan``. Frames of a robot with a
namespace have it as a prefix (``robot_1/odom``), and its ``robot_1/map`` equals the ``map`` shared by all robots.
"""

import math
from typing import Any

from jacaros.plane.pose import Placement
from jacaros.ros.backend import Backend
from jacaros.ros.errors import CapabilityMissing, TransformUnavailable
from jacaros.ros.message import stamp
from jacaros.sim.navigation.localisation import Localisation

MAP, ODOMETRY, FOOTPRINT, BASE, SCAN = "map", "odom", "base_footprint", "base_link", "base_scan"
CAMERA = "camera_optical_frame"
"""Frame of images (REP 103): x to the right, y down, z ahead."""
_PATIENCE = 1.0


class FrameUnknown(Exception):
    """Raised for a pose in a frame that tf does not know."""


class Frames:
    """Frames of one robot.

    Args:
        backend: graph, whose tf knows other frames.
        namespace: namespace of the robot, or "".
        localisation: estimated pose of the robot.
    """

    def __init__(self, backend: Backend, namespace: str, localisation: Localisation) -> None:
        self._backend = backend
        self.prefix = f"{namespace}/" if namespace else ""
        self.localisation = localisation

    async def on_map(self, stamped: Any) -> Placement:
        """Transform a ``geometry_msgs/msg/PoseStamped`` to the map; its stamp is ignored, as in Nav2's planner.

        Raises:
            FrameUnknown: its frame is unknown.
        """
        pose = pose_of(stamped.pose)
        frame = stamped.header.frame_id.strip("/")
        own = frame.removeprefix(self.prefix)
        if own == MAP:
            return pose
        if own == ODOMETRY:
            return self.localisation.map_to_odom.then(pose)
        if own in (FOOTPRINT, BASE, SCAN):
            return self.localisation.pose().then(pose)
        return (await self._from_tf(frame)).then(pose)

    async def _from_tf(self, frame: str) -> Placement:
        if not frame:
            raise FrameUnknown(f"the pose has no frame; set header.frame_id to '{MAP}'")
        try:
            found = await self._backend.tf_wait(MAP, frame, timeout=_PATIENCE)
        except (TransformUnavailable, CapabilityMissing) as problem:
            raise FrameUnknown(f"unknown frame '{frame}': {problem}") from None
        x, y, _ = found.translation
        return Placement.from_quaternion(x, y, found.rotation)


def pose_of(pose: Any) -> Placement:
    """Return a ``geometry_msgs/msg/Pose`` in the plane."""
    place, rotation = pose.position, pose.orientation
    return Placement.from_quaternion(place.x, place.y, (rotation.x, rotation.y, rotation.z, rotation.w))


def fault_of(stamped: Any) -> str | None:
    """Return why a ``geometry_msgs/msg/PoseStamped`` is not a valid goal, or None."""
    return pose_fault(stamped.pose)


def pose_fault(pose: Any) -> str | None:
    """Return why a ``geometry_msgs/msg/Pose`` is invalid, or None."""
    place, rotation = pose.position, pose.orientation
    turn = (rotation.x, rotation.y, rotation.z, rotation.w)
    if not all(math.isfinite(value) for value in (place.x, place.y, *turn)):
        return "the pose contains NaN or infinity"
    if sum(value * value for value in turn) < 1e-6:
        return "the orientation of the pose is zero and not a rotation; write w: 1 for straight ahead"
    return None


def fill_in(stamped: Any, place: Placement, frame: str, time: float) -> Any:
    """Write a place into a ``geometry_msgs/msg/PoseStamped``; return the message."""
    stamp(stamped.header.stamp, time)
    stamped.header.frame_id = frame
    pose = stamped.pose
    pose.position.x, pose.position.y = place.x, place.y
    pose.orientation.z, pose.orientation.w = place.quaternion()
    return stamped
