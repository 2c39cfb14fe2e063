"""The pose of a robot: ``ArtOdometry``, frames in which it drives, and advice about drift."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar
from weakref import WeakSet

from jacaros.artifacts.env.artifact import Out, operation
from jacaros.robots.artifacts.drive_model import Velocity
from jacaros.robots.kit.options import text
from jacaros.robots.kit.reading import READING_OPTIONS, Reading, Stamps
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.plane.pose import ORIGIN, Pose, normalised
from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.errors import TransformUnavailable
from jacaros.robots.ros.message import to_seconds
from jacaros.robots.ros.node import Sample
from jacaros.robots.ros.qos import SENSOR_DATA
from jacaros.robots.streams import ReadingPolicy

ODOMETRY = "nav_msgs/msg/Odometry"

NO_ODOMETRY = "no_odometry"
NO_TRANSFORM = "no_transform"


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


def not_finite(message: Any) -> tuple[str, float] | None:
    """Return the first NaN or infinite number of an odometry message with its field; None if none exists."""
    twist, p, q = message.twist.twist, message.pose.pose.position, message.pose.pose.orientation
    fields = [(f"pose.pose.position.{name}", getattr(p, name)) for name in "xyz"]
    fields += [(f"pose.pose.orientation.{name}", getattr(q, name)) for name in "xyzw"]
    fields += [("twist.twist.linear.x", twist.linear.x), ("twist.twist.angular.z", twist.angular.z)]
    return next(((name, number) for name, number in fields if not math.isfinite(number)), None)


PlaceOdometry = Callable[[Odometry], Odometry | None]
"""Converts odometry to another frame; returns None while the transform is unknown."""


class Odometer:
    """The newest odometry of one robot; bad messages are counted and not used.

    Args:
        artifact: subscribes to the topic, and reports bad messages.
        topic: the robot's topic.
        on_reading: called with every good message.
        frame: see `Stamps`.
        placed: converts odometry to the driving frame, None while that is unknown; see `driving_frame`.

    Attributes:
        faults: bad messages.
        header: checks frames and stamps.
        newest: None until the first message.
        count: number of good messages.
        trusted: False if the newest message was unusable or its frame has no transform: the robot's present pose is
            unknown.
        lacking: the failure reason for missing odometry: ``no_odometry``, or ``no_transform`` if messages arrive and
            only the frame is unknown.
        leaps: how often the driving frame has leapt, as when localisation finds the robot elsewhere.
    """

    def __init__(
        self,
        artifact: RosArtifact,
        topic: str,
        on_reading: Callable[[Odometry], None],
        frame: str = "",
        placed: PlaceOdometry | None = None,
    ) -> None:
        self.newest: Odometry | None = None
        self.count = 0
        self.trusted, self.lacking = True, NO_ODOMETRY
        self.leaps, self._correction = 0, ORIGIN
        self.faults = artifact.faults_of(topic)
        self.header = Stamps(self.faults, artifact.clock, frame)
        self._on_reading, self._placed = on_reading, placed
        artifact.subscription(topic, ODOMETRY, self.take, SENSOR_DATA)

    def take(self, sample: Sample) -> None:
        """Handle a message; the callback of the subscription."""
        message: Any = sample.message
        twist, p, q = message.twist.twist, message.pose.pose.position, message.pose.pose.orientation
        x, y, z, w, linear, angular = q.x, q.y, q.z, q.w, twist.linear.x, twist.angular.z
        # A sum is finite only if all its terms are: one test for nearly all messages.
        if (
            not math.isfinite(p.x + p.y + p.z + x + y + z + w + linear + angular)
            and (wrong := not_finite(message)) is not None
        ):
            self.trusted, self.lacking = False, NO_ODOMETRY
            self.faults.not_finite(*wrong)
            return
        header = message.header
        if not self.header.accept(to_seconds(header.stamp), sample.stamp, header.frame_id):
            return
        position = (float(p.x), float(p.y), float(p.z))
        yaw = math.atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z))  # that of `yaw_of`, inlined
        pose, velocity = Pose(position[0], position[1], yaw), Velocity(float(linear), float(angular))
        read = Odometry(position, pose, velocity, sample)
        odometry = read if self._placed is None else self._placed(read)
        if odometry is None:
            self.trusted, self.lacking = False, NO_TRANSFORM
            return
        if odometry is not read:
            self._watch_frame(odometry.pose.then(pose.inverse()), pose)
        self.newest = odometry
        self.trusted, self.lacking = True, NO_ODOMETRY
        self.count += 1
        self._on_reading(odometry)

    def _watch_frame(self, correction: Pose, at: Pose) -> None:
        """Count a leap of the driving frame."""
        if self.newest is not None and _exceeds(_apart(self._correction, correction, at), LEAP):
            self.leaps += 1
        self._correction = correction

    def lack(self) -> str:
        """Return why there is no odometry, for messages."""
        if self.lacking == NO_TRANSFORM:
            return "no transform from the frame of odometry to the driving frame; is the robot localised?"
        bad = f" ({self.faults.total} messages were bad)" if self.faults.total else ""
        return f"no odometry{bad}"

    def age(self, now: float) -> float | None:
        """Return the age of the newest message in seconds, corrected by its delay; None before the first."""
        return None if self.newest is None else now - self.newest.sample.stamp + self.header.late


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
        Odometer(self, self.option("topic", "odom"), self._take, self.option("frame", ""))

    def _take(self, odometry: Odometry) -> None:
        pose = odometry.pose
        values = (pose.x, pose.y, math.degrees(pose.yaw))
        self.take_together(odometry.sample.cause, (self._position, odometry.position), (self._pose, values))

    @operation(name="getCurrentOdom")
    async def get_current_odom(self) -> None:
        """Update the properties to the newest values, whatever mode, rate and dead band are."""
        await self.refresh("odom", self._position, NO_ODOMETRY)
        await self.refresh("pose", self._pose, NO_ODOMETRY)

    @operation(name="getCurrentOdom")
    async def give_current_odom(self, x: Out, y: Out, z: Out) -> None:
        """Give the newest position to the caller."""
        await self.give_newest(self._position, NO_ODOMETRY, x, y, z)

    @operation(name="getCurrentPose")
    async def give_current_pose(self, x: Out, y: Out, heading: Out) -> None:
        """Give the newest pose to the caller: metres, metres, degrees."""
        await self.give_newest(self._pose, NO_ODOMETRY, x, y, heading)


class ArtOdometryOnDemand(ArtOdometry):
    """Shows odometry only when an agent requests it with ``getCurrentOdom``."""

    on_demand = True


# The frame in which a robot drives: odometry's own, or one that localisation corrects, such as ``map``.

OLDEST_TRANSFORM = 2.0
"""Seconds by which a transform may be older than odometry; localisation publishes one with every scan."""


def driving_frame(ros: Backend, name: str) -> PlaceOdometry:
    """Return the conversion of odometry to another frame (REP 105), by the newest transform; None while it is unknown.

    Odometry drifts, so a point of its frame moves over time; localisation publishes on tf the pose of that frame in
    ``map``.

    Args:
        ros: the graph; its tf is subscribed to from now on.
        name: name of the frame.

    Raises:
        CapabilityMissing: the graph has no tf.
    """
    ros.tf_listen()

    def placed(odometry: Odometry) -> Odometry | None:
        header = odometry.sample.message.header
        try:
            transform = ros.tf_lookup(name, header.frame_id)
        except TransformUnavailable:
            return None
        told = to_seconds(header.stamp)
        # Both stamps are from the robot's clock, which may be wrong but is the same for both.
        if told and transform.stamp and told - transform.stamp > OLDEST_TRANSFORM:
            return None
        position = transform.apply(odometry.position)
        heading = normalised(odometry.pose.yaw + transform.yaw)
        return replace(odometry, position=position, pose=Pose(position[0], position[1], heading))

    return placed


# Advice for robots that drive by odometry although a localisation finds them elsewhere.

LOCALISED = "geometry_msgs/msg/PoseWithCovarianceStamped"
TOLERANCE = (0.05, math.radians(3.0))
"""Metres and radians that odometry may drift: the accuracy of a navigation goal."""
LEAP = (0.5, math.radians(30.0))
"""A larger change between two poses is a new estimate, as after a pose from rviz, and not a drift."""
OUTDATED, AHEAD = 1.0, 0.1
"""Seconds over which the motion is extrapolated: from the newest odometry back to a pose, and forward to one. Over a slow
network odometry does not yet show that the robot turns, and a pose that is further ahead would look like a drift."""

_advised: WeakSet[Backend] = WeakSet()


class Drift:
    """Compare odometry with localised poses (``amcl_pose``), and log once per run that they drift apart.

    Args:
        ros: the graph.
        odometer: odometry of the robot in its own frame.
        driving: whether a motion relies on that odometry now.
        log: takes the advice.
    """

    def __init__(
        self, ros: Backend, odometer: Odometer, driving: Callable[[], bool], log: Callable[[str], None]
    ) -> None:
        self._ros, self._odometer, self._driving, self._log = ros, odometer, driving, log
        self._first: Pose | None = None
        self._last: Pose | None = None

    def take(self, sample: Sample) -> None:
        """Handle a localised pose; the callback of the subscription."""
        at = self._odometry_at(to_seconds(sample.message.header.stamp))
        if at is None or self._ros in _advised:
            return
        correction = Pose.of(sample.message.pose.pose).then(at.inverse())
        if self._first is None or self._last is None or _exceeds(_apart(self._last, correction, at), LEAP):
            self._first = correction
        self._last = correction
        metres, angle = _apart(self._first, correction, at)
        if _exceeds((metres, angle), TOLERANCE) and self._driving():
            _advised.add(self._ros)
            self._log(
                f"note: odometry and localisation have drifted {metres:.2f} m and {math.degrees(angle):.1f} degrees "
                "apart; the option `frame(map)` corrects it"
            )

    def _odometry_at(self, stamp: float) -> Pose | None:
        """Return the pose in odometry at *stamp*, extrapolated from the newest: localisation is late by its computation."""
        odometer = self._odometer
        newest = odometer.newest
        if newest is None or not odometer.trusted:
            return None
        late = to_seconds(newest.sample.message.header.stamp) - stamp
        if not -AHEAD <= late <= OUTDATED:
            return None
        ahead = newest.pose.yaw - 0.5 * late * newest.velocity.angular
        metres = late * newest.velocity.linear
        return Pose(
            newest.pose.x - metres * math.cos(ahead),
            newest.pose.y - metres * math.sin(ahead),
            newest.pose.yaw - late * newest.velocity.angular,
        )


def _apart(one: Pose, other: Pose, at: Pose) -> tuple[float, float]:
    """Return how far two corrections put the robot apart: metres and radians."""
    a, b = one.then(at), other.then(at)
    return math.dist(a[:2], b[:2]), abs(normalised(a.yaw - b.yaw))


def _exceeds(apart: tuple[float, float], limits: tuple[float, float]) -> bool:
    return any(value > limit for value, limit in zip(apart, limits, strict=True))
