"""Latency from a published sensor message to the resulting command, through one plan of an agent.

    latency.py [memory|ros1|ros2] [--busy [--same-interval]]
    latency.py ros1 --profile

An outside node publishes numbered odometry messages at 100 Hz and waits for the command with the same number: by turns
through an agent (artifact, belief, event, plan, operation), and through an echo written with the client library alone.
Prints both, and how many times as long the agent takes; figures on a busy machine say little.

With ``--busy`` the agent's plan is urgent and has 100 intentions beside it that never rest, and the echo has a computing
thread beside it.  On the graph in memory the two measure in turn, each in a separate process.
The echo's process keeps Python's own switch interval of 5 ms; with ``--same-interval`` it has the 0.5 ms that
``jacaros run`` sets.

With ``--profile`` the agents' process also prints, for each stop of a message on its way, the time since the stop before.
Looking at the clock makes the agent slower by some microseconds.
"""

import contextlib
import os
import re
import shutil
import socket
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

from jacaros.runtime.mas.launch import SWITCH_INTERVAL

HERE = Path(__file__).resolve().parent / "latency"
JACAROS = Path(sys.executable).parent / "jacaros"
INTERVAL = "BENCHMARK_SWITCH_INTERVAL"
"""The environment variable read by latency/computing.py."""


def main() -> None:
    """Measure on one kind of graph."""
    busy, profile = "--busy" in sys.argv, "--profile" in sys.argv
    kind = next((word for word in sys.argv[1:] if not word.startswith("--")), "memory")
    if "--same-interval" in sys.argv:
        os.environ[INTERVAL] = str(SWITCH_INTERVAL)
    if profile and kind != "ros1":
        sys.exit("latency: --profile measures ROS 1 only")
    print(with_ratios(in_process(busy) if kind == "memory" else on_graph(kind, busy, profile)))


def in_process(busy: bool) -> str:
    """Measure on the in-process graph; next to a busy load, the two ways run in turn as processes."""
    turns = [["agent"], ["bare"]] * 3 if busy else [[]]
    reports = [
        subprocess.run(
            [sys.executable, HERE / "memory.py", *way], check=True, stdout=subprocess.PIPE, text=True
        ).stdout
        for way in turns
    ]
    return "".join(reports).rstrip()


def on_graph(kind: str, busy: bool, profile: bool) -> str:
    """Measure on a real graph; with *profile*, the agents' process prints where the time is spent."""
    more = ["--busy"] if busy else []
    program = HERE / f"{kind}.py"
    with tempfile.TemporaryDirectory() as scratch, graph(kind, Path(scratch)) as environment:
        jacaros = [sys.executable, HERE / "stops.py"] if profile else [JACAROS]
        agents = [*jacaros, "run", HERE / ("busy.asl" if busy else "echo.asl"), "--ros", kind, "--quiet"]
        with running(agents, environment), running([sys.executable, program, "echo", *more], environment):
            time.sleep(3)
            done = subprocess.run(
                [sys.executable, program, "ping", *more],
                env=environment,
                check=True,
                timeout=120,
                stdout=subprocess.PIPE,
                text=True,
            )
    return done.stdout.rstrip()


def with_ratios(report: str) -> str:
    """Return the report, with a line about the ratio of the agent's time."""
    figures: dict[str, list[tuple[float, float]]] = {"agent": [], "bare": []}
    for way, median, most in re.findall(r"(agent|bare) +median +([\d.]+) ms.* 99 % +([\d.]+) ms", report):
        figures[way].append((float(median), float(most)))
    if not all(figures.values()):
        return report
    ratios = [
        statistics.median(row[place] for row in figures["agent"])
        / statistics.median(row[place] for row in figures["bare"])
        for place in (0, 1)
    ]
    return f"{report}\nagent / bare: median {ratios[0]:.2f}, 99 % {ratios[1]:.2f}"


@contextlib.contextmanager
def graph(kind: str, scratch: Path) -> Iterator[dict[str, str]]:
    """A graph of our own on this machine: the environment that leads to it."""
    environment = {**os.environ, "ROS_LOG_DIR": str(scratch), "JACAROS_CACHE": str(scratch / "cache")}
    if kind == "ros2":
        environment |= {
            "ROS_DOMAIN_ID": str(1 + os.getpid() % 100),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        }
    if kind != "ros1":
        yield environment
        return
    master = shutil.which("rosmaster", path=f"{os.environ.get('PATH', '')}:/usr/bin")
    if master is None:
        sys.exit("latency: there is no rosmaster; run tools/install_ros1.sh")
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port = probe.getsockname()[1]
    environment |= {
        "ROS_MASTER_URI": f"http://127.0.0.1:{port}",
        "ROS_IP": "127.0.0.1",
        "PYTHONWARNINGS": "ignore",
    }
    with running([master, "--core", "-p", str(port)], environment):
        time.sleep(2)
        yield environment


@contextlib.contextmanager
def running(command: "list[str | Path]", environment: dict[str, str]) -> Iterator[None]:
    """A process in the background."""
    process = subprocess.Popen(command, env=environment, stdout=subprocess.DEVNULL)
    try:
        yield
    finally:
        process.terminate()
        try:
            process.wait(10)
        except subprocess.TimeoutExpired:
            process.kill()


if __name__ == "__main__":
    main()
