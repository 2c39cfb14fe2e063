"""A program as a page in a browser runs it, on this Python."""

import json
from pathlib import Path
from typing import Any

import pytest

from jacaros.browser.page import start
from jacaros.browser.program import RunningProgram
from jacaros.runtime import cli

PATROL = (Path(cli.__file__).parent / "patrol.asl").read_text(encoding="utf-8")
ROBOT = {"world": "patrol", "mappings": ["nav2.yaml", "turtlebot4.yaml"]}


class Played:
    """A program that has run for some seconds, and what it has posted."""

    def __init__(self, files: dict[str, str], seconds: float, turn: float = 0.02, **options: Any) -> None:
        self.posted: list[Any] = []
        main = options.pop("main", next(iter(files)))
        source = {"files": files, "main": main, "seed": 1, **options}
        self.running = start(
            json.dumps(source), lambda text: self.posted.append(json.loads(text)), float("inf")
        )
        self.until(seconds, turn)

    def until(self, seconds: float, turn: float = 0.02) -> RunningProgram:
        while not self.running.over and self.running.elapsed < seconds:
            self.running.pump(turn)
        return self.running

    def end(self) -> str:
        """Stop the run, and return why it could not run, or ""."""
        self.running.stop()
        for _ in range(2000):
            if self.running.over:
                break
            self.running.pump(0.05)
        assert self.running.over
        return str(self.posted[-1]["error"])

    @property
    def records(self) -> list[dict[str, Any]]:
        return [each for message in self.posted if isinstance(message, list) for each in message]

    @property
    def texts(self) -> list[tuple[float, str]]:
        return [(each["t"], each["text"]) for each in self.records if each["kind"] == "text"]

    @property
    def logs(self) -> str:
        return "\n".join(
            each["text"] for each in self.posted if isinstance(each, dict) and each["kind"] == "log"
        )

    def reply(self, number: int) -> dict[str, Any]:
        return next(each for each in self.posted if isinstance(each, dict) and each.get("id") == number)


def test_a_robot_drives_and_the_page_sees_it() -> None:
    it = Played({"patrol.asl": PATROL}, 16.0, **ROBOT)
    assert it.posted[0]["kind"] == "hello"
    assert [text for _, text in it.texts] == ["corner 1", "corner 2"]
    frames = [each["robots"][0] for each in it.records if each["kind"] == "frame" and each["robots"]]
    assert max(frame[0] for frame in frames) > 1.9
    it.running.receive('{"id": 7, "do": "why", "question": "!patrol(3)"}')
    it.until(18.0)
    assert "patrol handled" in it.reply(7)["result"]
    assert it.end() == ""
    assert [each for each in it.records if each.get("event") == "ended"]


def test_a_run_does_not_depend_on_the_turns_it_gets() -> None:
    played = [Played({"patrol.asl": PATROL}, 30.0, turn, **ROBOT) for turn in (0.001, 0.1)]
    for each in played:
        each.end()
    first, second = ([text for text in each.texts if text[0] < 30.0] for each in played)
    assert first == second != []


def test_a_pause_from_the_page_stops_time_and_an_answer_still_comes() -> None:
    it = Played({"patrol.asl": PATROL}, 3.0, **ROBOT)
    it.running.receive('{"id": 1, "do": "pause"}')
    it.running.pump(0.05)
    reached = it.running.elapsed
    it.running.receive('{"id": 2, "do": "story"}')
    for _ in range(5):
        it.running.pump(0.05)
    assert it.reply(2)["ok"]
    assert it.running.elapsed == reached
    it.running.receive('{"id": 3, "do": "continue"}')
    it.until(reached + 1.0)
    assert it.end() == ""


def test_an_endless_program_leaves_turns_to_the_page_and_can_be_stopped() -> None:
    it = Played({"busy.asl": "!count(0).\n+!count(N) <- !count(N + 1)."}, 0.01)
    it.running.receive('{"id": 1, "do": "offers", "agent": "busy"}')
    for _ in range(3):
        assert it.running.pump(0.02) == 0.0
    assert it.reply(1)["ok"]
    assert it.end() == ""


def test_errors_of_a_program_come_with_their_place_and_help() -> None:
    error = Played({"wrong.asl": "!go.\n+!go <- .print(1)"}, 1.0).end()
    assert error.startswith("wrong.asl:2:")
    assert "help: " in error


@pytest.mark.parametrize("name", ["evil.py", "../up.asl", ".hidden.asl", "a/b.asl", "x.asl\n", "page.html"])
def test_files_that_could_do_more_than_a_program_are_refused(name: str) -> None:
    it = Played({"main.asl": "!go.", name: "1"}, 1.0)
    assert it.end().startswith("file not allowed in a browser")


def test_a_program_that_is_too_large_is_refused() -> None:
    assert "too large" in Played({"main.asl": "// " + "x" * 200_001}, 1.0).end()
    assert "too large" in Played({f"a{n}.asl": "" for n in range(21)}, 1.0).end()


def test_agents_from_a_link_touch_no_files_and_no_python() -> None:
    program = '!go.\n+!go <- .list_files("/", L); .print("saw ", L).\n-!go <- .print("refused")'
    it = Played({"main.asl": program + "."}, 1.0, until_idle=True)
    assert [text for _, text in it.texts] == ["refused"]


def test_a_project_has_its_files_beside_it() -> None:
    files = {
        "two.jcm": "mas two {\n    agent ann\n    agent bob : ann.asl\n}\n",
        "ann.asl": "!hello.\n+!hello : .my_name(Me) <- .print(Me).",
    }
    it = Played(files, 1.0, until_idle=True, main="two.jcm")
    assert sorted(text for _, text in it.texts) == ["ann", "bob"]
    assert it.running.over
