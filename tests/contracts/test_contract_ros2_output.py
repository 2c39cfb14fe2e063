"""ROS 2 alone: the middleware's own reports do not end up among the agents' lines."""

import re
from pathlib import Path

import pytest
from programs import run_program

pytestmark = pytest.mark.ros2

PROGRAM = """
import resource, signal
from jacaros.runtime.clock import WallClock, run
from jacaros.robots.ros.open import open_backend

# No room for shared memory: Fast DDS logs a warning, and uses the network.
signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
resource.setrlimit(resource.RLIMIT_FSIZE, (1024, 1024))

async def main():
    backend = open_backend("ros2", WallClock(), "node")
    await backend.start()
    backend.publisher("/a", "std_msgs/msg/String")
    backend.rcl.get_logger().warning("rclpy has something to say")
    await backend.close()
    print("[agent] done")

run(main, WallClock())
"""


def test_logs_of_the_middleware_go_to_standard_error(domain: dict[str, str]) -> None:
    usual = {"RCUTILS_LOGGING_USE_STDOUT": "1", "FASTDDS_BUILTIN_TRANSPORTS": "DEFAULT"}
    done = run_program(PROGRAM, domain | usual)
    for name in re.findall(r"segment (fast(?:rtps|dds)_\w+)", done.stderr + done.stdout):
        Path("/dev/shm", name).unlink(missing_ok=True)  # the empty file that it could not enlarge
    assert done.returncode == 0, done.stderr
    assert done.stdout == "[agent] done\n"
    assert "RTPS" in done.stderr
    assert "rclpy has something to say" in done.stderr
