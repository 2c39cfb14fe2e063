"""Artifacts that drive wheels: ``ArtCmdVel`` and its relatives in the thesis, and their common parent.

They differ in their command topic and in whether they show odometry. Their operations are the same, and those of one
robot exclude each other, whichever artifact they belong to.
"""

import math
from collections.abc import Callable
from pathlib import Path
from typing import ClassVar

from jacaros.artifacts.env.arbiter import WHEELS
from jacaros.artifacts.env.artifact import Out, operation
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.artifacts.kit.connection import MATCH_OPTIONS
from jacaros.artifacts.kit.options import positive, text
from jacaros.artifacts.kit.reading import READING_OPTIONS, Reading, ReadingPolicy
from jacaros.artifacts.robots.control import STANDSTILL, Limits, Velocity
from jacaros.artifacts.robots.drift import LOCALISED, Drift
from jacaros.artifacts.robots.drive_model import DriveModel
from jacaros.artifacts.robots.driving_frame import DrivingFrame
from jacaros.artifacts.robots.journey import DriveTo, TurnTo, go_to
from jacaros.artifacts.robots.maneuver import Maneuver, Straight, Timed, Turn
from jacaros.artifacts.robots.motion import Motion, MotionFailed, MotionSettings, Wheels
from jacaros.artifacts.robots.motion_claim import motions_of
from jacaros.artifacts.robots.odometry import ODOMETRY, Odometer, Odometry, pose_values
from jacaros.artifacts.robots.quality_file import read_quality, write_quality
from jacaros.ros.errors import CapabilityMissing
from jacaros.ros.guarded import guarded_by
from jacaros.ros.names import frame_name
from jacaros.ros.qos import SENSOR_DATA

TWIST = "geometry_msgs/msg/Twist"

TURTLEBOT = Limits()

BLIND_TURN = Velocity(0.0, 0.5)
"""Turn rate of `rotateD` (rad/s), as in the original system."""
BLIND_TURN_PERIOD = 0.5
"""Seconds of turning per command of `rotateD`."""

STATES = ("driving", "turning", "waiting", "paused")
"""States of a motion, by precedence: the property ``moving`` shows one of them."""


class WheeledArtifact(Wheels):
    """An artifact whose operations drive a robot with `perform`.

    Options:
        speed(V), turn_speed(D): cruise speeds, metres and degrees per second (1 m/s and 57 degrees/s as in the
            thesis, limited to what the robot can do). A number among the arguments is the speed too, as in
            ``makeArtifact("wheels", "ArtVelocity", [0.4], Id)``.
        max_speed(V), max_turn_speed(D), acceleration(A), turn_acceleration(D): limits of the robot; default: a
            TurtleBot.
        timeout(S): maximum driving time of a motion; default: four times the time needed plus 30 s.
        odometry_timeout(S): how long a motion stands and waits for odometry before it fails (5 s).
        command_topic(T), odometry_topic(T): other topics.
        match_timeout(S): how long a motion stands and waits until the robot's base subscribes to the command topic (3
            s); otherwise its first commands would be lost.
        unmatched(W): effect of a base that has not subscribed by then: ``warn`` (default; the motion begins) or
            ``fail``, with ``unmatched(Topic)``.
        odometry_frame(F): the only frame in which odometry is accepted; default: that of the first message.
        quality_file(F): keep what is measured of the robot in this file, for the next run.
        frame(F): the frame of all poses, such as ``map``: motions use odometry corrected by localisation on tf, so
            that errors of slipping wheels do not add up; default: odometry's own frame.

    Properties:
        moving(State): ``stopped``, ``driving``, ``turning``, ``waiting`` or ``paused``.
        drive_quality(Delay, Acceleration, DeadBand): what was measured of the robot, after the first motion: seconds from
            a command until odometry shows its effect, m/s2 (at most the declared one), and the least speed that
            rolls, in m/s (0 while none was found).

    Signals:
        motion_interrupted(Why): the robot was not watched for a while and has been stopped. Why is
            ``delayed(Seconds)`` (the process was frozen or stuck), ``no_odometry(Seconds)``,
            ``clock_jumped(Seconds)`` or ``guard_tripped``.

    Attributes:
        further_uses: resources that the motions use.
        motions: motions that drive the robot or wait for it; shared with all artifacts of the same robot.
        matching: lets motions wait until the robot's base receives commands.
        odometer: the newest odometry.
        settings: speeds and time-outs.
        newest_pose: x, y and heading in degrees, for operations that return them.
    """

    known_options: ClassVar = {
        "speed": positive,
        "turn_speed": positive,
        "max_speed": positive,
        "max_turn_speed": positive,
        "acceleration": positive,
        "turn_acceleration": positive,
        "timeout": positive,
        "odometry_timeout": positive,
        "command_topic": text,
        "odometry_topic": text,
        "odometry_frame": text,
        "frame": text,
        "quality_file": text,
        **MATCH_OPTIONS,
    }
    robot_in_properties = True
    command_topic: ClassVar[str] = "cmd_vel"
    further_uses: ClassVar[tuple[str, ...]] = (WHEELS,)

    newest_pose: Reading

    def init(self, *arguments: object) -> None:
        """Read the robot's name, a speed in m/s, and options; all are optional."""
        super().init(*(_speed(argument) for argument in arguments))

    def open(self) -> None:
        """Open the command topic and odometry; nothing is published before the first motion."""
        self.settings = self._settings()
        self._motions: dict[Motion, str] = {}
        self._shown: tuple[float, float, float] | None = None
        self.define_property(self.robot_property("moving"), Atom("stopped"))
        self.motions = motions_of(self.ros, self.robot_prefix)
        self.newest_pose = Reading(ReadingPolicy(on_demand=True), self.clock)
        self._commands = self.publisher(str(self.options.get("command_topic", self.command_topic)), TWIST)
        self.matching = self.matching_of(self._commands)
        topic = str(self.options.get("odometry_topic", "odom"))
        self.model = DriveModel(self.settings.limits)
        self._read_quality()
        self.motions.models.append(self.model)
        self.at_dispose(lambda: self.motions.models.remove(self.model))
        self.odometer = Odometer(
            self.faults_of(topic),
            self.clock,
            self.on_odometry,
            str(self.options.get("odometry_frame", "")),
            self._placed(),
        )
        self.subscription(topic, ODOMETRY, self.odometer.take, SENSOR_DATA)
        if "frame" not in self.options:
            drift = Drift(self.ros, self.odometer, lambda: bool(self._motions), self.log)
            localised = self.robot_topic("amcl_pose")
            self.kept(self.ros.subscription(localised, LOCALISED, drift.take, SENSOR_DATA))
        self._drove = False
        self.at_dispose(self.ros.add_exit_hook(self._stand))
        self.at_dispose(guarded_by(self.ros).on_standstill(self._stand))
        self.at_dispose(self._halt)

    def _placed(self) -> Callable[[Odometry], Odometry | None] | None:
        """Return the conversion of odometry to the frame of the option; None without it."""
        if "frame" not in self.options:
            return None
        name = frame_name(str(self.options["frame"]), self.frame_prefix)
        try:
            return DrivingFrame(self.ros, name).placed
        except CapabilityMissing as error:
            self.fail(f"frame({name}): {error}", "ros_error", name)

    def on_odometry(self, odometry: Odometry) -> None:
        """Handle every odometry message."""
        late = self.odometer.late
        self.model.observed(odometry.pose, odometry.velocity, self.clock.elapsed, late)
        self.newest_pose.take(pose_values(odometry))

    def _option(self, name: str, default: float) -> float:
        value = self.options.get(name, default)
        assert isinstance(value, float)
        return value

    def _limits(self) -> Limits:
        return Limits(
            self._option("max_speed", TURTLEBOT.speed),
            math.radians(self._option("max_turn_speed", math.degrees(TURTLEBOT.turn_speed))),
            self._option("acceleration", TURTLEBOT.acceleration),
            math.radians(self._option("turn_acceleration", math.degrees(TURTLEBOT.turn_acceleration))),
        )

    def _settings(self) -> MotionSettings:
        can = self._limits()
        cruise = can.clip(
            Velocity(self._option("speed", 1.0), math.radians(self._option("turn_speed", math.degrees(1.0))))
        )
        timeout = self._option("timeout", math.inf)
        return MotionSettings(
            Limits(cruise.linear, cruise.angular, can.acceleration, can.turn_acceleration),
            self._option("odometry_timeout", 5.0),
            None if timeout == math.inf else timeout,
        )

    # The interface that a motion uses.

    def interrupted(self, why: Structure | Atom) -> None:
        """Signal `motion_interrupted`."""
        self.signal("motion_interrupted", why)

    def command(self, velocity: Velocity) -> None:
        """Publish one velocity command."""
        self.motions.commanded(velocity, self.clock.elapsed)
        if velocity != STANDSTILL:
            self._drove = True
        twist = self._commands.message()
        twist.linear.x, twist.angular.z = velocity.linear, velocity.angular
        self._commands.publish(twist)

    def show(self, motion: Motion, state: str | None) -> None:
        """Show in ``moving`` the state of *motion*; None: it has ended."""
        if state is None:
            self._motions.pop(motion, None)
            self._show_quality()
        else:
            self._motions[motion] = state
        states = self._motions.values()
        shown = next((each for each in STATES if each in states), "stopped")
        name = self.robot_property("moving")
        if shown != self.value(name):
            self.update_property(name, Atom(shown))

    def _show_quality(self) -> None:
        """Show what was measured, and keep it."""
        quality = self.model.quality
        if quality is None:
            return
        name = self.robot_property("drive_quality")
        values = (round(quality.delay, 2), round(quality.acceleration, 2), round(quality.least, 3))
        if values == self._shown:
            return
        if self._shown is None:
            self.define_property(name, *values)
        else:
            self.update_property(name, *values)
        self._shown = values
        if "quality_file" in self.options:
            try:
                write_quality(Path(str(self.options["quality_file"])), quality)
            except OSError as error:
                self.log(f"warning: what was measured of the robot cannot be kept: {error}")

    def _read_quality(self) -> None:
        """Begin with what an earlier run has measured."""
        if "quality_file" not in self.options:
            return
        try:
            quality = read_quality(Path(str(self.options["quality_file"])))
        except (OSError, ValueError) as error:
            self.log(f"warning: {self.options['quality_file']}: {error}; the robot is measured anew")
            return
        if quality is not None:
            self.model.expect(quality)

    def _halt(self) -> None:
        for motion in list(self._motions):
            motion.halt()

    def _stand(self) -> None:
        """Stop when the process ends. This may run in a thread, so it only publishes.

        A robot that was ever driven is sent zero velocity even if its last motion has ended: whether that motion's
        own zero was still sent is unknown here.
        """
        if self._drove:
            self.command(STANDSTILL)

    async def perform(self, maneuver: Maneuver) -> None:
        """Drive *maneuver* to its end; for operations marked as pausable.

        Raises:
            OperationFailed: ``aborted(Covered)``, ``blocked(Covered)``, ``does_not_move(Cause)``, ``late(Delay)``,
                ``interrupted(Covered)``, ``no_odometry(Seconds)``, ``no_transform(Seconds)`` or ``timeout(Seconds)``.
        """
        motion = Motion(self, maneuver)
        try:
            await motion.run()
        except MotionFailed as failed:
            self.commit()  # the robot has stopped, even though the operation failed
            self.fail(str(failed), failed.functor, failed.argument)
        except Exception:
            self.commit()
            raise


def _speed(argument: object) -> object:
    """Convert a plain number to the option that it stands for."""
    if isinstance(argument, int | float) and not isinstance(argument, bool):
        return Structure("speed", (argument,))
    return argument


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

    @operation(name="abortMoving")
    def abort_moving(self) -> None:
        """Stop the robot immediately: the motion that drives it and those that wait fail as aborted.

        Suspended motions are not affected. Without a motion it has no effect.
        """
        self.motions.abort()

    @operation(name="getCurrentPose")
    async def get_current_pose(self, x: Out, y: Out, heading: Out) -> None:
        """Give the pose in odometry: metres, metres, degrees; fails with ``no_odometry(5)`` if none arrives within 5
        s."""
        for out, value in zip(
            (x, y, heading), await self.newest(self.newest_pose, self.odometer.lacking), strict=True
        ):
            out.set(value)

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
    """`ArtCmdVelMux` that also shows odometry, in ``odom_cmd_vel_mux(X, Y, Z)``."""

    command_topic = ArtCmdVelMux.command_topic
    odometry_property = "odom_cmd_vel_mux"
