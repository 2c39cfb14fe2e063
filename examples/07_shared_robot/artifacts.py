"""The artifacts of this project; those of the robot, its wheels and its battery, come with JaCaROS."""

import math

from jacaros.artifacts.kit.ros_artifact import RosArtifact
from jacaros.env import Artifact, Atom, internal_operation, operation
from jacaros.ros.backend import Sample
from jacaros.ros.qos import SENSOR_DATA


class Shift(Artifact):
    """Who has the robot: one at a time.  Whoever wants it asks, and whoever has it hands it over.

    Properties:
        on_duty(Who): who has the robot; ``nobody`` at the beginning.
        wanted_by(Who): for everybody who waits for it.
        visits(N): corners reached, as the driver tells.
    """

    def init(self) -> None:
        self.define_property("on_duty", Atom("nobody"))
        self.define_property("visits", 0)

    @operation
    async def take_over(self) -> None:
        """Get the robot; waits until it is free."""
        who = Atom(self.caller)
        self.define_property("wanted_by", who)
        try:
            await self.until(lambda: self.value("on_duty") == "nobody")
        finally:
            self.remove_property("wanted_by", who)
        self.update_property("on_duty", who)

    @operation
    def hand_over(self) -> None:
        """Let go of the robot; fails with ``not_on_duty(Who)`` for others than who has it."""
        if self.value("on_duty") != self.caller:
            self.fail(f"{self.caller} does not have the robot", "not_on_duty", Atom(self.caller))
        self.update_property("on_duty", Atom("nobody"))

    @operation
    def visited(self) -> None:
        """Note that another corner was reached."""
        self.update_property("visits", self.value("visits") + 1)


class Front(RosArtifact):
    """What stands in front of the robot, seen by its laser.

    Properties:
        ahead(Metres): how far it is to the nearest thing within 25 degrees to both sides.
    """

    FIELD = math.radians(25.0)

    def open(self) -> None:
        """Listen to the laser; before its first scan nothing is known."""
        self.subscription("scan", "sensor_msgs/msg/LaserScan", self.look, SENSOR_DATA)

    def look(self, sample: Sample) -> None:
        scan = sample.message
        bearings = (scan.angle_min + n * scan.angle_increment for n in range(len(scan.ranges)))
        seen = (float(r) for r, b in zip(scan.ranges, bearings, strict=True) if abs(b) <= self.FIELD)
        nearest = min((r for r in seen if r >= scan.range_min), default=float(scan.range_max))
        self.start(self.show, round(min(nearest, float(scan.range_max)), 2), cause=sample.cause)

    @internal_operation
    def show(self, metres: float) -> None:
        if self.has_property("ahead"):
            self.update_property("ahead", metres, if_new=True)
        else:
            self.define_property("ahead", metres)
