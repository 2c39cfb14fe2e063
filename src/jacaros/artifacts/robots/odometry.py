"""``ArtOdometry``: the pose of a robot according to odometry, continuously or on demand."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar

from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.kit.faults import Faults, Header
from jacaros.artifacts.kit.options import text
from jacaros.artifacts.kit.reading import READING_OPTIONS, Reading, ReadingPolicy
from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.artifacts.robots.control import Velocity
from jacaros.plane.pose import Pose, yaw_of
from jacaros.ros.node import Sample
from jacaros.ros.qos import SENSOR_DATA
from jacaros.runtime.clock import Clock

ODOMETRY = "nav_msgs/msg/Odometry"

NO_ODOMETRY = "no_odometry"
NO_TRANSFORM = "no_transform"

STANDING = Velocity(0.02, 0.05)
"""A robot slower than this (metres and radians per second) stands still."""


@dataclass(slots=True)
class Odometry:
    """One odometry message; immutable.

    Attributes:
        position: x, y, z in metres.
        pose: x, y and heading.
        velocity: forward and angular.
        sample: the original message.
    """

    position: tuple[float, float, float]
    pose: Pose
    velocity: Velocity
    sample: Sample

    @property
    def standing(self) -> bool:
        """Whether the robot stands still."""
        moves = abs(self.velocity.linear) > STANDING.linear
        return not moves and abs(self.velocity.angular) <= STANDING.angular


def read_odometry(sample: Sample) -> Odometry:
    """Read the relevant fields of a ``nav_msgs/msg/Odometry``."""
    pose: Any = sample.message.pose.pose
    twist: Any = sample.message.twist.twist
    position = (float(pose.position.x), float(pose.position.y), float(pose.position.z))
    q = pose.orientation
    return Odometry(
        position,
        Pose(position[0], position[1], yaw_of(q.x, q.y, q.z, q.w)),
        Velocity(float(twist.linear.x), float(twist.angular.z)),
        sample,
    )


def not_finite(sample: Sample) -> tuple[str, float] | None:
    """Return the first NaN or infinite number of an odometry message with its field; None if none exists."""
    pose: Any = sample.message.pose.pose
    twist: Any = sample.message.twist.twist
    p, q = pose.position, pose.orientation
    # A sum is finite only if all its terms are: one test for nearly all messages.
    if math.isfinite(p.x + p.y + p.z + q.x + q.y + q.z + q.w + twist.linear.x + twist.angular.z):
        return None
    fields = [(f"pose.pose.position.{name}", getattr(p, name)) for name in "xyz"]
    fields += [(f"pose.pose.orientation.{name}", getattr(q, name)) for name in "xyzw"]
    fields += [("twist.twist.linear.x", twist.linear.x), ("twist.twist.angular.z", twist.angular.z)]
    return next(((name, number) for name, number in fields if not math.isfinite(number)), None)


class Odometer:
    """The newest odometry of one robot; bad messages are counted and not used.

    Args:
        faults: counts bad messages.
        clock: measures how late messages are.
        on_reading: called with every good message.
        frame: see `Header`.
        placed: converts odometry to the driving frame, None while that is unknown; see
            `jacaros.artifacts.robots.driving_frame`.

    Attributes:
        newest: None until the first message.
        count: number of good messages.
        trusted: False if the newest message was unusable or its frame has no transform: the robot's present pose is
            unknown.
        lacking: the failure reason for missing odometry: ``no_odometry``, or ``no_transform`` if messages arrive and
            only the frame is unknown.
    """

    def __init__(
        self,
        faults: Faults,
        clock: Clock,
        on_reading: Callable[[Odometry], None] | None = None,
        frame: str = "",
        placed: Callable[[Odometry], Odometry | None] | None = None,
    ) -> None:
        self.newest: Odometry | None = None
        self.count = 0
        self.trusted = True
        self.lacking = NO_ODOMETRY
        self._placed = placed
        self._faults = faults
        self._header = Header(faults, clock, frame)
        self._on_reading = on_reading

    @property
    def faults(self) -> int:
        """Number of bad messages."""
        return self._faults.total

    @property
    def frame(self) -> str:
        """The frame of the newest poses; empty while it is unknown."""
        return self._header.frame

    @property
    def late(self) -> float:
        """Seconds by which the newest message arrived later than earlier ones."""
        return self._header.late

    def take(self, sample: Sample) -> None:
        """Handle a message; the callback of the subscription."""
        wrong = not_finite(sample)
        if wrong is not None:
            self.trusted, self.lacking = False, NO_ODOMETRY
            self._faults.not_finite(*wrong)
            return
        if not self._header.accepts(sample):
            return
        odometry: Odometry | None = read_odometry(sample)
        if self._placed is not None and odometry is not None:
            odometry = self._placed(odometry)
        if odometry is None:
            self.trusted, self.lacking = False, NO_TRANSFORM
            return
        self.newest = odometry
        self.trusted, self.lacking = True, NO_ODOMETRY
        self.count += 1
        if self._on_reading is not None:
            self._on_reading(self.newest)

    def age(self, now: float) -> float | None:
        """Return the age of the newest message in seconds, corrected by its delay; None before the first."""
        return None if self.newest is None else now - self.newest.sample.stamp + self._header.late


class ArtOdometry(RosArtifact):
    """Shows the odometry of ``/odom``.

    The robot's name is the prefix of the topic only, as in the thesis. No signal is sent with an update: the event of
    the property is the only event of a message. Operations that ask for odometry wait for the first message and fail
    with ``no_odometry(5)`` if none arrives within 5 s.

    Options:
        mode(verbose) or mode(on_demand), rate(Hz), dead_band(D), latest_only(false), expire(S): see `ReadingPolicy`;
            a dead band has one number for each field of the property.
        topic(T): another topic.
        frame(F): the only frame in which odometry is accepted; default: that of the first message.

    Properties:
        odom(X, Y, Z): position in metres; 0, 0, 0 before the first message. With `expire` the property does not exist
            then.
        pose(X, Y, Heading): metres, and degrees in (-180, 180].
    """

    known_options: ClassVar = {**READING_OPTIONS, "topic": text, "frame": text}
    on_demand: ClassVar[bool] = False

    _position: Reading
    _pose: Reading

    def open(self) -> None:
        """Define the properties and subscribe."""
        policy = ReadingPolicy.from_options(self.options, self.on_demand)
        self._position = self.reading("odom", policy, 0, 0, 0)
        self._pose = self.reading("pose", policy, 0, 0, 0)
        topic = str(self.options.get("topic", "odom"))
        odometer = Odometer(self.faults_of(topic), self.clock, self._take, str(self.options.get("frame", "")))
        self.subscription(topic, ODOMETRY, odometer.take, SENSOR_DATA)

    def _take(self, odometry: Odometry) -> None:
        position, pose = (self._position, odometry.position), (self._pose, pose_values(odometry))
        self.take_together(odometry.sample.cause, position, pose)

    @operation(name="getCurrentOdom")
    async def get_current_odom(self) -> None:
        """Update the properties to the newest values, whatever mode, rate and dead band are."""
        await self.refresh("odom", self._position, NO_ODOMETRY)
        await self.refresh("pose", self._pose, NO_ODOMETRY)

    @operation(name="getCurrentOdom")
    async def give_current_odom(self, x: Out, y: Out, z: Out) -> None:
        """Give the newest position to the caller."""
        await self._give(self._position, x, y, z)

    @operation(name="getCurrentPose")
    async def give_current_pose(self, x: Out, y: Out, heading: Out) -> None:
        """Give the newest pose to the caller: metres, metres, degrees."""
        await self._give(self._pose, x, y, heading)

    async def _give(self, reading: Reading, *outs: Out) -> None:
        for out, value in zip(outs, await self.newest(reading, NO_ODOMETRY), strict=True):
            out.set(value)


class ArtOdometryOnDemand(ArtOdometry):
    """Shows odometry only when an agent requests it with ``getCurrentOdom``."""

    on_demand = True


def pose_values(odometry: Odometry) -> tuple[float, float, float]:
    """x and y in metres, heading in degrees."""
    pose = odometry.pose
    return (pose.x, pose.y, math.degrees(pose.yaw))
