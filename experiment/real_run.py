"""Run the pair of the experiment again on real ROS 2, with the world in a process of its own and the wall clock.

    .venv-ros2-jazzy/bin/python experiment/real_run.py square patrol --seeds 40 --workers 2

Each run has the disturbance that the record of the virtual runs has for its seed. Outcomes go to
docs/experiment_ros2.jsonl.gz after each run; those that it has are not made again. A run takes as long as on a robot:
do not load the machine meanwhile.
"""

import argparse
import json
import os
import re
import signal
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from pathlib import Path
from queue import SimpleQueue

import record
from disturbances import SEEDS, disturbance
from jacaros.robots.world import GroundTruth
from jacaros.testing import RunResult
from runs import Family, judged
from scenarios import FOLDER, SCENARIOS
from sides import AGENTS, CYCLES, PAIR, Setting, baseline_of, project_for, world_of

DISTRIBUTION = "jazzy"
FIRST_DOMAIN = 41
"""The first of the ROS 2 domains: one for each worker."""

BEGIN = 60.0
"""Seconds in which the world must have opened, and a program that was interrupted must end."""

SOURCE = str(FOLDER.parent / "src")
BESIDE = os.pathsep.join([SOURCE, str(FOLDER / "stand_ins")])
"""Where baselines find modules: they import packages of ROS 2 that no package index has, with what they use of them."""


class Program:
    """A process, its output, and when it printed each line.

    Args:
        command: the program and its arguments.
        domain: number of its ROS 2 graph.
        path: where it finds modules.

    Attributes:
        timed: seconds since the Unix epoch, and the line.
    """

    def __init__(self, command: list[str], domain: int, path: str = SOURCE) -> None:
        self.timed: list[tuple[float, str]] = []
        self._process = subprocess.Popen(
            command,
            env=os.environ | environment(domain, path),
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
        self._reader = threading.Thread(target=self._read)
        self._reader.start()

    def _read(self) -> None:
        assert self._process.stdout is not None
        with self._process.stdout as lines:
            self.timed += ((time.time(), line.rstrip("\n")) for line in lines)

    def end(self, seconds: float) -> int:
        """Wait for the end; a program that does not end is interrupted, and killed if that does not help.

        Returns:
            The exit code; 0 for a program that was interrupted, as a run that was still going on has none.
        """
        try:
            code = self._process.wait(seconds)
        except subprocess.TimeoutExpired:
            code = 0
            self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(BEGIN)
            except subprocess.TimeoutExpired:
                self._process.kill()
                self._process.wait()
        self._reader.join()
        return code


def environment(domain: int, path: str) -> Mapping[str, str]:
    """Return the variables of a graph of its own on this machine."""
    return {
        "ROS_DOMAIN_ID": str(domain),
        "ROS_AUTOMATIC_DISCOVERY_RANGE": "LOCALHOST",
        "RCUTILS_LOGGING_BUFFERED_STREAM": "0",
        "PYTHONUNBUFFERED": "1",
        "PYTHONPATH": path,
    }


@contextmanager
def opened(world: str | Path, setting: Setting, domain: int) -> Iterator[tuple[Path, float]]:
    """Run a world in a process of its own; give its ground truth file, and the moment at which its time was 0."""
    faults, file = setting.folder / "faults.yaml", setting.folder / "truth.jsonl"
    faults.write_text(setting.faults, encoding="utf-8")
    options = ["--seed", str(setting.seed), "--faults", str(faults), "--ground-truth", str(file)]
    command = [sys.executable, "-m", "jacaros", "sim", str(world), "--ros", "ros2", *options]
    process = Program(command, domain)
    try:
        deadline = time.monotonic() + BEGIN
        while not (file.exists() and "\n" in (text := file.read_text(encoding="utf-8"))):
            assert time.monotonic() < deadline, f"the world does not open: {process.timed}"
            time.sleep(0.05)
        yield file, json.loads(text.partition("\n")[0])["epoch"]
    finally:
        process.end(0.0)


def run(setting: Setting, side: str, domain: int) -> RunResult:
    """Make one run."""
    with opened(world_of(setting.scenario, setting.folder), setting, domain) as (file, epoch):
        program = Program(command_of(setting, side), domain, SOURCE if side == AGENTS else BESIDE)
        code = program.end(setting.limit)
        ended = time.time() - epoch
        time.sleep(1.0)  # without commands a robot stops in half a second
    timed = [(moment - epoch, line) for moment, line in program.timed]
    lines = [re.sub(r"^\[INFO\] \[\d+\.\d+\] \[(\w+)\]: ", r"[\1] ", line) for _, line in timed]
    # The world is there before the program: its battery has begun to run down when the program reports it full.
    lines = [re.sub(r" \d+ %: Full Battery$", " 100 %: Full Battery", line) for line in lines]
    return RunResult(lines, [], timed, code, ended, GroundTruth.read(file))


def command_of(setting: Setting, side: str) -> list[str]:
    """Return the command that runs a side."""
    if side == AGENTS:
        project = str(project_for(setting))
        return [sys.executable, "-m", "jacaros", "run", project, "--ros", "ros2", "--clock", "real"]
    scenario = baseline_of(setting.scenario)
    parameters = {**scenario.parameters, **({"shift": CYCLES} if setting.scenario == "patrol" else {})}
    arguments = [word for name, value in parameters.items() for word in ("-p", f"{name}:={value}")]
    return [sys.executable, str(scenario.baseline), *(["--ros-args", *arguments] if arguments else [])]


def made(family: Family, side: str, draw: int, domains: "SimpleQueue[int]") -> record.Outcome:
    """Make one run, and judge it."""
    drawn, domain = disturbance(*family, draw), domains.get()
    try:
        with tempfile.TemporaryDirectory() as folder:
            result = run(Setting(*family, drawn.faults, Path(folder)), side, domain)
    finally:
        domains.put(domain)
    return judged(family, side, draw, drawn, result)


def main() -> None:
    """Make the runs that are missing."""
    parser = argparse.ArgumentParser(description="Run the pair of the experiment again on real ROS 2.")
    parser.add_argument("scenarios", nargs="+", choices=SCENARIOS)
    parser.add_argument("--seeds", type=int, default=len(SEEDS) // 5, help="number of seeds (default 40)")
    parser.add_argument("--workers", type=int, default=1, help="runs at the same time (default 1)")
    given = parser.parse_args()
    # A shell lets programs in the background ignore it, and so would those that are started here and interrupted.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    draws = {(each.scenario, each.seed): each.draw for each in record.read(record.VIRTUAL)}
    known = {each[:3]: each for each in record.read(record.ROS2)}
    domains: SimpleQueue[int] = SimpleQueue()
    for number in range(given.workers):
        domains.put(FIRST_DOMAIN + number)
    jobs = [
        (Family(scenario, seed), side, draws[scenario, seed])
        for seed in SEEDS[: given.seeds]
        for scenario in given.scenarios
        for side in PAIR
        if (scenario, seed) in draws and (scenario, side, seed) not in known
    ]
    with ThreadPoolExecutor(given.workers) as pool:
        for outcome in pool.map(lambda job: made(job[0], job[1], job[2], domains), jobs):
            known[outcome[:3]] = outcome
            record.write(known.values(), record.ROS2)
            print(
                *outcome[:3],
                outcome.kind,
                outcome.end,
                f"{outcome.seconds:g} s",
                outcome.complaint,
                flush=True,
            )


if __name__ == "__main__":
    main()
