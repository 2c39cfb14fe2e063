"""The script of `make demo`: the patrol on the embedded world, its summary, and its page."""

import contextlib
import shlex
import subprocess
import sys
import time
from collections.abc import Iterable
from itertools import pairwise
from math import hypot
from pathlib import Path

from jacaros.look import Frame, Recording

ROOT = Path(__file__).resolve().parent.parent
RUNS = ROOT / "runs"
PROJECT = "examples/04_patrol/patrol.jcm"
REPLAY = "runs/replay.html"
RECORD = "runs/patrol.jsonl"


def main() -> int:
    """Run the patrol as a user would, then print a summary."""
    RUNS.mkdir(exist_ok=True)
    command = ["run", PROJECT, "--clock", "fast", "--seed", "1", "--record", RECORD, "--replay", REPLAY]
    if sys.stderr.isatty():
        command.append("--view=terminal")
    print(f"$ jacaros {shlex.join(command)}\n", flush=True)
    began = time.perf_counter()
    code = subprocess.run(
        [str(Path(sys.executable).parent / "jacaros"), *command], cwd=ROOT, check=False
    ).returncode
    took = time.perf_counter() - began
    if code == 0:
        summarise(Recording.read(ROOT / RECORD), took)
        if sys.stdout.isatty():
            show()
    return code


def show() -> None:
    """Serve the page of the run until Ctrl+C; the last lines are its address and how to stop it."""
    print(f"\n$ jacaros view {RECORD}\n", flush=True)
    with contextlib.suppress(KeyboardInterrupt):
        subprocess.run([str(Path(sys.executable).parent / "jacaros"), "view", RECORD], cwd=ROOT, check=False)


def summarise(recording: Recording, took: float) -> None:
    """Print what the robot did, according to the ground truth."""
    frames = recording.frames
    levels = [frame.robots[0].battery for frame in frames]
    # A robot that turns on the spot in the dock stays a moment longer, nearly full: this does not count as a recharge.
    charges = sum(1 for _, kind, data in recording.events if kind == "charging" and data["level"] < 50)
    bumps = sum(1 for _, kind, _ in recording.events if kind in ("bump", "collision"))
    print(f"""
simulated time   {recording.duration:.0f} s in {took:.1f} s, {recording.duration / took:.0f} times real time
driven           {driven(frames):.0f} m, {bumps} bumps
battery          charged {charges} times at the dock, never below {min(levels):.0f} %
replay           {REPLAY}  (open it in a browser)""")


def driven(frames: Iterable[Frame]) -> float:
    """Return the distance that the first robot drove, in metres."""
    states = [frame.robots[0] for frame in frames]
    return sum(hypot(after.x - before.x, after.y - before.y) for before, after in pairwise(states))


if __name__ == "__main__":
    sys.exit(main())
