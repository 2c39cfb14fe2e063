"""Artifacts that drive wheels: ``ArtCmdVel`` and its relatives in the thesis, and their common parent.

They differ in their command topic and in whether they show odometry. Their operations are the same, and those of one
robot exclude each other, whichever artifact they belong to.
"""

import math
from typing import ClassVar

from jacaros.artifacts.env.artifact import Out, operation
from jacaros.robots.artifacts.drive_model import Velocity
from jacaros.robots.artifacts.maneuver import DriveTo, Straight, Timed, Turn, TurnTo, go_to
from jacaros.robots.artifacts.motion import WheeledArtifact
from jacaros.robots.artifacts.odometry import Odometry
from jacaros.robots.kit.reading import READING_OPTIONS, Reading
from jacaros.robots.streams import ReadingPolicy

BLIND_TURN = Velocity(0.0, 0.5)
"""Turn rate of `rotateD` (rad/s), as in the original system."""
BLIND_TURN_PERIOD = 0.5
"""Seconds of turning per command of `rotateD`."""


class ArtCmdVel(WheeledArtifact):
    """Drives by velocity commands on ``/cmd_vel``; closed loops follow ``/odom``.

    Lengths are in metres, angles in degrees (positive counter-clockwise), poses in odometry's frame, or in the frame
    of the option ``frame(F)``. Every motion waits until no other motion drives the robot, and always ends with zero
    velocity. It stops while its intention is suspended, and then continues with the rest. It fails with one of the
    reasons ``aborted(Covered)``, ``blocked(Covered)``, ``does_not_move(Cause)`` (``unmatched``, ``no_reaction`` or
    ``dead_band``), ``late(Delay)``, ``interrupted(Covered)``, ``no_odometry(Seconds)``, ``no_transform(Seconds)`` (with
    ``frame(F)``: localisation publishes nothing) and ``timeout(Seconds)``; Covered is the distance driven (metres) or
    the angle turned (degrees). The delay and the abilities of the robot are measured while it drives.

    Options and the properties ``moving`` and ``drive_quality``: those of `WheeledArtifact`.
    """

    @operation(pausable=True)
    @operation(name="moveF", pausable=True)
    async def move(self, duration: int) -> None:
        """Drive ahead by time: *duration* + 1 commands, ten per second, then zero velocity."""
        await self.perform(Timed(Velocity(self._blind_speed(), 0.0), duration + 1))

    def _blind_speed(self) -> float:
        return self.settings.limits.speed

    @operation(name="moveForward", pausable=True)
    async def move_forward(self, length: float) -> None:
        """Drive *length* metres straight ahead; backwards if negative."""
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
        """Turn on the spot by *degrees*, to the right if negative; more than a full turn is possible."""
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

    @operation(name="rotateD", pausable=True)
    async def rotate_by_time(self, duration: int) -> None:
        """Turn left by time: 0.5 rad/s for *duration* half seconds, about 14 degrees each; to the right if negative."""
        turn = math.copysign(self.settings.limits.clip(BLIND_TURN).angular, duration)
        await self.perform(
            Timed(Velocity(0.0, turn), round(abs(duration) * BLIND_TURN_PERIOD / Timed.period))
        )

    @operation(name="turnTo", pausable=True)
    async def turn_to(self, heading: float) -> None:
        """Turn the short way round to *heading*, in degrees from the x axis of odometry."""
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

    @operation(name="getCurrentPose")
    async def get_current_pose(self, x: Out, y: Out, heading: Out) -> None:
        """Give the pose in odometry: metres, metres, degrees; fails with ``no_odometry(5)`` if none arrives within 5
        s."""
        await self.give_newest(self.newest_pose, self.odometer.lacking, x, y, heading)

    def _finite(self, *numbers: float) -> None:
        for number in numbers:
            if not math.isfinite(number):
                self.fail(f"expected a finite number, found {number}", "wrong_number", number)


class ArtCmdVelMux(ArtCmdVel):
    """Drives by velocity commands on ``/cmd_vel_mux/input/navi``, the navigation input of a Kobuki base."""

    command_topic = "cmd_vel_mux/input/navi"


class ArtVelocity(ArtCmdVel):
    """Drives by velocity commands on ``/mobile_base/commands/velocity``, the direct input of a Kobuki base."""

    command_topic = "mobile_base/commands/velocity"


class ArtCmdVelAndOdometry(ArtCmdVel):
    """`ArtCmdVel` that also shows odometry, on demand unless ``mode(verbose)`` is given.

    Options: those of `ArtCmdVel`, and those of `ReadingPolicy`.

    Properties:
        odom_cmd_vel(X, Y, Z): position in metres; 0, 0, 0 before the first message.
    """

    known_options: ClassVar = READING_OPTIONS
    odometry_property: ClassVar[str] = "odom_cmd_vel"

    _position: Reading

    def open(self) -> None:
        """Also define the odometry property."""
        name = self.robot_property(self.odometry_property)
        self._position = self.reading(name, ReadingPolicy.from_options(self.options, on_demand=True), 0, 0, 0)
        super().open()

    def on_odometry(self, odometry: Odometry) -> None:
        """Also update the odometry property."""
        super().on_odometry(odometry)
        self._position.take(odometry.position, odometry.sample.cause)

    @operation(name="getCurrentOdom")
    async def get_current_odom(self) -> None:
        """Update the odometry property to the newest position; fails with ``no_odometry(5)`` if none arrives within 5
        s."""
        await self.refresh(self.robot_property(self.odometry_property), self._position, self.odometer.lacking)


class ArtCmdVelMuxAndOdometry(ArtCmdVelAndOdometry):
    """`ArtCmdVelMux` that also shows odometry.

    Properties:
        odom_cmd_vel_mux(X, Y, Z): position in metres; 0, 0, 0 before the first message.
    """

    command_topic = ArtCmdVelMux.command_topic
    odometry_property = "odom_cmd_vel_mux"
