"""``ArtCmdVel`` and its relatives of the thesis: the motion operations of a robot.

They differ in the topic of their commands and in whether they show odometry; their operations are the
same, and those of one robot exclude each other whatever the artifact.
"""

import math
from typing import ClassVar

from jacaros.artifacts.ros.control import Velocity
from jacaros.artifacts.ros.journey import DriveTo, TurnTo, go_to
from jacaros.artifacts.ros.maneuver import Straight, Timed, Turn
from jacaros.artifacts.ros.odometer import Odometry
from jacaros.artifacts.ros.odometry import NO_ODOMETRY
from jacaros.artifacts.ros.reading import READING_OPTIONS, Reading, ReadingPolicy
from jacaros.artifacts.ros.wheels import WheeledArtifact
from jacaros.env.artifact import Out, operation


class ArtCmdVel(WheeledArtifact):
    """Drives by velocity commands on ``/cmd_vel``; closed loops follow ``/odom``.

    Lengths are metres, angles degrees (counter-clockwise positive), poses those of odometry.  Every motion
    waits until no other motion drives the robot, stops with zero velocity whatever its end, stops while its
    intention is suspended and then goes on with what remained, and fails with one of the reasons
    ``aborted(Covered)``, ``blocked(Covered)``, ``interrupted(Covered)``, ``no_odometry(Seconds)`` and
    ``timeout(Seconds)``; Covered is what was driven (metres) or turned (degrees).

    Options and the property ``moving``: those of `WheeledArtifact`.
    """

    @operation(pausable=True)
    @operation(name="moveF", pausable=True)
    async def move(self, duration: int) -> None:
        """Drive ahead by time: *duration* + 1 commands, ten a second, then zero velocity."""
        await self.perform(Timed(Velocity(self._blind_speed(), 0.0), duration + 1))

    def _blind_speed(self) -> float:
        return self.settings.limits.speed

    @operation(name="moveForward", pausable=True)
    async def move_forward(self, length: float) -> None:
        """Drive *length* metres straight ahead; backwards when it is negative."""
        self._finite(length)
        await self.perform(Straight(length))

    @operation(name="moveForward", pausable=True)
    async def move_forward_a_second(self) -> None:
        """Drive ahead for one second."""
        await self.perform(Timed(Velocity(self._blind_speed(), 0.0), 10))

    @operation(name="moveReverse", pausable=True)
    async def move_reverse(self, length: float) -> None:
        """Drive *length* metres straight back."""
        self._finite(length)
        await self.perform(Straight(-length))

    @operation(name="moveReverse", pausable=True)
    async def move_reverse_a_second(self) -> None:
        """Drive back for one second."""
        await self.perform(Timed(Velocity(-self._blind_speed(), 0.0), 10))

    @operation(pausable=True)
    @operation(name="rotateLeft", pausable=True)
    async def rotate(self, degrees: float) -> None:
        """Turn on the spot by *degrees*, to the right when negative; more than a whole turn is possible."""
        self._finite(degrees)
        await self.perform(Turn(math.radians(degrees)))

    @operation(name="rotateRight", pausable=True)
    async def rotate_right(self, degrees: float) -> None:
        """Turn *degrees* to the right."""
        self._finite(degrees)
        await self.perform(Turn(-math.radians(degrees)))

    @operation(name="rotateLeft", pausable=True)
    async def quarter_turn_left(self) -> None:
        """Turn 90 degrees to the left."""
        await self.perform(Turn(math.pi / 2.0))

    @operation(name="rotateRight", pausable=True)
    async def quarter_turn_right(self) -> None:
        """Turn 90 degrees to the right."""
        await self.perform(Turn(-math.pi / 2.0))

    @operation(name="turnTo", pausable=True)
    async def turn_to(self, heading: float) -> None:
        """Turn the short way round to *heading*, degrees from the x axis of odometry."""
        self._finite(heading)
        await self.perform(TurnTo(math.radians(heading)))

    @operation(name="driveTo", pausable=True)
    async def drive_to(self, x: float, y: float) -> None:
        """Turn towards the point *x*, *y* of odometry and drive there."""
        self._finite(x, y)
        await self.perform(DriveTo(x, y))

    @operation(name="goTo", pausable=True)
    @operation(name="driveToPose", pausable=True)
    async def go_to(self, x: float, y: float, heading: float) -> None:
        """Drive to the point *x*, *y* of odometry and turn to *heading* degrees."""
        self._finite(x, y, heading)
        await self.perform(go_to(x, y, math.radians(heading)))

    @operation(name="abortMoving")
    def abort_moving(self) -> None:
        """Stop the robot here and now: the motion that drives it and those that wait fail as aborted.

        Suspended motions are not concerned.  Without a motion it does nothing.
        """
        self.lane.abort()

    @operation(name="getCurrentPose")
    async def get_current_pose(self, x: Out, y: Out, heading: Out) -> None:
        """Give the pose of odometry: metres, metres, degrees; ``no_odometry(5)`` if none comes in 5 s."""
        for out, value in zip((x, y, heading), await self.newest(self.newest_pose, NO_ODOMETRY), strict=True):
            out.set(value)

    def _finite(self, *numbers: float) -> None:
        for number in numbers:
            if not math.isfinite(number):
                self.fail(f"a motion needs finite numbers, not {number}", "wrong_number", number)


class ArtCmdVelMux(ArtCmdVel):
    """Drives by velocity commands on ``/cmd_vel_mux/input/navi``, the navigation input of a Kobuki base."""

    command_topic = "cmd_vel_mux/input/navi"


class ArtCmdVelAndOdometry(ArtCmdVel):
    """`ArtCmdVel` that also shows odometry, on demand unless ``mode(verbose)`` is given.

    Options:
        those of `ArtCmdVel`, and those of `ReadingPolicy`.

    Properties:
        odom_cmd_vel(X, Y, Z): position in metres; 0, 0, 0 before the first message.
    """

    known_options: ClassVar = READING_OPTIONS
    odometry_property: ClassVar[str] = "odom_cmd_vel"

    _position: Reading

    def open(self) -> None:
        """Define the odometry property too."""
        name = self.robot_property(self.odometry_property)
        self._position = self.reading(name, ReadingPolicy.from_options(self.options, on_demand=True), 0, 0, 0)
        super().open()

    def on_odometry(self, odometry: Odometry) -> None:
        """Take a position for the property too."""
        super().on_odometry(odometry)
        self._position.take(odometry.position, odometry.sample.cause)

    @operation(name="getCurrentOdom")
    async def get_current_odom(self) -> None:
        """Give the odometry property the newest position; ``no_odometry(5)`` if none comes in 5 s."""
        await self.refresh(self.robot_property(self.odometry_property), self._position, NO_ODOMETRY)


class ArtCmdVelMuxAndOdometry(ArtCmdVelAndOdometry):
    """`ArtCmdVelMux` that also shows odometry, in ``odom_cmd_vel_mux(X, Y, Z)``."""

    command_topic = ArtCmdVelMux.command_topic
    odometry_property = "odom_cmd_vel_mux"
