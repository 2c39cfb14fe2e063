"""Recording a system that runs inside a Python program."""

import json
from pathlib import Path
from typing import Any

import pytest

from jacaros import Mas
from jacaros.look import record
from jacaros.runtime.cli.main import main

FAST = pytest.mark.clock("fast")


def lines_of(path: Path) -> list[dict[str, Any]]:
    return [json.loads(line) for line in path.read_text().splitlines()]


@FAST
async def test_world_lines_and_goals_are_recorded(tmp_path: Path) -> None:
    async with Mas(seed=1, on_print=lambda agent, text: None) as mas:
        mas.add_agent("ann", "+!go <- .wait(500); .print(hello).")
        with record(mas, tmp_path / "run.jsonl", replay=tmp_path / "run.html") as recording:
            assert recording is not None
            bob = mas.add_agent("bob", "+!go <- .wait(1000).")
            await mas.agent("ann").achieve("go")
            await bob.achieve("go")
        await mas.agent("ann").achieve("go")
        assert [text for _, _, text in recording.texts] == ["hello"]
    written = lines_of(tmp_path / "run.jsonl")
    assert written[0]["kind"] == "world"
    assert [(line["t"], line["agent"], line["text"]) for line in written if line["kind"] == "text"] == [
        (0.5, "ann", "hello")
    ]
    goals = [line["data"] for line in written if line["kind"] == "event" and line["event"] == "goal"]
    assert {(goal["agent"], goal["state"]) for goal in goals} >= {("ann", "achieved"), ("bob", "achieved")}
    assert max(line["t"] for line in written if line["kind"] == "frame") == 1.5
    assert (tmp_path / "run.html").read_text(encoding="utf-8").startswith("<!doctype html>")


@FAST
async def test_a_run_without_robots_has_no_world() -> None:
    async with Mas() as mas:
        mas.add_agent("ann", "+!go <- .wait(500).")
        with record(mas) as recording:
            assert recording is not None
            await mas.agent("ann").achieve("go")
            assert recording.world == {}
            mas.ros  # noqa: B018  # the world comes into being when the graph is first asked for
            await mas.agent("ann").achieve("go")
            assert recording.world["name"] == "empty"
            assert recording.frames[-1].robots


@FAST
async def test_a_file_alone_is_not_kept_in_memory(tmp_path: Path) -> None:
    async with Mas() as mas:
        with record(mas, tmp_path / "run.jsonl") as recording:
            assert recording is None
    assert (tmp_path / "run.jsonl").is_file()


PROJECT = """mas work {
    agent worker: worker.py { join: w }
    agent starter
    workspace w { artifact wheels: Wheels }
}"""
WORKER = """from jacaros import Atom, OperationFailed, PythonAgent
from jacaros.artifacts import Artifact, operation


class Wheels(Artifact):
    @operation
    async def roll(self, metres: int) -> None:
        if metres > 5:
            self.fail("too far", Atom("far"))
        await self.sleep(metres)


class Worker(PythonAgent):
    async def run(self):
        await self.act("roll", 2)
        try:
            await self.act("roll", 9)
        except OperationFailed:
            self.session.begin("roll", 5)
            await self.sleep(1)
"""


def test_goals_of_agents_in_python_and_agents_created_later_are_recorded(tmp_path: Path) -> None:
    (tmp_path / "work.jcm").write_text(PROJECT)
    (tmp_path / "worker.py").write_text(WORKER)
    (tmp_path / "artifacts.py").write_text(WORKER)
    (tmp_path / "starter.asl").write_text('!s. +!s <- .wait(100); .create_agent(late, "late.asl").')
    (tmp_path / "late.asl").write_text("!l. +!l <- .wait(1).")
    options = ["--clock", "fast", "--until-idle", "--record", str(tmp_path / "r")]
    with pytest.raises(SystemExit) as ended:
        main(["run", str(tmp_path / "work.jcm"), *options])
    goals = [line["data"] for line in lines_of(tmp_path / "r") if line.get("event") == "goal"]
    told = [(goal["state"], goal["goal"]) for goal in goals if goal["agent"] == "worker"]
    assert told == [
        ("pursued", "Worker.run"),
        ("pursued", "roll(2)"),
        ("achieved", "roll(2)"),
        ("pursued", "roll(9)"),
        ("failed", "roll(9)"),
        ("pursued", "roll(5)"),
        ("achieved", "Worker.run"),
        ("achieved", "roll(5)"),
    ]
    assert [goal["why"] for goal in goals if goal["state"] == "failed"] == ["too far"]
    assert [goal["state"] for goal in goals if goal["agent"] == "late"] == ["pursued", "achieved"]
    assert not ended.value.code


@FAST
async def test_the_causes_of_an_action_are_recorded_from_the_message_on(tmp_path: Path) -> None:
    program = """
        !start.
        +!start
          <- makeArtifact(odometry, "ArtOdometry", [], O); focus(O);
             makeArtifact(wheels, "ArtCmdVel", [], _); moveForward(1).
        +odom(X, _, _) : X > 0.5 & not told <- +told; lookupArtifact(wheels, _).
    """
    async with Mas(seed=1, on_print=lambda agent, text: None) as mas:
        with record(mas, tmp_path / "run.jsonl", replay=tmp_path / "run.html"):
            mas.add_agent("ann", program)
            await mas.sleep(5)
    linked = [
        line["data"]
        for line in lines_of(tmp_path / "run.jsonl")
        if line.get("event") in ("cause", "deliberation")
    ]
    causes = {data["id"]: {"kind": "event", **data} for data in linked}
    [link] = [cause for cause in causes.values() if cause.get("what") == "ann lookupArtifact/2"]
    chain = [link]
    while link["parent"]:
        link = causes[link["parent"]]
        chain.append(link)
    assert [each["kind"] for each in chain] == ["act", "event", "property", "sample"]
    assert chain[-1]["topic"] == "/odom"
    assert "pose.pose.position.x=" in chain[-1]["what"]
    assert chain[-1]["at"] <= chain[0]["at"] < 5
