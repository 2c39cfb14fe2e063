"""Recording a system that runs inside a Python program."""

import json
from pathlib import Path

import jacaros
from jacaros import Mas
from jacaros.inspector import record


def test_world_lines_and_goals_are_recorded(tmp_path: Path) -> None:
    async def main() -> None:
        async with Mas(seed=1, on_print=lambda agent, text: None) as mas:
            mas.add_agent("ann", "+!go <- .wait(500); .print(hello).")
            with record(mas, tmp_path / "run.jsonl", replay=tmp_path / "run.html") as recording:
                assert recording is not None
                bob = mas.add_agent("bob", "+!go <- .wait(1000).")
                await mas.agent("ann").achieve("go")
                await bob.achieve("go")
            await mas.agent("ann").achieve("go")
            assert [text for _, _, text in recording.texts] == ["hello"]

    jacaros.run(main(), clock="fast")
    written = [json.loads(line) for line in (tmp_path / "run.jsonl").read_text().splitlines()]
    assert written[0]["kind"] == "world"
    assert [(line["t"], line["agent"], line["text"]) for line in written if line["kind"] == "text"] == [
        (0.5, "ann", "hello")
    ]
    goals = [line["data"] for line in written if line["kind"] == "event" and line["event"] == "goal"]
    assert {(goal["agent"], goal["state"]) for goal in goals} >= {("ann", "achieved"), ("bob", "achieved")}
    assert max(line["t"] for line in written if line["kind"] == "frame") == 1.5
    assert (tmp_path / "run.html").read_text(encoding="utf-8").startswith("<!doctype html>")


def test_a_file_alone_is_not_kept_in_memory(tmp_path: Path) -> None:
    async def main() -> None:
        async with Mas() as mas:
            with record(mas, tmp_path / "run.jsonl") as recording:
                assert recording is None

    jacaros.run(main(), clock="fast")
    assert (tmp_path / "run.jsonl").is_file()
