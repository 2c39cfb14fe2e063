"""Out and back: drive ahead for a while, turn around, come back by the same time, turn around again."""

import math

import rclpy
from geometry_msgs.msg import Twist
from rclpy.node import Node
from rclpy.time import Time
from tf2_ros import Buffer, TransformListener

PERIOD = 0.1  # seconds between two commands
LEG = 26  # commands


class OutAndBack(Node):
    """Drives ahead by time, and turns by the robot's heading on the map."""

    def __init__(self):
        super().__init__("out_and_back")
        self.commands = self.create_publisher(Twist, "cmd_vel", 10)
        self.tf_buffer = Buffer()
        self.tf_listener = TransformListener(self.tf_buffer, self)
        self.speed = self.declare_parameter("speed", 0.65).value  # metres per second
        self.turn_rate = self.declare_parameter("turn_rate", 1.0).value  # radians per second, at most
        self.turns_within = math.radians(self.declare_parameter("turns_within", 0.3).value)  # degrees
        self.velocities = self.out_and_back()
        self.create_timer(PERIOD, self.step)

    def step(self):
        twist = Twist()
        twist.linear.x, twist.angular.z = next(self.velocities)
        self.commands.publish(twist)

    def out_and_back(self):
        """Yield one velocity after the other, in m/s and rad/s."""
        while not (self.commands.get_subscription_count() and self.is_localised()):
            yield 0.0, 0.0
        start = self.heading()
        for leg, heading in (("out", start + math.pi), ("back", start)):
            self.get_logger().info(f"driving {leg}")
            yield from [(self.speed, 0.0)] * LEG
            yield from [(0.0, 0.0)] * 10  # until it stands
            while abs(error := math.remainder(heading - self.heading(), math.tau)) > self.turns_within:
                yield 0.0, max(-self.turn_rate, min(self.turn_rate, 2.0 * error))
            yield from [(0.0, 0.0)] * 5
        raise SystemExit

    def is_localised(self):
        return self.tf_buffer.can_transform("map", "base_link", Time())

    def heading(self):
        rotation = self.tf_buffer.lookup_transform("map", "base_link", Time()).transform.rotation
        return 2.0 * math.atan2(rotation.z, rotation.w)


def main():
    rclpy.init()
    rclpy.spin(OutAndBack())


if __name__ == "__main__":
    main()
