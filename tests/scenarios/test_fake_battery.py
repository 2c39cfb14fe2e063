"""Scenario 3: a battery that runs down."""

import pytest
from examples_lab import checker, falsified, run, run_of

TIMER = "03_fake_battery/fake_battery.jcm"
ROBOT = "03_fake_battery/robot_battery.jcm"
check = checker("03_fake_battery").check


def test_the_agent_prints_every_state_of_the_timer_battery_in_order() -> None:
    result = run_of(TIMER)
    assert result.lines == [
        "[robot] 100 %: Full Battery",
        "[robot] 50 %: Medium Battery",
        "[robot] 20 %: Low Battery",
        "[robot] 0 %: empty",
    ]
    assert check(result.lines).complaints == []
    assert run_of(TIMER).seconds == pytest.approx(100.0, abs=0.1)


def test_the_agent_prints_every_state_of_the_robots_battery() -> None:
    result = run_of(ROBOT)
    assert check(result.lines, result.ground_truth).complaints == []


def test_the_program_alone_reads_the_timer_battery() -> None:
    assert run("03_fake_battery/robot.asl").lines == run_of(TIMER).lines


@pytest.mark.parametrize(
    "lines",
    [
        [],
        ["[robot] 100 %: Full Battery", "[robot] 50 %: Medium Battery", "[robot] 20 %: Low Battery"],
        [
            "[robot] 100 %: Full Battery",
            "[robot] 20 %: Low Battery",
            "[robot] 50 %: Medium Battery",
            "[robot] 0 %: empty",
        ],
        [
            "[robot] 100 %: Full Battery",
            "[robot] 49 %: Medium Battery",
            "[robot] 20 %: Low Battery",
            "[robot] 0 %: empty",
        ],
        [
            "[robot] 100 %: Full Battery",
            "[robot] 50 %: Medium Battery",
            "[robot] 50 %: Medium Battery",
            "[robot] 20 %: Low Battery",
            "[robot] 0 %: empty",
        ],
    ],
    ids=["nothing", "end missing", "order", "late", "twice"],
)
def test_the_checker_sees_wrong_lines(lines: list[str]) -> None:
    assert not check(lines).passed


def test_the_checker_sees_a_battery_that_jumped_or_did_not_get_empty() -> None:
    result = run_of(ROBOT)
    false = falsified(result.ground_truth, event=lambda e: None if e.data.get("level") == 50 else e)
    assert not check(result.lines, false).passed
    false = falsified(result.ground_truth, event=lambda e: None if e.data.get("level", 100) < 10 else e)
    assert not check(result.lines, false).passed
