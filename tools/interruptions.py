"""Interrupt agents that drive a robot at random moments, and check that the last velocity on the wire is zero.

    python tools/interruptions.py KIND --count N [--seed S]

KIND is memory, ros1 (with a running master), ros2 or rosbridge (with a running server; ROS_DISTRO or ROS_MASTER_URI select
the graph to listen to). Each run is a process that commands velocities as fast as it can, and receives one or two of
SIGINT, SIGTERM and SIGHUP: while it drives, or at any time from its start. A process without JaCaROS, written with rclpy
or rospy, receives all velocities. On the in-process graph no other process can listen; a second node writes the messages
that it receives to a pipe.
"""

import argparse
import importlib
import os
import random
import select
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path
from typing import Any

PROGRAM = '!g. +!g <- makeArtifact("wheels", "ArtCmdVel", [], W); focus(W); move(1000000).'
LISTENERS = {
    "ros2": """
import os, rclpy
from geometry_msgs.msg import Twist
from rclpy.qos import QoSProfile
rclpy.init()
node = rclpy.create_node("listener")
hear = lambda message: os.write(1, f"{message.linear.x}\\n".encode())
node.create_subscription(Twist, "/cmd_vel", hear, QoSProfile(depth=5000))
os.write(1, b"ready\\n")
rclpy.spin(node)
""",
    "ros1": """
import os, rospy
from geometry_msgs.msg import Twist
rospy.init_node("listener", disable_signals=True)
rospy.Subscriber("/cmd_vel", Twist, lambda message: os.write(1, f"{message.linear.x}\\n".encode()))
os.write(1, b"ready\\n")
rospy.spin()
""",
}
"""Programs that write each velocity as a line."""
MODULES = (
    "jacaros.mas.launch",
    "jacaros.mas.environment",
    "jacaros.artifacts.robots.velocity",
    "jacaros.sim.node",
)
QUIET = 0.3
"""Seconds without a message after which no message can still be on its way."""
START = 60.0
"""Time limit in seconds for the first command of a run, even on a busy machine."""
END = 30.0
"""Time limit in seconds for the end of an interrupted run."""


class Velocities:
    """The velocities that a listener writes to a pipe."""

    def __init__(self, pipe: int) -> None:
        self._pipe = pipe
        self._rest = b""
        self.heard: list[float] = []

    def read(self, seconds: float) -> bool:
        """Read for *seconds*; return False if nothing arrives or the pipe is closed."""
        if not select.select([self._pipe], [], [], seconds)[0]:
            return False
        data = os.read(self._pipe, 65536)
        *lines, self._rest = (self._rest + data).split(b"\n")
        self.heard += [float(line) for line in lines if line != b"ready"]
        return bool(data)


def become_agents(kind: str, program: Path, pipe: int) -> int:
    """Run the agents, which drive until interrupted; return the exit code."""
    from jacaros.artifacts.robots.maneuver import Timed
    from jacaros.mas.console import StandardConsole
    from jacaros.mas.launch import launch
    from jacaros.mas.options import RunOptions
    from jacaros.mas.system import System

    Timed.period = 1e-5  # as fast as the loop permits

    def listen(system: System) -> None:
        def hear(sample: Any) -> None:
            os.write(pipe, f"{sample.message.linear.x}\n".encode())

        if kind == "memory":
            observer = system.ros.companion("observer")
            observer.subscription("/cmd_vel", "geometry_msgs/msg/Twist", hear)

    return launch(program, RunOptions(ros=kind), StandardConsole("error"), listen)


def interrupt(kind: str, program: Path, listener: int | None, chance: random.Random) -> tuple[str, str]:
    """Run the agents once; return how the run ended, and a complaint or "".

    Args:
        listener: output of the independent listener; None to use the observer of the run.
    """
    pipe, writing = os.pipe()
    process = os.fork()
    if process == 0:
        os.close(pipe)
        raise Child(kind, program, writing)
    os.close(writing)
    velocities = Velocities(pipe if listener is None else listener)
    anywhere = chance.random() < 0.2
    began = time.monotonic()
    moment = chance.uniform(0.0, 2.0) if anywhere else START
    while time.monotonic() - began < moment and not (any(velocities.heard) and not anywhere):
        velocities.read(0.01)
    if not anywhere:
        time.sleep(chance.uniform(0.0, 0.05))
    numbers = [chance.choice((signal.SIGINT, signal.SIGTERM, signal.SIGHUP))]
    if chance.random() < 0.2:
        numbers.append(chance.choice((signal.SIGINT, signal.SIGTERM, signal.SIGHUP)))
    for number in numbers:
        os.kill(process, number)
        velocities.read(chance.uniform(0.0, 0.02))
    deadline = time.monotonic() + END
    while os.waitpid(process, os.WNOHANG) == (0, 0):
        velocities.read(0.01)
        if time.monotonic() > deadline:
            os.kill(process, signal.SIGKILL)
            os.waitpid(process, 0)
            return "hung", f"did not end within {END:g} s of {numbers}"
    while velocities.read(QUIET):
        pass
    os.close(pipe)
    heard = velocities.heard
    moved = any(heard)
    if moved and heard[-1] != 0.0:
        return "still driving", f"last velocities {heard[-5:]} after {numbers}"
    if not moved and not anywhere:
        return "never drove", "no velocity was heard before the signal"
    return ("stopped" if moved else "ended before it drove"), ""


class Child(Exception):
    """Raised in the process that becomes the agents, to leave all of the parent's code."""


def main() -> int:
    """Interrupt runs, and print how they ended."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kind", choices=("memory", "ros1", "ros2", "rosbridge"))
    parser.add_argument("--count", type=int, default=1000, help="number of runs (default: 1000)")
    parser.add_argument("--seed", type=int, default=0, help="seed of the moments and signals (default: 0)")
    arguments = parser.parse_args()
    kind, chance = arguments.kind, random.Random(arguments.seed)
    for module in (*MODULES, f"jacaros.ros.drivers.{kind}.backend"):
        importlib.import_module(module)  # once for all runs, which fork this process
    listener = None
    if kind != "memory":
        graph = kind if kind != "rosbridge" else "ros1" if os.environ.get("ROS_MASTER_URI") else "ros2"
        listener = subprocess.Popen([sys.executable, "-c", LISTENERS[graph]], stdout=subprocess.PIPE)
        assert listener.stdout is not None
        assert os.read(listener.stdout.fileno(), 6) == b"ready\n"
    ends: Counter[str] = Counter()
    failures = 0
    began = time.monotonic()
    program = Path(tempfile.mkdtemp()) / "drive.asl"
    program.write_text(PROGRAM, encoding="utf-8")
    heard = None if listener is None or listener.stdout is None else listener.stdout.fileno()
    this = os.getpid()
    try:
        for number in range(arguments.count):
            end, complaint = interrupt(kind, program, heard, chance)
            ends[end] += 1
            if complaint:
                failures += 1
                print(f"run {number}: {end}: {complaint}", flush=True)
    finally:
        if os.getpid() == this:  # not in a fork that runs the agents
            shutil.rmtree(program.parent)
            if listener is not None:
                listener.kill()
                listener.wait()
    told = ", ".join(f"{count} {end}" for end, count in ends.most_common())
    print(f"{kind}: {arguments.count} interruptions in {time.monotonic() - began:.0f} s: {told}", flush=True)
    return 1 if failures else 0


if __name__ == "__main__":
    try:
        code = main()
    except Child as child:
        code = become_agents(*child.args)
    sys.exit(code)
