"""The sides of the experiment: their policies are those of one table, and ablations take away what they name."""

import ast
import math
import re
import sys
from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path

import pytest
from examples_lab import EXAMPLES

from jacaros.runtime.files.yaml import plain_values
from jacaros.testing import RunResult

sys.path.insert(0, str(EXAMPLES.parent / "experiment"))

from scenarios import FOLDER, SCENARIOS
from sides import (
    LIBRARY,
    OVER_NAV2,
    Setting,
    project_of,
    run_agents,
    run_python,
    without_checks,
    without_urgency,
)

POLICIES, _ = plain_values((FOLDER / "policies.yaml").read_text(encoding="utf-8"))
BASELINES = sorted((FOLDER / "baseline").glob("*.py"))
HARNESS = {"shift"}
"""Policies that runs of the experiment set: programs have a longer shift."""


def declared(program: Path) -> Iterator[tuple[str, object]]:
    """Yield the parameters that a node declares, with their defaults."""
    for node in ast.walk(ast.parse(program.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Call) and getattr(node.func, "attr", "") == "declare_parameter":
            yield ast.literal_eval(node.args[0]), ast.literal_eval(node.args[1])


@pytest.mark.parametrize("program", BASELINES, ids=lambda path: path.stem)
def test_baselines_declare_the_policies(program: Path) -> None:
    for name, value in declared(program):
        if name in POLICIES and name not in HARNESS:
            assert value == POLICIES[name], name


@pytest.mark.parametrize("name", OVER_NAV2)
def test_trees_have_the_policies_of_attempts(name: str) -> None:
    assert {"attempts", "pause", "charged_within"} <= dict(declared(SCENARIOS[name].baseline)).keys()


@pytest.mark.parametrize("name", OVER_NAV2)
def test_agents_believe_in_the_policies(name: str) -> None:
    program = project_of(name).with_name("robot.asl").read_text(encoding="utf-8")
    beliefs = {
        name: float(value) for name, value in re.findall(r"^(\w+)\(([\d.]+)\)\.", program, re.MULTILINE)
    }
    assert beliefs["attempts"] == POLICIES["attempts"]
    for policy in beliefs.keys() & POLICIES.keys() - HARNESS:
        assert beliefs[policy] == POLICIES[policy], policy


def test_the_library_pauses_as_the_trees_do() -> None:
    plan = LIBRARY.read_text(encoding="utf-8").partition("+!recover(_)")[2].partition("\n\n")[0]
    assert "!forget_obstacles;" in plan
    assert re.findall(r"\.wait\((\d+)\)", plan) == [f"{1000 * POLICIES['pause']:.0f}"]


def greatest_speeds(result: RunResult) -> tuple[float, float]:
    """Return the greatest speed and turn rate over a fifth of a second, in m/s and rad/s."""
    path = result.ground_truth.path()[::4]
    steps = [(before, after, after.time - before.time) for before, after in pairwise(path)]
    speed = max(math.dist((a.x, a.y), (b.x, b.y)) / seconds for a, b, seconds in steps)
    return speed, max(abs(math.remainder(b.yaw - a.yaw, math.tau)) / seconds for a, b, seconds in steps)


@pytest.mark.parametrize("name", ["out_and_back", "square"])
@pytest.mark.parametrize("run", [run_agents, run_python], ids=["agents", "baseline"])
def test_motions_are_as_fast_as_the_policies_say(name: str, run: type[RunResult], tmp_path: Path) -> None:
    speed, turn_rate = greatest_speeds(run(Setting(name, 1, "faults: {}\n", tmp_path)))  # type: ignore[call-arg, arg-type]
    assert speed == pytest.approx(POLICIES["speed"], rel=0.1)
    assert turn_rate == pytest.approx(POLICIES["turn_rate"], rel=0.1)


# ---- ablations


def programs() -> list[str]:
    """Return the library and the programs of the agents."""
    files = [LIBRARY, *(project_of(name).with_name("robot.asl") for name in SCENARIOS)]
    return [file.read_text(encoding="utf-8") for file in files]


def test_without_urgency_no_plan_has_one() -> None:
    assert any("urgency(" in each for each in programs())
    assert not any(re.search(r"urgency\(\d", without_urgency(each)) for each in programs())
    assert "@navigation__charge[needs(wheels)]" in without_urgency(programs()[0])


def test_without_checks_no_program_looks_whether_it_has_arrived() -> None:
    changed = [without_checks(each) for each in programs()]
    assert [a == b for a, b in zip(programs(), changed, strict=True)] == [
        False,
        False,
        False,
        True,
        False,
        False,
    ]
    posted = r"!found_at\(Place, tries\(Number\)\)\.|^(arrives|visits)_within\(|0\.05 \* 0\.05"
    assert sum(len(re.findall(posted, each, re.MULTILINE)) for each in programs()) >= 5
    assert not any(re.search(posted, each, re.MULTILINE) for each in changed)


@pytest.mark.parametrize("name", ["out_and_back", "square"])
def test_agents_without_checks_do_a_task_that_nothing_disturbs(name: str, tmp_path: Path) -> None:
    result = run_agents(Setting(name, 1, "faults: {}\n", tmp_path), change=without_checks)
    assert SCENARIOS[name].judge(result).complaints == []
