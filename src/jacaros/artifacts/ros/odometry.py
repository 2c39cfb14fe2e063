"""``ArtOdometry``: where a robot is, by its odometry, told by itself or on demand."""

import math
from typing import ClassVar

from jacaros.artifacts.ros.odometer import ODOMETRY, Odometer, Odometry
from jacaros.artifacts.ros.options import text
from jacaros.artifacts.ros.reading import READING_OPTIONS, Reading, ReadingPolicy
from jacaros.artifacts.ros.ros_artifact import RosArtifact
from jacaros.env.artifact import Out, operation
from jacaros.ros.qos import SENSOR_DATA

NO_ODOMETRY = "no_odometry"


class ArtOdometry(RosArtifact):
    """Shows the odometry of ``/odom``.

    A robot's name stands before the topic only, as in the thesis.  No signal goes with an update: the
    property's own event is the one event of a message.  Operations that ask for odometry wait for the first
    message and fail with ``no_odometry(5)`` when none comes in 5 s.

    Options:
        mode(verbose) or mode(on_demand), rate(Hz), dead_band(D), latest_only(false), expire(S): see `ReadingPolicy`;
            the fields of a dead band are those of each property.
        topic(T): another topic.
        frame(F): the only frame in which odometry is believed; that of the first message by default.

    Properties:
        odom(X, Y, Z): position in metres; 0, 0, 0 before the first message.  With `expire` it is not there then.
        pose(X, Y, Heading): metres and degrees in (-180, 180].
    """

    known_options: ClassVar = {**READING_OPTIONS, "topic": text, "frame": text}
    on_demand: ClassVar[bool] = False

    _position: Reading
    _pose: Reading

    def open(self) -> None:
        """Define the properties and listen."""
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
        """Give the properties the newest values, whatever mode, rate and dead band say."""
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
    """Shows odometry only when an agent asks by ``getCurrentOdom``."""

    on_demand = True


def pose_values(odometry: Odometry) -> tuple[float, float, float]:
    """x and y in metres, heading in degrees."""
    pose = odometry.pose
    return (pose.x, pose.y, math.degrees(pose.heading))
