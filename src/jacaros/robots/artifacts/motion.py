"""The motions of a robot, from their request to their end: the loop around a maneuver, and what all wheels share.

Every end publishes zero velocity: success, failure, drop, suspension, loss of odometry, disposal of the artifact.
"""

import math
from dataclasses import dataclass
from functools import partial
from typing import ClassVar, NoReturn

from jacaros.artifacts.env.arbiter import WHEELS
from jacaros.artifacts.env.artifact import operation
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.artifacts.approach import PERIOD, NotMoving, Outlook, TimedCommand, Unsettled
from jacaros.robots.artifacts.drive_model import (
    STANDSTILL,
    DriveModel,
    Limits,
    Velocity,
)
from jacaros.robots.artifacts.driving import Aborted, Driving, motions_of
from jacaros.robots.artifacts.lookout import RADIUS, Lookout
from jacaros.robots.artifacts.maneuver import LEAST_PROGRESS, Maneuver, ProgressChecker, distance
from jacaros.robots.artifacts.odometry import (
    LOCALISED,
    Drift,
    Odometer,
    Odometry,
    PlaceOdometry,
    driving_frame,
)
from jacaros.robots.kit.connection import MATCH_OPTIONS
from jacaros.robots.kit.options import positive, text
from jacaros.robots.kit.reading import Reading
from jacaros.robots.kit.ros_artifact import RosArtifact
from jacaros.robots.plane.pose import Pose
from jacaros.robots.ros.errors import CapabilityMissing
from jacaros.robots.ros.names import frame_name
from jacaros.robots.ros.qos import SENSOR_DATA
from jacaros.robots.streams import ReadingPolicy

TWIST = "geometry_msgs/msg/Twist"

TURTLEBOT = Limits()

STATES = ("driving", "turning", "waiting", "paused")
"""States of a motion, by precedence: the property ``moving`` shows one of them."""

STALE = 0.5
"""Seconds after which the newest odometry is too old to drive by; the robot stops until more arrives."""

STUCK = 2.0
"""Seconds without progress after which a commanded motion is blocked."""

FRESH = 2
"""Odometry messages that must arrive after a gap before a motion continues: the first one may predate it."""

LEAP = 1.0
"""Metres that odometry may move during a gap. More means that it was reset, so its coordinates have changed their
meaning."""

LONGEST_BRAKING = 3.0
"""Seconds after which a braking robot counts as standing: its twist may only be noise."""


@dataclass(frozen=True, slots=True)
class MotionSettings:
    """How a robot is driven.

    Attributes:
        limits: cruise speeds and accelerations of closed loops.
        odometry_timeout: seconds without odometry until a motion fails.
        timeout: seconds of driving until a motion fails; None: four times the time needed plus 30 s.
    """

    limits: Limits
    odometry_timeout: float
    timeout: float | None


# One motion operation, and its loop around a maneuver.


class Motion:
    """Run one motion operation.

    Args:
        wheels: the artifact of the operation.
        maneuver: the task.

    Attributes:
        driving: its claim.
    """

    def __init__(self, wheels: "WheeledArtifact", maneuver: Maneuver) -> None:
        self._wheels, self._fail = wheels, wheels.fail
        self._maneuver = maneuver
        self.driving = Driving(
            wheels,
            wheels.motions,
            WHEELS,
            partial(wheels.command, STANDSTILL),
            lambda state: wheels.show(self, state),
        )
        self._begun = False
        self._due = 0.0
        self._active = 0.0
        self._blind_since: float | None = None
        self._frame = ""
        self._fresh = 0
        self._left_at: Pose | None = None
        self._leaps = 0
        self._held_up = False
        self._watched = False
        self._progress = ProgressChecker()
        self._sought = (0.0, 0.0)

    async def run(self) -> None:
        """Drive the maneuver to its end.

        Raises:
            OperationFailed: ``aborted``, ``no_odometry``, ``no_transform``, ``blocked``, ``does_not_move``, ``late``,
                ``interrupted`` or ``timeout``.
        """
        try:
            with self.driving:
                await self._drive()
        except Aborted:
            if self._begun:
                self._maneuver.rest(self._pose())
            self._fail("the motion was aborted", "aborted", self._maneuver.covered)
        except Unsettled:
            self._unsettled()
        except NotMoving:
            self._stuck()
        finally:
            self._wheels.show(self, None)

    async def _drive(self) -> None:
        ended = False
        while not ended:
            await self._get_ready()
            self._leaps = self._wheels.odometer.leaps
            if self._begun:
                self._maneuver.go_on(self._pose())
            else:
                self._maneuver.begin(self._pose())
            self._begun = True
            self._progress.reset()
            ended = await self._follow()

    async def _get_ready(self) -> None:
        """Claim the robot and wait until it stands: it may still roll from an earlier motion."""
        ready = False
        while not ready:
            await self.driving.ready()
            ready = await self._stand()

    async def _stand(self) -> bool:
        """Bring a robot that receives commands to a stop. Return False if the agent suspends the motion meanwhile."""
        braking = 0.0
        blind = not self._maneuver.needs_odometry
        pauses = self._wheels.matching.pauses(always=blind)
        self._due = self._wheels.clock.elapsed
        while not self.driving.paused:
            self._heed_gap()
            seen = self._looks(braking) and (blind or self._has_odometry())
            pause = next(pauses, None)
            if pause is None and seen and self._rests(braking):
                return True
            await self._command(TimedCommand(STANDSTILL, PERIOD if pause is None else pause), pause is None)
            braking += PERIOD if pause is None else pause
        return False

    def _looks(self, waited: float) -> bool:
        """Return whether the laser shows the way, if the motion stops for obstacles. Fail if no scan comes."""
        lookout, limit = self._wheels.lookout, self._wheels.settings.odometry_timeout
        if lookout is None or lookout.sees:
            return True
        if waited >= limit:
            self._fail(f"no laser scan for {limit:g} s", "no_scan", limit)
        return False

    def _rests(self, braking: float) -> bool:
        """Return whether the robot stands, or has braked for so long that its twist must be noise."""
        odometer = self._wheels.odometer
        return (
            odometer.newest is None
            or self._wheels.model.has_come_to_rest()
            or braking >= LONGEST_BRAKING + self._wheels.model.delay
        )

    async def _follow(self) -> bool:
        """Follow the maneuver. Return True at its end, False if the agent suspended it and the robot stands."""
        maneuver = self._maneuver
        blind = not maneuver.needs_odometry
        self._due = self._wheels.clock.elapsed
        while True:
            if self.driving.paused:
                if await self._brake():
                    maneuver.rest(self._pose())
                    return False
                continue
            self._heed_gap()
            if not blind and not self._has_odometry():
                await self._command(TimedCommand(STANDSTILL))
                continue
            self._heed_leap()
            step = maneuver.command(self._outlook())
            self._check(step)
            if step is None:
                return True
            await self._command(self._with_room(step))

    def _with_room(self, step: TimedCommand) -> TimedCommand:
        """Slow down before what the laser sees; an open-loop motion fails if it would lose more than half its speed."""
        lookout = self._wheels.lookout
        if lookout is None:
            return step
        velocity = lookout.limit(step.velocity)
        self._held_up = velocity is not step.velocity
        too_slow = 2.0 * abs(velocity.linear) < abs(step.velocity.linear)
        if too_slow and not self._maneuver.needs_odometry:
            self._stuck()
        return TimedCommand(velocity) if self._held_up else step

    def _outlook(self) -> Outlook:
        wheels, now = self._wheels, self._wheels.clock.elapsed
        ahead, velocity = wheels.model.ahead(now)
        return Outlook(wheels.model, wheels.settings.limits, now, wheels.model.pose, ahead, velocity)

    async def _command(self, step: TimedCommand, periodic: bool = True) -> None:
        self._wheels.show(self, self._maneuver.activity)
        self._wheels.command(step.velocity)
        await self.driving.pass_time(self._until_due(step.seconds) if periodic else step.seconds)
        self._active += step.seconds

    def _until_due(self, period: float) -> float:
        """Return the seconds until the next command, counted from the time at which this one was due.

        A late turn of the loop therefore does not extend an open-loop motion. A closed loop does not catch up.
        """
        now: float = self._wheels.clock.elapsed
        self._due += period
        if self._maneuver.needs_odometry:
            self._due = max(self._due, now)
        return max(0.0, self._due - now)

    async def _brake(self) -> bool:
        """Stop before another motion may drive: braking is part of the motion, and counts.

        Return False if the agent resumes the motion before the robot stands.
        """
        self._wheels.show(self, "paused")
        braking = 0.0
        while self.driving.paused:
            if self._rests(braking):
                return True
            self._wheels.command(STANDSTILL)
            await self.driving.pass_time(PERIOD)
            braking += PERIOD
        return False

    def _pose(self) -> Pose:
        return self._wheels.model.pose

    def _heed_gap(self) -> None:
        """After a gap, signal it, and continue only with new odometry; an open-loop motion fails.

        Raises:
            OperationFailed: ``interrupted``.
        """
        if self._sees():
            self._watched = True
        elif self._watched and not self._maneuver.needs_odometry:
            self.driving.interrupt(self._silence())
        why, self.driving.gap = self.driving.gap, None
        if why is None:
            return
        self._progress.reset()
        self._wheels.signal("motion_interrupted", why)
        self._left_at = self._pose() if self._begun else None
        self._fresh = self._wheels.odometer.count + FRESH
        if self._begun and not self._maneuver.needs_odometry:
            text = f"the open-loop motion was interrupted ({why})"
            self._fail(text, "interrupted", self._maneuver.covered)

    def _silence(self) -> Structure:
        age = self._wheels.odometer.age(self._wheels.clock.now())
        return Structure("no_odometry", (round(age or 0.0, 3),))

    def _sees(self) -> bool:
        age = self._wheels.odometer.age(self._wheels.clock.now())
        # If the clock was set back, the newest odometry is from the future and equally out of date.
        return age is not None and abs(age) <= STALE

    def _has_odometry(self) -> bool:
        """Return whether there is odometry to drive by. Fail if it was missing for too long."""
        odometer = self._wheels.odometer
        if odometer.trusted and odometer.count >= self._fresh and self._sees():
            self._stay_in(odometer.header.frame)
            self._check_leap()
            self._blind_since = None
            return True
        if self._blind_since is None:
            self._blind_since = self._active
            if self._begun and odometer.trusted and odometer.count >= self._fresh:
                self.driving.gap = self._silence()
        limit = self._wheels.settings.odometry_timeout
        if self._active - self._blind_since >= limit:
            self._fail(f"{odometer.lack()} for {limit:g} s", odometer.lacking, limit)
        return False

    def _check_leap(self) -> None:
        """Fail if odometry was reset during a gap: the robot was restarted, so the goal's position is unknown."""
        left_at, self._left_at = self._left_at, None
        if left_at is not None and distance(left_at, self._pose()) > LEAP:
            self._fail("odometry was reset", "interrupted", self._maneuver.covered)

    def _heed_leap(self) -> None:
        """Fail if localisation has found the robot elsewhere: what a relative motion has covered is unknown."""
        if self._maneuver.relative and self._wheels.odometer.leaps != self._leaps:
            self._fail("localisation has found the robot elsewhere", "interrupted", self._maneuver.covered)

    def _stay_in(self, frame: str) -> None:
        """Fail if poses arrive in another frame than at the beginning: the goal is a point in the first one."""
        self._frame = self._frame or frame
        if frame != self._frame:
            since = self._active if self._blind_since is None else self._blind_since
            text = f"odometry changed its frame from {self._frame} to {frame}"
            self._fail(text, "no_odometry", round(self._active - since, 1))

    def _check(self, step: TimedCommand | None) -> None:
        """Fail if the motion takes too long or makes no progress."""
        settings, maneuver = self._wheels.settings, self._maneuver
        allowed = settings.timeout or 30.0 + 4.0 * maneuver.seconds(settings.limits)
        if self._active >= allowed:
            self._fail(f"the motion took longer than {allowed:g} s", "timeout", allowed)
        model = self._wheels.model
        sought, self._sought = self._sought, (model.linear.lower, model.angular.lower)
        if step is None or step.velocity == STANDSTILL or self._sought != sought:
            self._progress.reset()
        elif self._progress.is_stuck(maneuver.progress(self._pose()), self._active, self._patience()):
            self._stuck()

    def _patience(self) -> float:
        """Return the seconds without progress that are too long; slow cruising and late robots need more."""
        limits = self._wheels.settings.limits
        return (
            max(STUCK, 4.0 * LEAST_PROGRESS / min(limits.speed, limits.turn_speed)) + self._wheels.model.delay
        )

    def _stuck(self) -> NoReturn:
        """Fail: the robot does not follow commands. It is blocked if it has followed them before."""
        model, driving = self._wheels.model, self._maneuver.activity == "driving"
        if self._held_up:
            self._fail("the laser sees something in the way", "blocked", self._maneuver.covered)
        if model.has_rolled(driving):
            self._fail(f"the robot is stuck ({model})", "blocked", self._maneuver.covered)
        if not self._wheels.matching.exists():
            self._fail("no base receives the commands", "does_not_move", Atom("unmatched"))
        self._fail(f"odometry shows no reaction to commands ({model})", "does_not_move", Atom("no_reaction"))

    def _unsettled(self) -> NoReturn:
        """Fail: the robot cannot be placed within the tolerance."""
        model = self._wheels.model
        text = f"the robot cannot be placed exactly enough ({model})"
        if model.is_late:
            self._fail(text, "late", round(model.delay, 3))
        self._fail(text, "does_not_move", Atom("dead_band"))


class WheeledArtifact(RosArtifact):
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
        stop_for(T): the topic of a laser, such as ``scan``: motions slow down before what it sees in the way, stand in
            front of it, and fail with ``blocked(Covered)`` if it stays, before they touch it; without scans they do not
            begin, and fail with ``no_scan(Seconds)``.
        radius(R): metres from that laser to the edge of the robot (0.18).
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
        lookout: what the laser sees in the way; None without the option ``stop_for``.
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
        "stop_for": text,
        "radius": positive,
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
        self._commands = self.publisher(self.option("command_topic", self.command_topic), TWIST)
        self.matching = self.matching_of(self._commands)
        self.model = DriveModel(self.settings.limits)
        self.motions.models.append(self.model)
        self.at_dispose(lambda: self.motions.models.remove(self.model))
        topic, frame = self.option("odometry_topic", "odom"), self.option("odometry_frame", "")
        self.odometer = Odometer(self, topic, self.on_odometry, frame, self._placed())
        self.lookout = self._lookout()
        if "frame" not in self.options:
            drift = Drift(self.ros, self.odometer, lambda: bool(self._motions), self.log)
            localised = self.robot_topic("amcl_pose")
            self.kept(self.ros.subscription(localised, LOCALISED, drift.take, SENSOR_DATA))
        self._drove = False
        self.motions.watch(self, self._stand, self._halt)

    def _placed(self) -> PlaceOdometry | None:
        """Return the conversion of odometry to the frame of the option; None without it."""
        if "frame" not in self.options:
            return None
        name = frame_name(str(self.options["frame"]), self.frame_prefix)
        try:
            return driving_frame(self.ros, name)
        except CapabilityMissing as error:
            self.fail(f"frame({name}): {error}", "ros_error", name)

    def _lookout(self) -> Lookout | None:
        if "stop_for" not in self.options:
            return None
        topic, radius = str(self.options["stop_for"]), self.option("radius", RADIUS)
        return Lookout(self, topic, radius, self.settings.limits)

    def on_odometry(self, odometry: Odometry) -> None:
        """Handle every odometry message."""
        late, pose = self.odometer.header.late, odometry.pose
        self.model.observed(pose, odometry.velocity, self.clock.elapsed, late)
        self.newest_pose.take((pose.x, pose.y, math.degrees(pose.yaw)))

    def _settings(self) -> MotionSettings:
        """Read speeds, which options give in degrees where they turn, and time-outs."""
        option, degrees = self.option, math.degrees
        can = Limits(
            option("max_speed", TURTLEBOT.speed),
            math.radians(option("max_turn_speed", degrees(TURTLEBOT.turn_speed))),
            option("acceleration", TURTLEBOT.acceleration),
            math.radians(option("turn_acceleration", degrees(TURTLEBOT.turn_acceleration))),
        )
        cruise = can.clip(Velocity(option("speed", 1.0), math.radians(option("turn_speed", degrees(1.0)))))
        return MotionSettings(
            Limits(cruise.linear, cruise.angular, can.acceleration, can.turn_acceleration),
            option("odometry_timeout", 5.0),
            option("timeout", None),
        )

    def command(self, velocity: Velocity) -> None:
        """Publish one velocity command."""
        now = self.clock.elapsed
        for model in self.motions.models:  # all artifacts that drive the robot see the effect in odometry
            model.commanded(velocity, now)
        if velocity != STANDSTILL:
            self._drove = True
        twist = self._commands.new()
        twist.linear.x, twist.angular.z = velocity.linear, velocity.angular
        self._commands.publish(twist)

    @operation(name="abortMoving")
    def abort_moving(self) -> None:
        """Stop the robot immediately: the motion that drives it and those that wait fail as aborted.

        Suspended motions are not affected. Without a motion it has no effect.
        """
        self.motions.abort()

    def show(self, motion: Motion, state: str | None) -> None:
        """Show in ``moving`` the state of *motion*; None: it has ended."""
        if state is None:
            self._motions.pop(motion, None)
            self._show_quality()
        else:
            self._motions[motion] = state
        states = self._motions.values()
        shown = next((each for each in STATES if each in states), "stopped")
        self.update_property(self.robot_property("moving"), Atom(shown), if_new=True)

    def _show_quality(self) -> None:
        """Show what was measured."""
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

    def _halt(self) -> None:
        for motion in list(self._motions):
            motion.driving.halt()

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
        try:
            await Motion(self, maneuver).run()
        except Exception:
            self.commit()  # the robot has stopped, even though the operation failed
            raise


def _speed(argument: object) -> object:
    """Convert a plain number to the option that it stands for."""
    if isinstance(argument, int | float) and not isinstance(argument, bool):
        return Structure("speed", (argument,))
    return argument
