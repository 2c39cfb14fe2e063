"""Artifacts that drive wheels: options, topics and the state that all motion operations share."""

import math
from collections.abc import Callable
from typing import ClassVar

from jacaros.artifacts.ros.control import STANDSTILL, Limits, Velocity
from jacaros.artifacts.ros.lane import Lane, lane_of
from jacaros.artifacts.ros.maneuver import Maneuver
from jacaros.artifacts.ros.matching import MATCH_OPTIONS, Matching
from jacaros.artifacts.ros.motion import Motion, MotionFailed, MotionSettings
from jacaros.artifacts.ros.odometer import ODOMETRY, Odometer, Odometry
from jacaros.artifacts.ros.odometry import pose_values
from jacaros.artifacts.ros.options import positive, text
from jacaros.artifacts.ros.reading import Reading, ReadingPolicy
from jacaros.artifacts.ros.ros_artifact import RosArtifact
from jacaros.env.values import Atom, Structure
from jacaros.ros.guarded import guarded_by
from jacaros.ros.qos import SENSOR_DATA

TWIST = "geometry_msgs/msg/Twist"

TURTLEBOT = Limits()

STATES = ("driving", "turning", "waiting", "paused")
"""What a motion does, the most important first: the property ``moving`` shows one of them."""


class WheeledArtifact(RosArtifact):
    """An artifact whose operations drive a robot by `perform`.

    Options:
        speed(V), turn_speed(D): cruise speeds, metres and degrees per second (1 m/s and 57 degrees/s as in
            the thesis, cut to what the robot can do).
        max_speed(V), max_turn_speed(D), acceleration(A), turn_acceleration(D): what the robot can do; a
            TurtleBot by default.
        timeout(S): longest time of driving for one motion; four times the time needed plus half a minute by
            default.
        odometry_timeout(S): how long a motion stands and waits for odometry before it fails (5 s).
        command_topic(T), odometry_topic(T): other topics.
        match_timeout(S): how long a motion stands and waits until the robot's base is connected to the command
            topic (3 s); without that its first commands would be lost.
        unmatched(W): what happens when no base is connected by then: ``warn`` (the default; the motion begins) or
            ``fail``, with ``unmatched(Topic)``.
        odometry_frame(F): the only frame in which odometry is believed; that of the first message by default.

    Properties:
        moving(State): ``stopped``, ``driving``, ``turning``, ``waiting`` or ``paused``.

    Signals:
        motion_interrupted(Why): the robot was not watched for a while and has been stopped.  Why is ``delayed(Seconds)``
            (the process was frozen or stuck), ``no_odometry(Seconds)``, ``clock_jumped(Seconds)`` or ``guard_tripped``.

    Attributes:
        lane: who drives the robot; shared with all artifacts of the same robot.
        matching: lets motions wait until the robot's base receives commands.
        odometer: the newest odometry.
        settings: speeds and time-outs.
        newest_pose: x, y and heading in degrees, for operations that give them.
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
        **MATCH_OPTIONS,
    }
    robot_in_properties = True
    command_topic: ClassVar[str] = "cmd_vel"

    lane: Lane
    matching: Matching
    odometer: Odometer
    settings: MotionSettings
    newest_pose: Reading

    def open(self) -> None:
        """Open the command topic and odometry; nothing is published before the first motion."""
        self.settings = self._settings()
        self._motions: dict[Motion, str] = {}
        self.define_property(self.robot_property("moving"), Atom("stopped"))
        self.lane = lane_of(self.ros, self.robot_prefix)
        self.newest_pose = Reading(ReadingPolicy(on_demand=True), self.clock)
        self._commands = self.publisher(str(self.options.get("command_topic", self.command_topic)), TWIST)
        self.matching = self.matching_of(self._commands)
        topic = str(self.options.get("odometry_topic", "odom"))
        self.odometer = Odometer(
            self.faults_of(topic), self.clock, self.on_odometry, str(self.options.get("odometry_frame", ""))
        )
        self.subscription(topic, ODOMETRY, self.odometer.take, SENSOR_DATA)
        self._drove = False
        self.at_dispose(self.ros.add_exit_hook(self._stand))
        self.at_dispose(self._halt)

    def on_odometry(self, odometry: Odometry) -> None:
        """Take every odometry message."""
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

    # What a motion needs of its artifact.

    def on_interruption(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call *callback* when a guard has stopped the robot; the result ends that."""
        return guarded_by(self.ros).on_interruption(callback)

    def interrupted(self, why: Structure | Atom) -> None:
        """Signal `motion_interrupted`."""
        self.signal("motion_interrupted", why)

    def command(self, velocity: Velocity) -> None:
        """Publish one velocity command."""
        if velocity != STANDSTILL:
            self._drove = True
        twist = self._commands.message()
        twist.linear.x, twist.angular.z = velocity.linear, velocity.angular
        self._commands.publish(twist)

    def show(self, motion: Motion, state: str | None) -> None:
        """Show in ``moving`` what *motion* does; None: it is over."""
        if state is None:
            self._motions.pop(motion, None)
        else:
            self._motions[motion] = state
        states = self._motions.values()
        shown = next((each for each in STATES if each in states), "stopped")
        name = self.robot_property("moving")
        if shown != self.value(name):
            self.update_property(name, Atom(shown))

    def _halt(self) -> None:
        for motion in list(self._motions):
            motion.halt()

    def _stand(self) -> None:
        """Stop as the process ends; in a thread, perhaps, so it only publishes.

        A robot that was driven is sent zero even if its last motion has ended: whether that one's own zero was still
        admitted, nobody can say here.
        """
        if self._drove:
            self.command(STANDSTILL)

    async def perform(self, maneuver: Maneuver) -> None:
        """Drive *maneuver* to its end; for operations marked as pausable.

        Raises:
            OperationFailed: ``aborted(Covered)``, ``blocked(Covered)``, ``interrupted(Covered)``,
                ``no_odometry(Seconds)`` or ``timeout(Seconds)``.
        """
        motion = Motion(self, maneuver)
        try:
            await motion.run()
        except MotionFailed as failed:
            self.commit()  # that the robot stands is true although the operation failed
            self.fail(str(failed), failed.functor, failed.argument)
        except Exception:
            self.commit()
            raise
