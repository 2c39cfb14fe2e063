"""The patrol of example 4, recorded: from the wheel command back to the message of the battery, and a changed program."""

from pathlib import Path

import pytest

from jacaros.look import Recording
from jacaros.look.records.records import Record, is_well_formed
from jacaros.look.why.why import explain
from jacaros.runtime.cli.main import call
from jacaros.runtime.mas.replaying import replay_against

EXAMPLE = Path(__file__).parents[2] / "examples" / "04_patrol"
LOW = '+diagnostics("Low Battery")'


@pytest.fixture(scope="module")
def records(tmp_path_factory: pytest.TempPathFactory) -> list[Record]:
    run = tmp_path_factory.mktemp("patrol") / "run.jsonl"
    arguments = ["run", str(EXAMPLE / "patrol.jcm"), "--clock", "fast", "--seed", "1", "--for", "52"]
    assert call([*arguments, "--record", str(run), "--quiet"]) == 0
    return list(Recording.read(run).events)


def low_at(records: list[Record]) -> float:
    """When the battery was low for the first time."""
    return next(t for t, event, data in records if event == "deliberation" and data["trigger"] == LOW)


def test_every_record_of_a_run_is_well_formed(records: list[Record]) -> None:
    assert [record for record in records if not is_well_formed(record[1], record[2])] == []


def test_the_stop_for_the_battery_is_traced_to_its_message(records: list[Record]) -> None:
    answer = explain(records, "why did the robot stop?", at=low_at(records) + 0.5)
    kinds = [fact.kind for fact in answer.because]
    chain = [kind for kind in kinds if kind != "operation"]
    assert chain == ["command", "goal", "act", "event", "property", "sample"]
    goal, act, event, prop, sample = answer.because[-5:]
    assert goal.text.startswith("!patrol([1,2,3,4]) with ")
    assert "suspended" in goal.text
    # The plan for the event has no such step; that of the library for the goal that followed from it has.
    assert act.text == "`needs(wheels)` of @navigation__charge"
    assert act.file == "$jacaros/navigation.asl"
    assert event.text.startswith(LOW)
    assert "battery" in prop.text
    assert sample.text.startswith("/battery_state")


def test_the_command_that_drives_is_traced_to_the_goals(records: list[Record]) -> None:
    answer = explain(records, "command", at=3.0)
    kinds = [fact.kind for fact in answer.because]
    assert kinds[:4] == ["command", "operation", "act", "event"]
    assert set(kinds[4:]) == {"event"}
    assert answer.because[2].text.startswith("step `driveTo(X, Y)`")
    assert answer.because[-1].text.startswith("+!start")


def test_what_the_suspended_patrol_and_the_plan_that_charges_wait_for(records: list[Record]) -> None:
    answer = explain(records, "waiting", at=low_at(records) + 1.0)
    assert any("!patrol" in fact.text and "is suspended" in fact.text for fact in answer.facts)
    assert any("driveTo" in fact.text and "waits for" in fact.text for fact in answer.facts)
    answer = explain(records, "waiting", at=low_at(records) + 0.4)
    assert any("!charge_now, waits for the resource wheels" in fact.text for fact in answer.facts)


def test_the_same_program_decides_as_before(records: list[Record]) -> None:
    found = replay_against(records, EXAMPLE / "robot.asl")
    assert (found.decisions, found.only_then, found.only_now) == ((), (), ())
    assert found.same > 50


def test_a_changed_condition_decides_otherwise(records: list[Record], tmp_path: Path) -> None:
    changed = tmp_path / "robot.asl"
    program = (EXAMPLE / "robot.asl").read_text(encoding="utf-8")
    changed.write_text(program.replace(f"{LOW} : next(Corner)", f"{LOW} : next(Corner) & battery(B) & B < 5"))
    (decision,) = replay_against(records, changed).decisions
    assert (decision.event, decision.t) == (LOW, low_at(records))
    assert decision.now is None
    assert "stops at `B < 5` with B=" in decision.reasons[0].text
