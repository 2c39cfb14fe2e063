"""Tests of agent programs and projects.

Names are imported on first use: pytest imports this package at every start, for `pytest_plugin`.
"""

from typing import TYPE_CHECKING

from jacaros.runtime.exports import exported

if TYPE_CHECKING:
    from jacaros.runtime.mas.embedding.running_agent import PursuedGoal
    from jacaros.testing.harness import ActionFailed, AgentHarness, RecordedAct, SentMessage
    from jacaros.testing.paths import Verdict, judge
    from jacaros.testing.run import RunResult, run_project

__all__ = [
    "ActionFailed",
    "AgentHarness",
    "PursuedGoal",
    "RecordedAct",
    "RunResult",
    "SentMessage",
    "Verdict",
    "judge",
    "run_project",
]

_MODULES = {
    "jacaros.runtime.mas.embedding.running_agent": "PursuedGoal",
    "jacaros.testing.harness": "ActionFailed AgentHarness RecordedAct SentMessage",
    "jacaros.testing.paths": "Verdict judge",
    "jacaros.testing.run": "RunResult run_project",
}

__getattr__ = exported(__name__, _MODULES)
