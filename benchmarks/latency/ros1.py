"""Bare rospy: the pings (`ros1.py ping [--busy]`), and the echo to compare with (`ros1.py echo [--busy]`)."""

import os
import sys
import threading
import time

import rospy
from computing import compute
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from pings import PERIOD, measurement


def echo(busy: bool) -> None:
    """Answer on /bare/cmd_vel, beside a computing thread if *busy*."""
    rospy.init_node("bare_echo")
    publisher = rospy.Publisher("/bare/cmd_vel", Twist, queue_size=10)

    def reply(message: Odometry) -> None:
        command = Twist()
        command.linear.x = message.pose.pose.position.x
        publisher.publish(command)

    rospy.Subscriber("/bare/odom", Odometry, reply, queue_size=10)
    if busy:
        compute()
    rospy.spin()


def ping(busy: bool) -> None:
    """Measure both ways, unless the benchmark that started this ends before."""
    parent = os.getppid()
    rospy.init_node("pinger")
    publishers = {
        "agent": rospy.Publisher("/odom", Odometry, queue_size=10),
        "bare": rospy.Publisher("/bare/odom", Odometry, queue_size=10),
    }

    def send(way: str, number: float) -> None:
        message = Odometry()
        message.pose.pose.position.x = number
        publishers[way].publish(message)

    pings = measurement(time.perf_counter, send, busy)
    lock = threading.Lock()

    def returned(message: Twist, way: str) -> None:
        with lock:
            pings.returned(way, message.linear.x)

    replies = [
        rospy.Subscriber("/cmd_vel", Twist, returned, "agent", queue_size=10),
        rospy.Subscriber("/bare/cmd_vel", Twist, returned, "bare", queue_size=10),
    ]
    while not all(p.get_num_connections() for p in (*publishers.values(), *replies)):
        pause(0.1, parent)
    while not pings.over:
        with lock:
            pings.next()
        pause(PERIOD, parent)
    print(pings.report("ros1"))


def pause(seconds: float, parent: int) -> None:
    """Wait, but end when a signal has ended the node (rospy leaves the program running), or *parent* has died."""
    time.sleep(seconds)
    if rospy.is_shutdown() or os.getppid() != parent:
        sys.exit("interrupted")


if __name__ == "__main__":
    {"echo": echo, "ping": ping}[sys.argv[1]]("--busy" in sys.argv)
