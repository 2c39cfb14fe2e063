"""Replay of a recorded run against a changed program: the same decisions, or each difference with its reason."""

import json
from pathlib import Path
from typing import Any

import pytest

import jacaros
from jacaros import Mas
from jacaros.artifacts import Artifact, Out, operation
from jacaros.look import Recording
from jacaros.runtime.cli.main import call
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.replaying import Comparison, replay_against

PROGRAM = """
!start.
+!start <- makeArtifact("robot", "ROBOT", [], Id); focus(Id); !go(kitchen).
+!go(Room) <- drive(Room); +at(Room); !look.
-!go(Room)[error_msg(_)] <- +lost(Room).
+!look <- .send(bob, askOne, colour(_), colour(C)); +seen(C).
+battery(B) : B < 20 <- +low(B).
+battery(B).
+hint(X)[source(bob)] <- +told(X).
+bump <- +bumped.
"""
BOB = "colour(red). !tell. +!tell <- .wait(500); .send(ann, tell, hint(7))."


class Robot(Artifact):
    """A robot whose battery gets low."""

    def init(self) -> None:
        self.define_property("battery", 50)

    @operation
    def where(self, x: Out[float], y: Out[float]) -> None:
        """Tell where it is."""
        x.set(3.0)
        y.set(4.0)

    @operation
    async def drive(self, room: str) -> None:
        """Drive there in a second."""
        await self.sleep(1.0)
        if room == "cellar":
            self.failed("stairs", reason=("stairs", 3))
        self.update_property("battery", 15)
        self.signal("bump")


def recorded(program: str, folder: Path) -> list[tuple[float, str, dict[str, Any]]]:
    """The records of five seconds of a run with ann, who runs *program*, and bob."""
    found: list[tuple[float, str, dict[str, Any]]] = []

    async def main() -> None:
        async with Mas(seed=1, explain=True, folder=folder, on_log=lambda *_: None) as mas:
            mas.system.history().listen(lambda t, event, data: found.append((t, event, dict(data))))
            mas.add_agent("ann", program.replace('"ROBOT"', f'"{__name__}.Robot"'))
            mas.add_agent("bob", BOB)
            await mas.sleep(5.0)

    jacaros.run(main(), clock="fast")
    return found


def against(changed: str, folder: Path, program: str = PROGRAM) -> Comparison:
    file = folder / "changed.asl"
    file.write_text(changed, encoding="utf-8")
    return replay_against(recorded(program, folder), file, "ann")


def test_the_same_program_decides_as_before(tmp_path: Path) -> None:
    found = against(PROGRAM, tmp_path)
    assert found.decisions == ()
    assert (found.only_then, found.only_now, found.waiting, found.unreadable) == ((), (), (), 0)
    assert found.same >= 7


def test_a_changed_condition_is_reported_with_its_reason(tmp_path: Path) -> None:
    found = against(PROGRAM.replace("B < 20", "B < 10"), tmp_path)
    (decision,) = found.decisions
    assert decision.event == "+battery(15)"
    assert decision.t == pytest.approx(1.0)
    assert decision.then is not None
    assert decision.then.text == "`+battery(B) : B < 20`"
    assert decision.now is not None
    assert decision.now.text == "`+battery(B)`"
    assert [each.text for each in decision.reasons] == ["`+battery(B) : B < 10`: stops at `B < 10` with B=15"]
    assert "then: `+battery(B) : B < 20`" in found.text()
    again = against(PROGRAM.replace("B < 20", "B < 10"), tmp_path)
    assert found.data() == again.data(), "a rerun is the same each time"


def test_a_removed_plan_and_goals_of_one_program_only_are_reported(tmp_path: Path) -> None:
    found = against(PROGRAM.replace("+hint(X)[source(bob)] <-", "+hint(X) : false <-"), tmp_path)
    (decision,) = found.decisions
    assert (decision.event, decision.now) == ("+hint(7)", None)
    found = against(PROGRAM.replace("+at(Room); !look.", "+at(Room)."), tmp_path)
    assert [each.partition(" at ")[0] for each in found.only_then] == ["+!look"]
    assert found.decisions == ()


def test_results_of_actions_are_those_that_were_recorded(tmp_path: Path) -> None:
    program = PROGRAM.replace("drive(Room); +at(Room)", "where(X, Y); +at(X, Y)")
    program += "+at(X, Y) : X > 2 <- +east."
    found = against(program, tmp_path, program)
    assert (found.decisions, found.only_then, found.only_now) == ((), (), ())
    found = against(program.replace("X > 2", "X > 3"), tmp_path, program)
    (decision,) = found.decisions
    assert decision.reasons[0].text == "`+at(X,Y) : X > 3`: stops at `X > 3` with X=3"


def test_beliefs_and_goals_of_the_project_file_are_given(tmp_path: Path) -> None:
    program = "+!go : speed(S) & S > 2 <- .print(fast). +!go <- .print(slow)."
    (tmp_path / "a.asl").write_text(program, encoding="utf-8")
    (tmp_path / "p.jcm").write_text("mas p { agent a { beliefs: speed(3) goals: go } }", encoding="utf-8")
    run = tmp_path / "run.jsonl"
    options = ["--clock", "fast", "--until-idle", "--record", str(run)]
    assert call(["run", str(tmp_path / "p.jcm"), *options]) == 0
    found = replay_against(list(Recording.read(run).events), tmp_path / "a.asl")
    assert (found.same, found.decisions, found.only_then, found.only_now) == (1, (), (), ())


def test_an_action_that_was_not_recorded_waits(tmp_path: Path) -> None:
    found = against(PROGRAM.replace("drive(Room);", "fly(Room);"), tmp_path)
    assert found.waiting == ("fly(kitchen)",)


def test_a_recorded_failure_fails_again(tmp_path: Path) -> None:
    program = PROGRAM.replace("!go(kitchen).", "!go(cellar).")
    found = against(program, tmp_path, program)
    assert found.decisions == ()
    assert found.only_then == found.only_now == ()
    assert found.same >= 4


def test_an_agent_must_be_named_where_there_are_several(tmp_path: Path) -> None:
    file = tmp_path / "changed.asl"
    file.write_text(PROGRAM, encoding="utf-8")
    records = recorded(PROGRAM, tmp_path)
    with pytest.raises(UsageError, match=r"several agents\n  = help: --agent with one of ann, bob"):
        replay_against(records, file)
    with pytest.raises(UsageError, match="unknown agent: `eve`"):
        replay_against(records, file, "eve")
    with pytest.raises(UsageError, match="no decisions in the recording"):
        replay_against([], file)


def test_the_command_prints_the_comparison(tmp_path: Path, capfd: pytest.CaptureFixture[str]) -> None:
    program, changed, run = tmp_path / "a.asl", tmp_path / "b.asl", tmp_path / "run.jsonl"
    program.write_text("!go. +!go : not done <- .print(then). +!go.", encoding="utf-8")
    changed.write_text("!go. +!go : done <- .print(then). +!go.", encoding="utf-8")
    assert call(["run", str(program), "--clock", "fast", "--until-idle", "--record", str(run)]) == 0
    assert call(["replay", str(run), "--against", str(program)]) == 0
    assert "a decides as before; 1 decisions are the same" in capfd.readouterr().out
    assert call(["replay", str(run), "--against", str(changed), "--json"]) == 1
    data = json.loads(capfd.readouterr().out)
    assert data["decisions"][0]["event"] == "+!go"
    assert call(["replay", str(run), "--against", str(tmp_path / "c.asl")]) == 2
    assert call(["replay", str(run), "--against", str(tmp_path)]) == 2
