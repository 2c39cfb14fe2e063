"""A square: four sides of one metre, back to where and how the robot stood at the beginning."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformListener

PERIOD = 0.1  # seconds between two commands
SIDE = 1.0  # metres
SLOW = 0.05
NEAR = 0.02  # metres


class Square(Node):
    """Drives and turns by the robot's pose on the map: odometry drifts, as wheels slip."""

    def __init__(self):
        super().__init__("square")
        self.commands = self.create_publisher(Twist, "cmd_vel", 10)
        self.tf_buffer = Buffer()
        self.tf_listener = TransformListener(self.tf_buffer, self)
        self.speed = self.declare_parameter("speed", 0.65).value  # metres per second
        self.turn_rate = self.declare_parameter("turn_rate", 1.0).value  # radians per second, at most
        self.turns_within = math.radians(self.declare_parameter("turns_within", 0.3).value)  # degrees
        self.velocities = self.square()
        self.create_timer(PERIOD, self.step)

    def step(self):
        twist = Twist()
        speed, turn_rate = next(self.velocities)
        twist.linear.x, twist.angular.z = speed, max(-self.turn_rate, min(self.turn_rate, turn_rate))
        self.commands.publish(twist)

    def square(self):
        """Yield one velocity after the other, in m/s and rad/s."""
        while not (self.commands.get_subscription_count() and self.is_localised()):
            yield 0.0, 0.0
        x, y, heading = self.pose()
        for side in range(1, 5):
            yield from self.drive_side(x, y, heading)
            x, y = x + SIDE * math.cos(heading), y + SIDE * math.sin(heading)
            heading += math.pi / 2
            yield from self.turn_to(heading)
            at_x, at_y, _ = self.pose()
            self.get_logger().info(f"side {side} done, at {100 * at_x:.0f} cm, {100 * at_y:.0f} cm")
        raise SystemExit

    def drive_side(self, corner_x, corner_y, heading):
        """Follow the line of one side, which begins at a corner."""
        while True:
            x, y, yaw = self.pose()
            dx, dy = x - corner_x, y - corner_y
            left = SIDE - dx * math.cos(heading) - dy * math.sin(heading)
            aside = dy * math.cos(heading) - dx * math.sin(heading)
            if left < NEAR:
                break
            yield max(SLOW, min(self.speed, left)), 2.0 * (math.remainder(heading - yaw, math.tau) - aside)
        yield from [(0.0, 0.0)] * 5  # until it stands

    def turn_to(self, heading):
        while abs(error := math.remainder(heading - self.pose()[2], math.tau)) > self.turns_within:
            yield 0.0, 2.0 * error
        yield from [(0.0, 0.0)] * 5

    def is_localised(self):
        return self.tf_buffer.can_transform("map", "base_link", Time())

    def pose(self):
        transform = self.tf_buffer.lookup_transform("map", "base_link", Time()).transform
        yaw = 2.0 * math.atan2(transform.rotation.z, transform.rotation.w)
        return transform.translation.x, transform.translation.y, yaw


def main():
    rclpy.init()
    rclpy.spin(Square())


if __name__ == "__main__":
    main()
