"""What people read while something is not there yet, and that it works when it comes."""

from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from judging import distance
from masters import Master
from presence import need
from processes import Agents, Program, WorldProcess

PROGRAMS = Path(__file__).parent / "programs"
YARD = Path(__file__).parent / "worlds" / "yard.yaml"
HELP = "start it with `roscore`, or set ROS_MASTER_URI to its address"


@pytest.fixture
def late_master(kind: str, request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Master]:
    """A master that the test starts."""
    need(kind, request.config)
    made = Master(tmp_path)
    yield made
    made.close()


def words(process: Program) -> list[str]:
    """What a process has said of the master."""
    return [line for line in process.errors if "ROS master" in line]


@pytest.mark.only("ros1")
def test_a_master_that_is_late_is_awaited_in_plain_words(kind: str, late_master, tmp_path: Path) -> None:
    processes = (
        agents := Agents(PROGRAMS / "short.asl", kind, late_master.environment),
        world := WorldProcess(YARD, kind, late_master.environment, tmp_path),
    )
    told = [
        f"[ros] waiting for the ROS master at {late_master.uri}",
        f"[ros] the ROS master at {late_master.uri} is missing; still trying; {HELP}",
        f"[ros] found the ROS master at {late_master.uri}",
    ]
    try:
        agents.until_line("begins")
        for process in processes:
            process.until_error("is missing")
            assert words(process) == told[:2]
        late_master.start()
        assert agents.end() == 0
        assert agents.lines == ["[short] begins", "[short] arrived"]
        assert distance(world.close().latest(), (0.5, 0.0)) <= 0.02
        for process in processes:
            assert words(process) == told
            assert process.complaints == []
    finally:
        for process in processes:
            process.stop()


def test_a_robot_that_is_late_is_awaited_in_plain_words(run_world, run_agents: Callable[..., Agents]) -> None:
    agents = run_agents("short.asl")
    agents.until_error("still listening")
    # ROS 2 also warns about an empty graph; another test covers that.
    [told] = [line for line in agents.errors if "still listening" in line]
    assert told == (
        "[Wheels] no publisher on topic /odom (nav_msgs/msg/Odometry); still listening; "
        "is the node that publishes it running?"
    )
    world = run_world(YARD)
    assert agents.end() == 0
    assert agents.lines == ["[short] begins", "[short] arrived"]
    assert distance(world.close().latest(), (0.5, 0.0)) <= 0.02
