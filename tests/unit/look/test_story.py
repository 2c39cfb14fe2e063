"""The story of a run: what matters, in at most ten lines."""

import json
from pathlib import Path
from typing import Any

import pytest
from click.testing import CliRunner

from jacaros.look.page.recorder import Recorder
from jacaros.look.records.lasting import Lasting
from jacaros.look.records.records import Record
from jacaros.look.why.story import MOST, story_of, story_text
from jacaros.look.why.tales import StoryLine, reason
from jacaros.runtime.cli.recordings import why

EMPTY = (
    "action_failed, action /navigate_to_pose was aborted with code 105: the battery is empty (watch.asl:7)\n"
    "step: navigate_to(2,2,0)"
)


def goal(t: float, goal: str, state: str, number: int, intention: int = 1, **more: Any) -> Record:
    data = {"agent": "watch", "goal": goal, "state": state, "id": number, "intention": intention, **more}
    return t, "goal", data


def rounds(count: int, lasting: float = 10.0) -> list[Record]:
    """A patrol by tail calls: each round replaces the one before, in one intention."""
    found: list[Record] = [(0.0, "agent", {"agent": "watch", "state": "began"})]
    for number in range(count):
        found.append(goal(number * lasting, f"!patrol({number % 4 + 1})", "pursued", number))
        found.append(goal((number + 1) * lasting, f"!patrol({number % 4 + 1})", "replaced", number))
    return found[:-1]


def texts(happened: list[Record]) -> list[str]:
    return [each.text for each in story_of(happened)]


def test_the_rounds_of_a_loop_are_one_line() -> None:
    run = [*rounds(24), goal(240.0, "!patrol(4)", "dropped", 23), (240.0, "ended", {"code": 0})]
    first, end = story_of(run)
    assert (first.text, first.t, first.until) == ("watch: pursued `!patrol`, 24 rounds", 0.0, 240.0)
    assert end.text == "the run ended with exit code 0; still wanted: `!patrol(4)`"
    assert end.level == "note"


def test_a_goal_that_no_plan_saved_leaves_its_agent_without_one() -> None:
    warning = f"[watch] warning: the goal !patrol(4) failed and has no plan for its failure: {EMPTY}"
    run = [
        *rounds(24),
        (239.0, "battery_empty", {"robot": "turtlebot", "level": 0}),
        (239.0, "log", {"level": "warning", "text": warning}),
        goal(239.0, "!patrol(4)", "failed", 23, why=EMPTY),
        (239.1, "intention", {"agent": "watch", "id": 1, "state": "over"}),
        (839.0, "ended", {"code": 0}),
    ]
    assert story_text(story_of(run)).splitlines() == [
        "  0.000 s         watch: pursued `!patrol`, 24 rounds (until 239.100 s)",
        "239.000 s  error  turtlebot: the battery is empty",
        "239.000 s  error  watch: `!patrol(4)` failed: the battery is empty",
        "839.000 s  error  the run ended with exit code 0; watch had no goal for the last 10 min",
    ]


def test_a_failure_that_a_plan_handled_is_a_warning_and_counted() -> None:
    run = [goal(0.0, "!work", "pursued", 1)]
    for t in (5.0, 6.0, 7.0):
        run += [
            goal(t, "!grip(3)", "pursued", int(t)),
            goal(t, "!hold", "failed", int(t) + 100, why=f"ia_failed, slipped by {t} mm"),
            goal(t, "!grip(3)", "failed", int(t), why=f"ia_failed, slipped by {t} mm"),
            goal(t, "!grip(3)", "pursued", int(t)),
            goal(t + 0.5, "!grip(3)", "recovered", int(t)),
        ]
    handled = next(each for each in story_of(run) if "handled" in each.text)
    assert handled.text == "watch: `!grip(3)` failed: slipped by 5.0 mm; a plan handled it"
    assert (handled.level, handled.count, handled.until) == ("warning", 3, 7.0)


def test_a_run_that_ends_with_suspended_goals_alone_is_a_warning() -> None:
    suspended = [goal(0.0, "!deliver", "pursued", 1), goal(5.0, "!deliver", "suspended", 1)]
    dropped: list[Record] = [goal(60.0, "!deliver", "dropped", 1), (60.0, "ended", {"code": 0})]
    *_, end = story_of([*suspended, *dropped])
    assert end.level == "warning"
    assert end.text == "the run ended with exit code 0; still wanted: `!deliver` (suspended)"
    *_, end = story_of([*suspended, goal(8.0, "!deliver", "resumed", 1), *dropped])
    assert (end.level, "suspended" in end.text) == ("note", False)


def test_faults_breakdowns_interventions_questions_and_lost_localisation_are_lines() -> None:
    run: list[Record] = [
        *rounds(3),
        (2.0, "fault", {"robot": "r1", "fault": "ice", "kind": "wheel_slip", "state": "begins"}),
        (3.25, "fault", {"robot": "r1", "fault": "ice", "kind": "wheel_slip", "state": "acts"}),
        (4.0, "fault", {"robot": "r1", "fault": "ice", "kind": "wheel_slip", "state": "ends"}),
        *((5.0 + t, "believed", {"robot": "r1", "x": 0.0, "y": 0.0, "yaw": 0.0}) for t in range(8)),
        (13.0, "believed", {"robot": "r1", "x": None, "y": None, "yaw": None}),
        (14.0, "believed", {"robot": "r2", "x": 0.0, "y": 0.0, "yaw": 0.0}),
        (15.0, "bump", {"robot": "r1", "side": "left"}),
        (16.0, "bump", {"robot": "r2", "side": "left"}),
        (17.0, "intervention", {"what": "open door d1"}),
        (
            18.0,
            "property",
            {"artifact": "/main/op", "name": "question", "key": 1, "values": [1, "go on?", []]},
        ),
        (19.0, "log", {"level": "warning", "text": "[watch] warning: stale scan"}),
        (20.0, "ended", {"code": 2}),
    ]
    told = {each.text: each for each in story_of(run)}
    slipped = told["r1: fault `ice` (wheel slip), with an effect from 3.250 s"]
    assert (slipped.count, slipped.until) == (1, 4.0)
    assert told["r1, r2: was not where it believed to be"].level == "warning"
    assert "r1, r2: bumped into a wall, left" in told
    assert "you changed the run: open door d1" in told
    assert "a person was asked: go on?" in told
    assert told["watch: stale scan"].level == "warning"
    assert [*told.values()][-1].level == "error"


def test_what_matters_stays_when_there_are_too_many_lines() -> None:
    run = rounds(3)
    for number in range(40):
        run.append((30.0 + number, "task", {"robot": "r1", "task": f"task {chr(97 + number)}", "room": ""}))
    run += [goal(80.0, "!patrol(3)", "failed", 2, why=EMPTY), (90.0, "ended", {"code": 0})]
    found = texts(run)
    assert len(found) == MOST
    assert "watch: `!patrol(3)` failed: the battery is empty" in found
    assert found[-1].startswith("the run ended")


def test_a_recording_without_an_end_says_so() -> None:
    *_, end = story_of(rounds(3))
    assert end == StoryLine(
        20.0, "the recording stops before the end of the run; still wanted: `!patrol(3)`", "warning"
    )


@pytest.mark.parametrize(
    ("why", "shortest"),
    [
        (EMPTY, "the battery is empty"),
        ("no_relevant, no relevant plan for !go(1) (a.asl:1)", "no relevant plan for !go(1)"),
        (
            "operation move/1 of artifact arm was stopped by hazard",
            "operation move/1 of artifact arm was stopped by hazard",
        ),
        ("", ""),
    ],
)
def test_a_reason_is_as_short_as_it_can_be(why: str, shortest: str) -> None:
    assert reason(why) == shortest


def test_a_run_that_continues_has_no_end_yet() -> None:
    lines = story_of(
        [(1.0, "goal", {"agent": "a", "goal": "!go", "state": "pursued", "id": 1})], is_over=False
    )
    assert (lines[-1].level, lines[-1].text) == ("note", "the run continues; pursued: `!go`")


def test_the_command_prints_the_story_as_text_or_json_until_a_moment(tmp_path: Path) -> None:
    recorder = Recorder(tmp_path / "run.jsonl")
    recorder.world({"name": "lab", "robots": []})
    for record in rounds(3):
        recorder.event(*record)
    recorder.close()
    path = str(tmp_path / "run.jsonl")
    printed = CliRunner().invoke(why, [path, "--story"]).output.splitlines()
    assert printed[0] == " 0.000 s           watch: pursued `!patrol`, 3 rounds (until 20.000 s)"
    told = json.loads(CliRunner().invoke(why, [path, "--story", "--json", "--at", "12"]).output)
    assert told[0]["text"] == "watch: pursued `!patrol`, 2 rounds"


@pytest.mark.parametrize("arguments", [["--story", "stopped"], ["--story", "--agent", "watch"], []])
def test_the_command_takes_either_a_question_or_the_story(arguments: list[str]) -> None:
    result = CliRunner().invoke(why, ["run.jsonl", *arguments])
    assert result.exit_code != 0
    assert "--story" in str(result.exception) + result.output


def test_unknown_kinds_and_levels_of_newer_versions_are_skipped() -> None:
    run: list[Record] = [
        (0.0, "lost", {"agent": "watch"}),
        (0.0, "error", {}),
        (1.0, "log", {"level": "odd", "text": "hm"}),
    ]
    assert texts([*run, (2.0, "ended", {"code": 0})]) == ["the run ended with exit code 0"]


def test_a_fault_lasts_until_it_ends_whether_it_acts_or_not() -> None:
    lasting: Lasting[str] = Lasting()
    for state, kept in (("begins", ["begins"]), ("acts", ["acts"]), ("ends", [])):
        lasting.take("fault", {"fault": "ice", "state": state}, state)
        assert [*lasting] == kept
