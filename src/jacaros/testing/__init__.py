"""Tests of agent programs and projects.

Names are imported on first use: pytest imports this package at every start, for `pytest_plugin`.
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jacaros.mas.embedding.running_agent import PursuedGoal
    from jacaros.testing.fake_graph import FakeGraph
    from jacaros.testing.harness import AgentHarness
    from jacaros.testing.paths import Verdict, judge
    from jacaros.testing.recorded import ActionFailed, RecordedAct, SentMessage
    from jacaros.testing.run import (
        AgentTest,
        Outcome,
        Problem,
        RunResult,
        Suite,
        SuiteOutcome,
        collect,
        run_project,
        suite_of,
        write_junit,
    )
    from jacaros.testing.trial import TrialOptions, run_suite

__all__ = [
    "ActionFailed",
    "AgentHarness",
    "AgentTest",
    "FakeGraph",
    "Outcome",
    "Problem",
    "PursuedGoal",
    "RecordedAct",
    "RunResult",
    "SentMessage",
    "Suite",
    "SuiteOutcome",
    "TrialOptions",
    "Verdict",
    "collect",
    "judge",
    "run_project",
    "run_suite",
    "suite_of",
    "write_junit",
]

_MODULES = {
    "fake_graph": ("FakeGraph",),
    "harness": ("AgentHarness", "PursuedGoal"),
    "outcomes": ("Outcome", "Problem", "SuiteOutcome", "write_junit"),
    "paths": ("Verdict", "judge"),
    "recorded": ("ActionFailed", "RecordedAct", "SentMessage"),
    "run": ("RunResult", "run_project"),
    "suites": ("AgentTest", "Suite", "collect", "suite_of"),
    "trial": ("TrialOptions", "run_suite"),
}
_HOME = {name: module for module, names in _MODULES.items() for name in names}


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module {__name__} has no attribute {name}")
    value: object = getattr(import_module(f"{__name__}.{_HOME[name]}"), name)
    globals()[name] = value
    return value
