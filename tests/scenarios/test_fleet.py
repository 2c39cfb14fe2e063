"""Three robots in processes of their own: one is killed, the others take over its room, and it comes back."""

import os
import re
import signal
import subprocess
import sys
import threading
from pathlib import Path
from time import monotonic

import pytest
from examples_lab import EXAMPLES, checker, passed

from jacaros.robots.world import GroundTruth

pytest.importorskip("zenoh")

FOLDER = EXAMPLES / "12_fleet"
PATIENCE = 90.0
"""Seconds that a busy machine may take for a step that takes up to ten."""


class Run:
    """A process of ``jacaros run`` on the example, and what it prints.

    Args:
        fleet: name of the fleet, that of no other run of the tests.
        truth: its ground truth file.
        options: further options.
    """

    def __init__(self, fleet: str, truth: Path, *options: str) -> None:
        self.lines: list[str] = []
        given = ("--fleet", fleet, "--ground-truth", str(truth), *options)
        self.process = subprocess.Popen(
            [sys.executable, "-m", "jacaros", "run", str(FOLDER / "fleet.jcm"), *given],
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            env={**os.environ, "PYTHONUNBUFFERED": "1"},
        )
        self._news = threading.Condition()
        self._has_ended = False
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        assert self.process.stdout is not None
        with self.process.stdout as output:
            for line in output:
                with self._news:
                    self.lines.append(line.rstrip())
                    self._news.notify()
        with self._news:
            self._has_ended = True
            self._news.notify()

    def find(self, pattern: str) -> list[str]:
        """Return what the first group of a pattern is in each line that has it, in their order."""
        return [found[1] for line in self.lines if (found := re.search(pattern, line))]

    def wait_for(self, pattern: str) -> str:
        """Wait for a line with a pattern. Return its first group."""
        with self._news:
            self._news.wait_for(lambda: self.find(pattern) or self._has_ended, PATIENCE)
        assert self.find(pattern), f"no line has {pattern}:\n" + "\n".join(self.lines)
        return self.find(pattern)[0]

    def end(self) -> int:
        """Wait for the end. Return the exit code."""
        code = self.process.wait(PATIENCE)
        self._reader.join()
        return code

    def stop(self) -> None:
        """End it, however far it is."""
        self.process.terminate()
        self.end()


def process_of(node: str, run: Run) -> int:
    """Return the id of a node's process."""
    parent = run.process.pid
    for child in Path(f"/proc/{parent}/task/{parent}/children").read_text().split():
        if f"--node\0{node}\0" in Path(f"/proc/{child}/cmdline").read_text():
            return int(child)
    raise AssertionError(f"no process of {node}")


@pytest.mark.skipif(sys.platform != "linux", reason="finds processes in /proc")
@pytest.mark.slow
def test_others_take_over_the_room_of_a_killed_robot_and_it_returns(tmp_path: Path) -> None:
    fleet = f"example{os.getpid()}"
    all_nodes = Run(fleet, tmp_path / "truth.jsonl", "--all-nodes")
    runs = [all_nodes]
    try:
        for other in (2, 3):  # they have heard from robot_1, so their maps show what it has taken
            all_nodes.wait_for(rf"\[robot_{other}\] I go to the (.*)")
        os.kill(process_of("pc_1", all_nodes), signal.SIGKILL)
        killed = monotonic()
        room = all_nodes.wait_for(r"\[robot_2\] robot_1 has left the (.*)")
        assert all_nodes.wait_for(r"\[robot_3\] robot_1 has left the (.*)") == room
        noticed = monotonic() - killed
        all_nodes.wait_for(f"the {room} goes to (robot_[23]),")

        again = Run(fleet, tmp_path / "again.jsonl", "--node", "pc_1")
        runs.append(again)
        assert again.end() == 0
        assert all_nodes.end() == 128 + signal.SIGKILL
    finally:
        for run in runs:
            run.stop()

    print(f"the loss was noticed after {noticed:.2f} s")
    assert room in all_nodes.find("the (.*) is clean")  # by the robot that took it over
    returned = again.find(r"\[robot_1\] the (.*) is clean")
    assert set(returned) & set(again.find("the (.*) goes to robot_1,"))
    everywhere = [*all_nodes.find("the (.*) is clean$"), *returned]
    assert {each for each in everywhere if each != "building"} == set(checker("12_fleet").ROOMS)
    assert sorted(all_nodes.find(r"(robot_.)\] the building is clean")) == ["robot_2", "robot_3"]
    assert "building" in returned
    worlds = [tmp_path / name for name in ("pc_2.truth.jsonl", "pc_3.truth.jsonl", "again.jsonl")]
    passed(checker("12_fleet").check([GroundTruth.read(each) for each in worlds]))
