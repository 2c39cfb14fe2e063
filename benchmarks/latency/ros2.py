"""Bare rclpy: the pings (`ros2.py ping [--busy]`), and the echo to compare with (`ros2.py echo [--busy]`)."""

import sys
import time

import rclpy
from computing import compute
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from pings import PERIOD, measurement
from rclpy.executors import ExternalShutdownException, SingleThreadedExecutor
from rclpy.qos import qos_profile_sensor_data


def echo(busy: bool) -> None:
    """Answer on /bare/cmd_vel, beside a computing thread if *busy*."""
    rclpy.init()
    node = rclpy.create_node("bare_echo")
    publisher = node.create_publisher(Twist, "/bare/cmd_vel", 10)

    def reply(message: Odometry) -> None:
        command = Twist()
        command.linear.x = message.pose.pose.position.x
        publisher.publish(command)

    node.create_subscription(Odometry, "/bare/odom", reply, qos_profile_sensor_data)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    if busy:
        compute()
    try:
        executor.spin()
    except (ExternalShutdownException, KeyboardInterrupt):
        return


def ping(busy: bool) -> None:
    """Measure both ways."""
    rclpy.init()
    node = rclpy.create_node("pinger")
    publishers = {
        "agent": node.create_publisher(Odometry, "/odom", 10),
        "bare": node.create_publisher(Odometry, "/bare/odom", 10),
    }

    def send(way: str, number: float) -> None:
        message = Odometry()
        message.pose.pose.position.x = number
        publishers[way].publish(message)

    pings = measurement(time.perf_counter, send, busy)
    node.create_subscription(Twist, "/cmd_vel", lambda m: pings.returned("agent", m.linear.x), 10)
    node.create_subscription(Twist, "/bare/cmd_vel", lambda m: pings.returned("bare", m.linear.x), 10)
    executor = SingleThreadedExecutor()
    executor.add_node(node)
    while not all(publisher.get_subscription_count() for publisher in publishers.values()):
        executor.spin_once(timeout_sec=0.1)
    node.create_timer(PERIOD, pings.next)
    while not pings.over:
        executor.spin_once(timeout_sec=1.0)
    print(pings.report("ros2"))


if __name__ == "__main__":
    {"echo": echo, "ping": ping}[sys.argv[1]]("--busy" in sys.argv)
