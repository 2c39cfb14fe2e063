"""The inertial measurement unit (IMU) at a robot's centre."""

from jacaros.plane.trigonometry import sine_cosine
from jacaros.sim.robot.on_graph import RobotOnGraph

GRAVITY = 9.80665
"""Acceleration measured upwards at rest, in m/s²."""
_LONGEST_STEP = 0.2
"""Longest gap between two messages, in seconds, over which an acceleration is computed."""


class ImuSensor:
    """``/imu``: heading, turn rate and acceleration, 20 Hz with subscribers.

    The heading is the true one, as of an ideal compass. The acceleration includes gravity, and is the mean since the last
    message.
    """

    def __init__(self, at: RobotOnGraph) -> None:
        self._at = at
        self._publisher = at.publisher("/imu", "sensor_msgs/msg/Imu")
        self._speed = 0.0
        self._time = -_LONGEST_STEP

    def publish(self, ticks: int) -> None:
        """Publish, if there are subscribers."""
        del ticks
        if not self._publisher.subscription_count:
            return
        robot = self._at.robot
        message = self._publisher.message()
        self._at.fill_header(message.header, "base_link")
        message.orientation.z, message.orientation.w = sine_cosine(0.5 * robot.yaw)
        message.angular_velocity.z = robot.turn_rate
        acceleration = message.linear_acceleration
        acceleration.x, acceleration.y = self._gained(), robot.speed * robot.turn_rate
        acceleration.z = GRAVITY
        self._publisher.publish(message)

    def _gained(self) -> float:
        """Return the forward acceleration since the last message, in m/s²."""
        now, speed = self._at.time.world.time, self._at.robot.speed
        passed, gained = now - self._time, speed - self._speed
        self._time, self._speed = now, speed
        return gained / passed if 0.0 < passed <= _LONGEST_STEP else 0.0
