"""A battery runs down from 100 to 0 percent, and the node reports its state.

A timer drains the battery, one percent a second. With the parameter source:=robot it is the robot's battery.
"""

import rclpy
from rclpy.node import Node
from rclpy.qos import qos_profile_sensor_data
from sensor_msgs.msg import BatteryState

MEDIUM, LOW = 50, 20  # percent from which on down the battery is medium or low


def diagnosis(percent):
    if percent <= LOW:
        return "Low Battery"
    return "Medium Battery" if percent <= MEDIUM else "Full Battery"


class FakeBattery(Node):
    """Reports each new state of the battery once."""

    def __init__(self):
        super().__init__("fake_battery")
        self.percent = 100
        self.state = None
        source = self.declare_parameter("source", "timer").value
        if source == "robot":
            self.create_subscription(BatteryState, "battery_state", self.on_battery, qos_profile_sensor_data)
        else:
            self.report()
            self.create_timer(1.0, self.drain)

    def drain(self):
        self.percent -= 1
        self.report()

    def on_battery(self, message):
        self.percent = int(100 * message.percentage + 0.001)
        self.report()

    def report(self):
        state = diagnosis(self.percent)
        if state != self.state:
            self.state = state
            self.get_logger().info(f"{self.percent} %: {state}")
        if self.percent == 0:
            self.get_logger().info("0 %: empty")
            raise SystemExit


def main():
    rclpy.init()
    rclpy.spin(FakeBattery())


if __name__ == "__main__":
    main()
