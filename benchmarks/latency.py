"""From a published sensor message to the command that it leads to, through one plan of an agent.

    latency.py [memory|ros1|ros2]

An outside node publishes numbered odometry messages at 100 Hz and waits for the command with the same number: by turns
through an agent (artifact, belief, event, plan, operation), and through an echo written with the client library alone.
Prints both; figures on a busy machine say little.
"""

import contextlib
import os
import shutil
import socket
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path

HERE = Path(__file__).resolve().parent / "latency"
JACAROS = Path(sys.executable).parent / "jacaros"


def main() -> None:
    """Measure on one kind of graph."""
    kind = sys.argv[1] if len(sys.argv) > 1 else "memory"
    if kind == "memory":
        subprocess.run([sys.executable, HERE / "memory.py"], check=True)
        return
    program = HERE / f"{kind}.py"
    with tempfile.TemporaryDirectory() as scratch, graph(kind, Path(scratch)) as environment:
        agents = [JACAROS, "run", HERE / "echo.asl", "--ros", kind, "--quiet"]
        with running(agents, environment), running([sys.executable, program, "echo"], environment):
            time.sleep(3)
            subprocess.run([sys.executable, program, "ping"], env=environment, check=True, timeout=120)


@contextlib.contextmanager
def graph(kind: str, scratch: Path) -> Iterator[dict[str, str]]:
    """A graph of our own on this machine: the environment that leads to it."""
    environment = {**os.environ, "ROS_LOG_DIR": str(scratch), "JACAROS_CACHE": str(scratch / "cache")}
    if kind == "ros2":
        environment |= {
            "ROS_DOMAIN_ID": str(1 + os.getpid() % 100),
            "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        }
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
