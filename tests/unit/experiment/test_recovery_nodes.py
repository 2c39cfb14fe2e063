"""The nodes of Nav2's recovery tree: statuses of children go in; the status, and which children are ticked, come out.

Expectations follow the documentation of Nav2's nodes and of BehaviorTree.CPP.
"""

from collections.abc import Iterator
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import py_trees
import pytest

from beside import importing_beside
from virtual_rclpy.installed import installed

BASELINE = Path(__file__).parents[3] / "experiment" / "baseline"
SUCCESS, FAILURE, RUNNING, INVALID = (
    getattr(py_trees.common.Status, name) for name in ("SUCCESS", "FAILURE", "RUNNING", "INVALID")
)
STATUSES = {"s": SUCCESS, "f": FAILURE, "r": RUNNING}


@pytest.fixture(scope="module")
def nodes() -> Iterator[ModuleType]:
    with installed(), importing_beside(BASELINE / "recovery.py"):
        import recovery

        yield recovery


class Scripted(py_trees.behaviour.Behaviour):  # type: ignore[misc]
    """Returns the statuses of a script, one a tick, the last one for ever; logs its ticks and halts."""

    def __init__(self, name: str, log: list[str], script: str) -> None:
        super().__init__(name)
        self.log, self.script = log, script

    def update(self) -> Any:
        self.log.append(self.name)
        status, rest = self.script[0], self.script[1:]
        self.script = rest or status
        return STATUSES[status]

    def terminate(self, new_status: Any) -> None:
        if self.status == RUNNING and new_status == INVALID:
            self.log.append(f"{self.name} halted")


def ticks(node: Any, log: list[str], count: int) -> list[tuple[Any, str]]:
    """Tick a node; return its status after each tick, and the children that were ticked."""
    outcomes = []
    for _ in range(count):
        log.clear()
        node.tick_once()
        outcomes.append((node.status, " ".join(log)))
    return outcomes


def recovery_node(module: ModuleType, retries: int, child: str, recovery: str) -> tuple[Any, list[str]]:
    log: list[str] = []
    children = Scripted("child", log, child), Scripted("recovery", log, recovery)
    return module.RecoveryNode("node", retries, *children), log


@pytest.mark.parametrize(
    ("retries", "child", "recovery", "expected"),
    [
        # Without a failure there is no recovery.
        (1, "rs", "s", [(RUNNING, "child"), (SUCCESS, "child")]),
        # All happens in one tick as long as nothing is running.
        (1, "fs", "s", [(SUCCESS, "child recovery child")]),
        (1, "f", "s", [(FAILURE, "child recovery child")]),
        (2, "f", "s", [(FAILURE, "child recovery child recovery child")]),
        (0, "f", "s", [(FAILURE, "child")]),
        # A recovery that fails makes the node fail.
        (6, "f", "f", [(FAILURE, "child recovery")]),
        # A running recovery is resumed without a tick of the child, and the same for the child.
        (1, "frs", "rrs", [(RUNNING, "child recovery"), (RUNNING, "recovery"), (RUNNING, "recovery child")]),
        (1, "frs", "s", [(RUNNING, "child recovery child"), (SUCCESS, "child")]),
        # Retries are counted anew after the end.
        (1, "f", "s", [(FAILURE, "child recovery child"), (FAILURE, "child recovery child")]),
        (1, "fsfs", "s", [(SUCCESS, "child recovery child"), (SUCCESS, "child recovery child")]),
    ],
)
def test_recovery_node(
    nodes: ModuleType, retries: int, child: str, recovery: str, expected: list[tuple[Any, str]]
) -> None:
    node, log = recovery_node(nodes, retries, child, recovery)
    assert ticks(node, log, len(expected)) == expected


def test_a_halted_recovery_node_halts_what_runs_and_begins_with_its_child(nodes: ModuleType) -> None:
    node, log = recovery_node(nodes, 1, "f", "rs")
    ticks(node, log, 1)
    node.stop(INVALID)
    assert log == ["child", "recovery", "recovery halted"]
    assert ticks(node, log, 1) == [(FAILURE, "child recovery child")]


def round_robin(nodes: ModuleType, *scripts: str) -> tuple[Any, list[str]]:
    log: list[str] = []
    children = [Scripted(str(number), log, script) for number, script in enumerate(scripts, 1)]
    return nodes.RoundRobin("node", children), log


@pytest.mark.parametrize(
    ("scripts", "expected"),
    [
        # The children take turns, from tick to tick, and in a circle.
        ("s s s", [(SUCCESS, "1"), (SUCCESS, "2"), (SUCCESS, "3"), (SUCCESS, "1")]),
        # A child that fails passes its turn on in the same tick.
        ("f s s", [(SUCCESS, "1 2"), (SUCCESS, "3"), (SUCCESS, "1 2")]),
        ("s f f", [(SUCCESS, "1"), (SUCCESS, "2 3 1"), (SUCCESS, "2 3 1")]),
        # A running child keeps its turn.
        ("rrs s", [(RUNNING, "1"), (RUNNING, "1"), (SUCCESS, "1"), (SUCCESS, "2")]),
        ("rf s", [(RUNNING, "1"), (SUCCESS, "1 2"), (SUCCESS, "1 2")]),
        # The node fails when all children have failed, each once, and begins anew with the first.
        ("f f", [(FAILURE, "1 2"), (FAILURE, "1 2")]),
        ("sf f f", [(SUCCESS, "1"), (FAILURE, "2 3 1"), (FAILURE, "1 2 3")]),
        ("f rf", [(RUNNING, "1 2"), (FAILURE, "2")]),
    ],
)
def test_round_robin(nodes: ModuleType, scripts: str, expected: list[tuple[Any, str]]) -> None:
    node, log = round_robin(nodes, *scripts.split())
    assert ticks(node, log, len(expected)) == expected


def test_a_round_robin_that_is_halted_while_it_runs_begins_with_the_first_child(nodes: ModuleType) -> None:
    node, log = round_robin(nodes, "s", "r")
    ticks(node, log, 2)
    node.stop(INVALID)
    assert log == ["2", "2 halted"]
    assert ticks(node, log, 1) == [(SUCCESS, "1")]


def test_a_round_robin_keeps_its_turn_under_a_sequence_that_begins_anew(nodes: ModuleType) -> None:
    node, log = round_robin(nodes, "s", "rs")
    sequence = nodes.sequence("sequence", [Scripted("condition", log, "s"), node])
    expected = ["condition 1", "condition 2", "2", "condition 1"]
    assert [ticked for _, ticked in ticks(sequence, log, 4)] == expected


def test_each_goal_has_a_tree_of_its_own_which_halts_with_it(nodes: ModuleType) -> None:
    log: list[str] = []
    scripts = iter(("rs", "f", "r"))
    goal = nodes.NavigateWithRecovery("goal", lambda: Scripted("tree", log, next(scripts)))
    assert [status for status, _ in ticks(goal, log, 4)] == [RUNNING, SUCCESS, FAILURE, RUNNING]
    goal.stop(INVALID)
    assert log == ["tree", "tree halted"]


@pytest.mark.parametrize(
    ("code", "planner", "controller"),
    [
        (0, True, True),  # no code counts as unknown
        (9003, True, True),  # nor does the time-out of the whole goal say why
        (100, False, True),
        (105, False, True),
        (102, False, False),  # no transform
        (208, True, False),
        (206, False, False),  # the goal is occupied, and stays so
    ],
)
def test_error_codes_say_whether_recoveries_help(
    nodes: ModuleType, code: int, planner: bool, controller: bool
) -> None:
    result = SimpleNamespace(result=SimpleNamespace(error_code=code))
    way = SimpleNamespace(ended=SimpleNamespace(result=lambda: result))
    conditions = (
        nodes.would_a_planner_help(way),
        nodes.would_a_controller_help(way),
        nodes.would_any_help(way),
    )
    for condition in conditions:
        condition.tick_once()
    helps = [condition.status == SUCCESS for condition in conditions]
    assert helps == [planner, controller, planner or controller]


def test_recoveries_do_not_help_against_a_rejected_goal(nodes: ModuleType) -> None:
    condition = nodes.would_any_help(SimpleNamespace(ended=None))
    condition.tick_once()
    assert condition.status == FAILURE
