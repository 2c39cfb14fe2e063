"""Change requests to the house cleaning of both sides: applied, run on the virtual clock, and judged."""

import sys
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from examples_lab import EXAMPLES, falsified

from jacaros.robots.world import RobotEvent
from jacaros.runtime.errors import JacarosError
from jacaros.testing import RunResult, run_project

sys.path.insert(0, str(EXAMPLES.parent / "experiment"))

from change_requests import (
    CHANGES,
    REQUESTS,
    SIDES,
    STUDY_REQUESTS,
    apply,
    changed,
    code_lines,
    cost,
    diff_of,
    judge,
    main,
    table,
)
from scenarios import SCENARIOS, Scenario
from virtual_run import run_baseline

LONGEST = 1000.0
STOP = "add_an_emergency_stop"
SECOND = "add_a_second_robot"


def run(scenario: Scenario, side: str, faults: Path | None) -> RunResult:
    if side == "agents":
        return run_project(scenario.project, world=scenario.world, seconds=LONGEST, faults=faults)
    return run_baseline(scenario, seconds=LONGEST, faults=faults)


def faults_of(request: str) -> Path | None:
    path = CHANGES / request / "faults.yaml"
    return path if path.exists() else None


@cache
def run_of(request: str, side: str) -> RunResult:
    with TemporaryDirectory() as folder:
        return run(changed(request, Path(folder)), side, faults_of(request))


@pytest.mark.slow
@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("request_name", [*REQUESTS, *STUDY_REQUESTS])
def test_the_changed_program_does_what_the_request_says(request_name: str, side: str) -> None:
    result = run_of(request_name, side)
    verdict = judge(request_name, result)
    print(f"{result.seconds:.1f} s", *verdict.lines(), sep="\n")
    assert verdict.complaints == []
    assert result.errors == []
    assert result.exit_code == 0


@pytest.mark.slow
@pytest.mark.parametrize("side", SIDES)
def test_the_other_robot_takes_the_rooms_of_one_that_recharges(side: str) -> None:
    first_round = run_of(SECOND, side).ground_truth.events_of("task")[:4]
    assert [event.data["task"] for event in first_round if event.robot == "robot_2"] == [
        "mop floor kitchen",
        "scrub tub bathroom",
        "mop floor bathroom",
    ]


# The checkers on the present programs, and on runs that went otherwise.


@pytest.mark.slow
@pytest.mark.parametrize("side", SIDES)
def test_the_present_program_does_not_stop(side: str) -> None:
    result = run(SCENARIOS["house_cleaning"], side, faults_of(STOP))
    complaints = judge(STOP, result).complaints
    assert any(each.startswith("the tool was not switched off after the bump at") for each in complaints)
    assert any(each.startswith("the robot moved after the bump at") for each in complaints)


@pytest.mark.slow
def test_the_present_program_leaves_the_new_room_out() -> None:
    scenario = SCENARIOS["house_cleaning"]._replace(world=CHANGES / "add_a_room" / "world.yaml")
    complaints = judge("add_a_room", run(scenario, "baseline", None)).complaints
    assert "16 tasks, not 20" in complaints
    assert "36.0 g of the dust in the study are left, not 0.0" in complaints


@pytest.mark.slow
def test_the_checker_sees_a_robot_that_stays_where_it_was_released() -> None:
    result = run_of(STOP, "agents")
    released = 10.7
    truth = falsified(
        result.ground_truth,
        lambda s: s if s.time < released else s._replace(x=2.0, y=0.0, yaw=0.0, odometer=2.0, charging=False),
        lambda e: e if e.time <= released and e.kind != "tool_started" else None,
    )
    complaints = judge(STOP, RunResult(ground_truth=truth)).complaints
    assert "it did not continue after the bump at 5.9 s" in complaints


def second_robot_without(result: RunResult, wrong: RobotEvent, **changes: object) -> list[str]:
    truth = falsified(
        result.ground_truth,
        event=lambda e: e._replace(**changes) if e is wrong else e,  # type: ignore[arg-type]
    )
    return judge(SECOND, RunResult(ground_truth=truth)).complaints


@pytest.mark.slow
def test_the_checker_sees_a_task_done_twice_and_one_left_out() -> None:
    result = run_of(SECOND, "agents")
    (first, *_) = result.ground_truth.events_of("task")
    complaints = second_robot_without(result, first, data={"task": "scrub tub bathroom", "room": "bathroom"})
    assert complaints[0] == (
        "the tasks of round 1 were mop floor bathroom, scrub tub bathroom, scrub tub bathroom, vacuum carpet living_room"
    )


@pytest.mark.slow
def test_the_checker_sees_two_robots_in_one_room() -> None:
    result = run_of(SECOND, "agents")
    tub = next(e for e in result.ground_truth.events_of("task") if e.data["task"] == "scrub tub bathroom")
    assert second_robot_without(result, tub, robot="robot_1") == [
        "two robots cleaned the bathroom in round 1"
    ]


@pytest.mark.slow
def test_the_checker_sees_a_robot_that_leaves_the_hallway_out() -> None:
    result = run_of(SECOND, "baseline")
    # Its place is (0.4, -0.7).
    truth = falsified(result.ground_truth, lambda s: s._replace(y=max(s.y, -0.6)) if s.x > 0.2 else s)
    complaints = judge(SECOND, RunResult(ground_truth=truth)).complaints
    assert [each.partition(" after")[0] for each in complaints] == ["robot_2 left the hallway out"] * 3


# Costs


def test_blank_lines_comments_and_docstrings_cost_nothing() -> None:
    diff = '''\
diff --git a/one.py b/one.py
--- a/one.py
+++ b/one.py
@@ -1,6 +1,8 @@
-"""Old text
-of two lines."""
+"""New text
+of two lines."""
+# a comment
+a = 1  # code
-b = 2
+
 def f():
+    """What f does."""
     return 1
diff --git a/two.asl b/two.asl
--- a/two.asl
+++ b/two.asl
@@ -1,1 +1,4 @@
 !start.
+// a comment
+/* a section */
+++count.
'''
    assert (code_lines(diff, "+"), code_lines(diff, "-")) == (2, 1)


def test_each_request_has_a_row_with_real_costs() -> None:
    rows = table()
    assert [row.request for row in rows] == ["Add a room", "Add an emergency stop", "Add a second robot"]
    for row in rows:
        assert row.agents.changed > 0
        assert row.baseline.files == ("house_cleaning.py",)
    assert set(rows[2].agents.files) == {"robot.asl", "house_cleaning.jcm"}


def test_the_page_of_the_changes_has_the_present_costs(capsys: pytest.CaptureFixture[str]) -> None:
    main()
    assert capsys.readouterr().out in (CHANGES / "README.md").read_text(encoding="utf-8")


def test_the_cost_is_that_of_the_changed_file(tmp_path: Path) -> None:
    scenario = changed("add_a_room", tmp_path)
    before = SCENARIOS["house_cleaning"].baseline.read_text(encoding="utf-8").splitlines()
    after = scenario.baseline.read_text(encoding="utf-8").splitlines()
    assert [line for line in after if line not in before] == [
        '    "study": ((3.8, 0.0), {"vacuum carpet": 2.5}),'
    ]
    assert cost("add_a_room", "baseline") == (1, 0, ("house_cleaning.py",))


def test_a_diff_that_no_longer_fits_is_an_error(tmp_path: Path) -> None:
    (tmp_path / "house_cleaning.py").write_text("rewritten = True\n", encoding="utf-8")
    with pytest.raises(JacarosError, match=r"add_a_room/baseline\.diff no longer fits it"):
        apply(diff_of("add_a_room", "baseline"), tmp_path)
