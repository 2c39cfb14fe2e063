"""A run on a real graph is paused from its page: the robot stands, drives on, and the recording has the chain."""

import json
import signal
import subprocess
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from processes import JACAROS, PATIENCE, Agents, WorldProcess
from websockets.sync.client import ClientConnection, connect

from jacaros.robots.world.data.ground_truth import GroundTruth

STILL = 0.8
"""Seconds after which a robot that was commanded to stand stands: 0.2 more than a signal may take, for its brakes."""


def records(path: Path) -> list[dict[str, Any]]:
    """Return the complete lines of a recording that is being written."""
    if not path.exists():
        return []
    lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    return [json.loads(line) for line in lines if line.endswith("\n")]


def events(path: Path, event: str) -> list[dict[str, Any]]:
    return [each["data"] for each in records(path) if each.get("event") == event]


def driven(truth: GroundTruth, since: float, until: float) -> float:
    """Metres that the robot drove between two times of the world."""
    meters = [sample.odometer for sample in truth.path() if since <= sample.time <= until]
    return meters[-1] - meters[0] if meters else 0.0


def chain(path: Path, kind: str) -> list[str]:
    """Return the kinds of the links from the last cause of a kind back to its beginning."""
    links = {each["id"]: each for each in events(path, "cause")}
    links |= {each["id"]: {**each, "kind": "event"} for each in events(path, "deliberation")}
    link = next(each for each in reversed(links.values()) if each["kind"] == kind)
    kinds = []
    while link is not None:
        kinds.append(link["kind"])
        link = links.get(link["parent"])
    return kinds


class LivePage:
    """The debugger of a run, as its page reaches it."""

    def __init__(self, socket: ClientConnection) -> None:
        self._socket = socket

    def do(self, command: str) -> float:
        """Send a command and wait for its success; when that was, in seconds since the Unix epoch."""
        self._socket.send(json.dumps({"id": 1, "do": command}))
        while True:
            message = json.loads(self._socket.recv(PATIENCE))
            if isinstance(message, dict) and message.get("kind") == "reply":
                assert message["ok"], message
                return time.time()


@contextmanager
def page_of(agents: Agents) -> Iterator[LivePage]:
    """Open the page of a run."""
    agents.until_error("view: ")
    address = next(line.split("view: ")[1] for line in agents.errors if "view: " in line)
    with connect(f"{address.replace('http', 'ws', 1)}live", proxy=None, max_size=None) as socket:
        yield LivePage(socket)


def ask_why(recording: Path, question: str) -> str:
    """Return the answer of ``jacaros why``."""
    return subprocess.run(
        [JACAROS, "why", str(recording), question], check=True, capture_output=True, text=True
    ).stdout


def stands_after(world: WorldProcess, moment: float) -> bool:
    """Wait for a second in which the robot should stand; whether it did."""
    since = world.time_of(moment) + STILL
    # A robot that stands is sampled once a second.
    world.until_truth(lambda truth: truth.path()[-1].time > since + 1.0, "a second after the stop")
    return driven(world.truth, since, since + 99.0) == 0.0


def test_a_pause_stops_the_robot_and_a_continued_run_drives_on(world, run_agents, tmp_path: Path) -> None:
    record = tmp_path / "run.jsonl"
    agents = run_agents("percept.asl", "--view", "--record", str(record))
    with page_of(agents) as page:
        world.until_truth(lambda truth: driven(truth, 0.0, 99.0) > 0.2, "the robot drives")
        assert stands_after(world, page.do("pause"))
        stood = world.truth.path()[-1]
        assert stood.x < 2.0, "it stands on the way"
        page.do("continue")
        world.until_truth(lambda truth: truth.path()[-1].x > stood.x + 0.2, "the robot drives on")
        again = page.do("pause")
        agents.signal(signal.SIGTERM)
        assert agents.end() == 128 + signal.SIGTERM
    assert stands_after(world, again)
    states = events(record, "debug")
    assert [each["state"] for each in states][:4] == ["running", "paused", "running", "paused"]
    assert any("the ROS graph" in line for line in states[1]["cannot"])
    why = ask_why(record, "why did the robot stop?")
    assert "robot stopped at" in why
    assert "operation" in why
    assert chain(record, "command") == ["command", "operation", "act", "event", "property", "sample"]
