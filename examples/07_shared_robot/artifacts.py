"""Artifacts of this project; those for the wheels and the battery come with JaCaROS."""

import math

from jacaros.artifacts import Artifact, Atom, internal_operation, operation
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.ros.node import Sample
from jacaros.robots.ros.qos import SENSOR_DATA


class Shift(Artifact):
    """The right to use the robot: one agent has it at a time, and the others wait until it is released.

    Properties:
        on_duty(Agent): the agent that has the robot; ``nobody`` at first.
        wanted_by(Agent): one property for each waiting agent.
        visits(N): number of corners reached, as counted by the driver.
    """

    def init(self) -> None:
        self.define_property("on_duty", Atom("nobody"))
        self.define_property("visits", 0)

    @operation
    async def take_over(self) -> None:
        """Acquire the robot; waits until it is free, or has it already."""
        who = Atom(self.caller)
        self.define_property("wanted_by", who)
        try:
            await self.until(lambda: self.value("on_duty") in ("nobody", who))
        finally:
            self.remove_property("wanted_by", who)
        self.update_property("on_duty", who)

    @operation
    def hand_over(self) -> None:
        """Release the robot; fails with ``not_on_duty(Caller)`` if the caller does not have it."""
        if self.value("on_duty") != self.caller:
            self.fail(f"{self.caller} does not have the robot", "not_on_duty", Atom(self.caller))
        self.update_property("on_duty", Atom("nobody"))

    @operation
    def visited(self) -> None:
        """Count another corner."""
        self.update_property("visits", self.value("visits") + 1)


class Front(RosArtifact):
    """Obstacles in front of the robot, measured by its laser.

    Properties:
        ahead(Metres): distance to the nearest obstacle within 25 degrees of straight ahead; exists from the first scan on.
    """

    FIELD = math.radians(25.0)

    def open(self) -> None:
        """Subscribe to the laser."""
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
