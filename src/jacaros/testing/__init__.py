"""Tests of agent programs and projects.

Names are imported on first use: pytest imports this package at every start, for `pytest_plugin`.
"""

from typing import TYPE_CHECKING

from jacaros.exports import exported

if TYPE_CHECKING:
    from jacaros.mas.embedding.running_agent import PursuedGoal
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
    )
    from jacaros.testing.trial import TrialOptions, run_suite

__all__ = [
    "ActionFailed",
    "AgentHarness",
    "AgentTest",
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
]

_MODULES = {
    "jacaros.mas.embedding.running_agent": "PursuedGoal",
    "jacaros.testing.harness": "AgentHarness",
    "jacaros.testing.paths": "Verdict judge",
    "jacaros.testing.recorded": "ActionFailed RecordedAct SentMessage",
    "jacaros.testing.run": "AgentTest Outcome Problem RunResult Suite SuiteOutcome "
    "collect run_project suite_of",
    "jacaros.testing.trial": "TrialOptions run_suite",
}

__getattr__ = exported(__name__, _MODULES)
