"""The two ways from an odometry message to a command: an agent, and a bare callback."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from graph import node

from jacaros.runtime.mas.system import System

ODOMETRY, TWIST = "nav_msgs/msg/Odometry", "geometry_msgs/msg/Twist"
LATENCY = Path(__file__).resolve().parent.parent / "latency"
PROGRAM = (LATENCY / "echo.asl").read_text(encoding="utf-8").replace('.print("listening")', "true")
ARTIFACTS = (LATENCY / "artifacts.py").read_text(encoding="utf-8")
WAYS = ("agent", "bare")


def connect(mas: System, returned: Callable[[str, float], None]) -> Callable[[str, float], None]:
    """Connect the bare echo to the measuring process; return a function that sends a numbered message in a given way."""
    echo, pinger = node(mas, "echo"), node(mas, "pinger")
    answers = echo.publisher("/bare/cmd_vel", TWIST)

    def reply(sample: Any) -> None:
        command = answers.message()
        command.linear.x = sample.message.pose.pose.position.x
        answers.publish(command)

    echo.subscription("/bare/odom", ODOMETRY, reply)
    publishers = {
        "agent": pinger.publisher("/odom", ODOMETRY),
        "bare": pinger.publisher("/bare/odom", ODOMETRY),
    }
    pinger.subscription("/cmd_vel", TWIST, lambda s: returned("agent", s.message.linear.x))
    pinger.subscription("/bare/cmd_vel", TWIST, lambda s: returned("bare", s.message.linear.x))

    def send(way: str, number: float) -> None:
        message = publishers[way].message()
        message.pose.pose.position.x = number
        publishers[way].publish(message)

    return send
