"""Interrupt agents that drive a robot at random moments, and check that the last velocity on the wire is zero.

    python tools/interruptions.py KIND --count N [--program P,...] [--busy N] [--loss PERCENT] [--seed S] [--log FILE]

KIND is memory, ros1 (with a running master), ros2 or rosbridge (with a running server; ROS_DISTRO or ROS_MASTER_URI select
the graph to listen to). Each run is a process that drives, and receives one or two of SIGINT, SIGTERM and SIGHUP: while it
drives, or at any time from its start. A process without JaCaROS, written with rclpy or rospy, receives all velocities. On
the in-process graph no other process can listen; a second node writes the messages that it receives to a pipe.

Programs: `flood` commands velocities as fast as it can; `motion` drives by odometry; `rolling` and `pushing` are
operations of a mapping that publish repeatedly and once; `goal` (ros2 only) sends an action goal, whose execution counts as
a velocity and whose cancellation as zero.

`--busy N` adds N processes that use a whole core each. `--loss PERCENT` drops that share of all packets, in a network
namespace of its own: it needs root, `unshare`, `ip` and `nft`, and applies to ros2.
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

WHEELS = 'makeArtifact("wheels", "ArtCmdVel", [], W); focus(W)'
PROGRAMS = {
    "flood": f"!g. +!g <- {WHEELS}; move(1000000).",
    "motion": f"!g. +!g <- {WHEELS}; !go. +!go <- moveForward(5); moveForward(-5); !go.",
    "rolling": "!g. +!g <- roll(0.3, 100); !g.",
    "pushing": "!g. +!g <- push(0.3); .wait(10); !g.",
    "goal": "!g. +!g <- count(100000); !g.",
}
MAPPING = """
operations:
  roll:
    parameters: [speed, seconds]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {linear.x: $speed}
    rate: 20
    duration: $seconds
  push:
    parameters: [speed]
    publish: cmd_vel
    type: geometry_msgs/msg/Twist
    fields: {linear.x: $speed}
"""
GOALS = """
operations:
  count:
    parameters: [target]
    action: count
    type: jacaros_interfaces/action/Count
    goal: {target: $target, period: 0.1}
"""
LISTENERS = {
    "ros2": """
import os, threading, time, rclpy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
from rclpy.action import ActionServer, CancelResponse
from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import MultiThreadedExecutor
from rclpy.qos import QoSProfile
rclpy.init()
node = rclpy.create_node("listener")
speed = [0.0, 0.0]
def write(value):
    os.write(1, f"{time.time()} {value}\\n".encode())
def hear(twist):
    speed[0] = twist.linear.x
    write(abs(twist.linear.x) + abs(twist.angular.z))
def measure():
    speed[1] += speed[0] * 0.05
    odometry = Odometry()
    odometry.header.stamp = node.get_clock().now().to_msg()
    odometry.header.frame_id, odometry.child_frame_id = "odom", "base_link"
    odometry.pose.pose.position.x, odometry.pose.pose.orientation.w = speed[1], 1.0
    odometry.twist.twist.linear.x = speed[0]
    publisher.publish(odometry)
def execute(goal):
    write(1.0)
    while not goal.is_cancel_requested:
        time.sleep(0.005)
    goal.canceled()
    write(0.0)
    return Count.Result()
publisher = node.create_publisher(Odometry, "/odom", 10)
node.create_subscription(Twist, "/cmd_vel", hear, QoSProfile(depth=5000))
node.create_timer(0.05, measure)
try:
    from jacaros_interfaces.action import Count
except ImportError:
    pass  # then there is no program `goal`
else:
    ActionServer(node, Count, "/count", execute, cancel_callback=lambda _: CancelResponse.ACCEPT,
                 callback_group=ReentrantCallbackGroup())
os.write(1, b"ready\\n")
executor = MultiThreadedExecutor(8)
executor.add_node(node)
executor.spin()
""",
    "ros1": """
import os, time, rospy
from geometry_msgs.msg import Twist
from nav_msgs.msg import Odometry
rospy.init_node("listener", disable_signals=True)
speed = [0.0, 0.0]
def hear(twist):
    speed[0] = twist.linear.x
    os.write(1, f"{time.time()} {abs(twist.linear.x) + abs(twist.angular.z)}\\n".encode())
publisher = rospy.Publisher("/odom", Odometry, queue_size=10)
rospy.Subscriber("/cmd_vel", Twist, hear)
os.write(1, b"ready\\n")
while not rospy.is_shutdown():
    speed[1] += speed[0] * 0.05
    odometry = Odometry()
    odometry.header.stamp = rospy.Time.now()
    odometry.header.frame_id, odometry.child_frame_id = "odom", "base_link"
    odometry.pose.pose.position.x, odometry.pose.pose.orientation.w = speed[1], 1.0
    odometry.twist.twist.linear.x = speed[0]
    publisher.publish(odometry)
    time.sleep(0.05)
""",
}
"""Robots: programs that write the time and size of each velocity as a line, and publish odometry."""
MODULES = (
    "jacaros.runtime.mas.launch",
    "jacaros.runtime.mas.environment",
    "jacaros.robots.artifacts.velocity",
    "jacaros.robots.mapping.artifact",
    "jacaros.robots.ros.drivers.memory.backend",
    "jacaros.robots.world.node",
)
FLOOD = """
from jacaros.robots.artifacts.maneuver import Timed
from jacaros.runtime.cli.main import main
Timed.period = 1e-5
main()
"""
ERRORS = "errors.txt"
"""File with the standard error of the run."""
QUIET = 0.3
"""Seconds without a message after which no message can still be on its way, on an idle machine."""
LATE = 2.0
"""Seconds after the end of a run in which all messages arrive, even on a busy machine or a poor network."""
START = 60.0
"""Time limit in seconds for the first command of a run, even on a busy machine."""
END = 30.0
"""Time limit in seconds for the end of an interrupted run."""


class Velocities:
    """The velocities that a listener writes to a pipe."""

    def __init__(self, pipe: int) -> None:
        self._pipe = pipe
        self._rest = b""
        self.heard: list[tuple[float, float]] = []
        """Time and size of each."""

    def read(self, seconds: float) -> bool:
        """Read for *seconds*; return False if nothing arrives or the pipe is closed."""
        if not select.select([self._pipe], [], [], seconds)[0]:
            return False
        data = os.read(self._pipe, 65536)
        *lines, self._rest = (self._rest + data).split(b"\n")
        for line in lines:
            if line != b"ready":
                at, size = line.split()
                self.heard.append((float(at), float(size)))
        return bool(data)

    def read_until(self, end: float) -> None:
        """Read until *end* (monotonic)."""
        while (rest := end - time.monotonic()) > 0.0:
            self.read(min(rest, 0.05))

    @property
    def moved(self) -> bool:
        """Whether the robot has received a velocity that is not zero."""
        return any(size for _, size in self.heard)

    @property
    def stopped_at(self) -> float | None:
        """Time of the zero after which no other velocity was heard; None if the last one was not zero."""
        stopped = None
        for at, size in reversed(self.heard):
            if size:
                break
            stopped = at
        return stopped


def become_agents(files: list[Path], flood: bool, pipe: int) -> int:
    """Run the agents on the in-process graph, which drive until interrupted; return the exit code."""
    from jacaros.robots.artifacts.maneuver import Timed
    from jacaros.runtime.mas.console import StandardConsole
    from jacaros.runtime.mas.launch import launch
    from jacaros.runtime.mas.options import RunOptions
    from jacaros.runtime.mas.system import System

    if flood:
        Timed.period = 1e-5  # as fast as the loop permits

    def listen(system: System) -> None:
        def hear(sample: Any) -> None:
            twist = sample.message
            os.write(pipe, f"{time.time()} {abs(twist.linear.x) + abs(twist.angular.z)}\n".encode())

        observer = system.ros.companion("observer")
        observer.subscription("/cmd_vel", "geometry_msgs/msg/Twist", hear)

    return launch(files[0], RunOptions(mappings=files[1:]), StandardConsole("error"), listen)


class Interruptions:
    """Runs of agents that are interrupted.

    Args:
        kind: the graph.
        folder: a folder for the programs.
        listener: output of the independent listener; None to use the observer of the run.
        chance: chooses moments and signals.
    """

    def __init__(self, kind: str, folder: Path, listener: int | None, chance: random.Random) -> None:
        self._kind, self._folder, self._listener, self._chance = kind, folder, listener, chance

    def interrupt(self, program: str) -> tuple[str, str]:
        """Run the agents once; return how the run ended, and a line about it."""
        process, pipe = self._start(program)
        velocities = Velocities(pipe)
        anywhere = self._chance.random() < 0.2
        self._wait(velocities, program, anywhere)
        began = time.time()
        numbers = self._signal(process, velocities)
        status = self._end(process, velocities)
        took = time.time() - began
        if self._listener is not None:
            velocities.read_until(time.monotonic() + LATE)
        while velocities.read(QUIET):
            pass
        if self._listener is None:
            os.close(pipe)
        names = "+".join(number.name for number in numbers)
        if status is None:
            where = self._folder / ERRORS
            stacks = where.read_text(errors="replace") if where.exists() else ""
            return "hung", f"{program} {names}: did not end within {END:g} s\n{stacks}"
        stopped, moved = velocities.stopped_at, velocities.moved
        how = "ended before it drove"
        if moved:
            how = "still driving" if stopped is None else "stopped"
        elif not anywhere:
            how = "never drove"
        zero = "no zero" if stopped is None else f"first final zero {stopped - began:+.3f} s"
        last = [round(size, 3) for _, size in velocities.heard[-3:]]
        return how, f"{program} {names}: {zero}, exit {status} after {took:.2f} s, last velocities {last}"

    def _start(self, program: str) -> tuple[int, int]:
        """Start the agents; return their process, and the pipe of the velocities."""
        files = self._files(program)
        if self._listener is not None:
            mappings = [word for file in files[1:] for word in ("--mapping", str(file))]
            start = ["-c", FLOOD] if program == "flood" else ["-m", "jacaros"]
            command = [sys.executable, "-X", "faulthandler", "-P", *start, "run", str(files[0])]
            with (self._folder / ERRORS).open("w") as errors:
                process = subprocess.Popen(
                    [*command, "--ros", self._kind, *mappings], stdout=subprocess.DEVNULL, stderr=errors
                )
            return process.pid, self._listener
        pipe, writing = os.pipe()
        child = os.fork()
        if child == 0:
            os.close(pipe)
            raise Child(files, program == "flood", writing)
        os.close(writing)
        return child, pipe

    def _files(self, program: str) -> list[Path]:
        source = self._folder / f"{program}.asl"
        source.write_text(PROGRAMS[program], encoding="utf-8")
        if program in ("flood", "motion"):
            return [source]
        mapping = self._folder / f"{program}.yaml"
        mapping.write_text(GOALS if program == "goal" else MAPPING, encoding="utf-8")
        return [source, mapping]

    def _wait(self, velocities: Velocities, program: str, anywhere: bool) -> None:
        """Wait until the moment of the interruption."""
        end = time.monotonic() + (self._chance.uniform(0.0, 2.0) if anywhere else START)
        while time.monotonic() < end and (anywhere or not velocities.moved):
            velocities.read(0.01)
        if not anywhere:
            longest = 0.05 if program == "flood" else 1.3
            velocities.read_until(time.monotonic() + self._chance.uniform(0.0, longest))

    def _signal(self, process: int, velocities: Velocities) -> list[signal.Signals]:
        signals = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP)
        numbers = [self._chance.choice(signals)]
        if self._chance.random() < 0.2:
            numbers.append(self._chance.choice(signals))
        for number in numbers:
            os.kill(process, number)
            velocities.read(self._chance.uniform(0.0, 0.02))
        return numbers

    @staticmethod
    def _end(process: int, velocities: Velocities) -> int | None:
        """Return the exit code, or None after killing a process that does not end."""
        deadline = time.monotonic() + END
        while True:
            ended, status = os.waitpid(process, os.WNOHANG)
            if ended:
                return os.waitstatus_to_exitcode(status)
            velocities.read(0.01)
            if time.monotonic() > deadline:
                os.kill(process, signal.SIGABRT)  # faulthandler writes where it hangs
                os.waitpid(process, 0)
                return None


class Child(Exception):
    """Raised in the process that becomes the agents, to leave all of the parent's code."""


def lose_packets(percent: float) -> None:
    """Start this program again in a network that loses *percent* of its packets."""
    rules = (
        "ip link set lo up && nft add table inet t && nft add chain inet t i "
        "'{ type filter hook input priority 0; }' && nft add rule inet t i meta l4proto udp "
        f"numgen random mod 1000 '<' {round(percent * 10)} drop"
    )
    os.environ["FASTDDS_BUILTIN_TRANSPORTS"] = "UDPv4"
    os.environ[LOSING] = "1"
    command = ["unshare", "-n", "sh", "-c", f'{rules} && exec "$@"', "sh", sys.executable, *sys.argv]
    os.execvp(command[0], command)


LOSING = "JACAROS_LOSING_PACKETS"
"""Variable of the program that already runs in the poor network."""
LOAD = "while True: pass"


def main() -> int:
    """Interrupt runs, and print how they ended."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("kind", choices=("memory", "ros1", "ros2", "rosbridge"))
    parser.add_argument("--count", type=int, default=1000, help="number of runs (default: 1000)")
    parser.add_argument(
        "--program", default="flood", help=f"in turn: {', '.join(PROGRAMS)} (default: flood); comma-separated"
    )
    parser.add_argument("--busy", type=int, default=0, help="number of processes that keep the machine busy")
    parser.add_argument("--loss", type=float, default=0.0, help="percentage of packets that are lost")
    parser.add_argument("--seed", type=int, default=0, help="seed of the moments and signals (default: 0)")
    parser.add_argument("--log", type=argparse.FileType("a"), help="file that gets a line for each run")
    arguments = parser.parse_args()
    if arguments.loss and LOSING not in os.environ:
        lose_packets(arguments.loss)
    kind, chance = arguments.kind, random.Random(arguments.seed)
    if kind == "memory":
        for module in MODULES:
            importlib.import_module(module)  # once for all runs, which fork this process
    for number in (signal.SIGINT, signal.SIGHUP):
        signal.signal(number, signal.default_int_handler)  # even if a shell in the background ignores them
    helpers = [subprocess.Popen([sys.executable, "-c", LOAD]) for _ in range(arguments.busy)]
    heard = None
    if kind != "memory":
        graph = kind if kind != "rosbridge" else "ros1" if os.environ.get("ROS_MASTER_URI") else "ros2"
        listener = subprocess.Popen([sys.executable, "-c", LISTENERS[graph]], stdout=subprocess.PIPE)
        helpers.append(listener)
        assert listener.stdout is not None
        heard = listener.stdout.fileno()
        assert os.read(heard, 6) == b"ready\n"
    folder = Path(tempfile.mkdtemp())
    this = os.getpid()
    runs = Interruptions(kind, folder, heard, chance)
    try:
        return count(runs, arguments)
    finally:
        if os.getpid() == this:  # not in a fork that runs the agents
            shutil.rmtree(folder)
            for helper in helpers:
                helper.kill()
                helper.wait()


def count(runs: Interruptions, arguments: argparse.Namespace) -> int:
    """Interrupt runs of each program in turn, and print the results."""
    ends: Counter[str] = Counter()
    programs = arguments.program.split(",")
    began = time.monotonic()
    for number in range(arguments.count):
        end, line = runs.interrupt(programs[number % len(programs)])
        ends[end] += 1
        if arguments.log is not None:
            load = f"load {os.getloadavg()[0]:.0f}"
            print(f"{number}: {end}: {line}, {load}", file=arguments.log, flush=True)
        if end not in ("stopped", "ended before it drove"):
            print(f"run {number}: {end}: {line}", flush=True)
    told = ", ".join(f"{number} {end}" for end, number in ends.most_common())
    seconds = time.monotonic() - began
    print(f"{arguments.kind}: {arguments.count} interruptions in {seconds:.0f} s: {told}", flush=True)
    return 0 if ends["stopped"] + ends["ended before it drove"] == arguments.count else 1


if __name__ == "__main__":
    try:
        code = main()
    except Child as child:
        code = become_agents(*child.args)
    sys.exit(code)
