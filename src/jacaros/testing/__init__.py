"""For tests of agent programs and projects."""

from jacaros.testing.judging import Verdict, judge
from jacaros.testing.run import RunResult, run_project

__all__ = ["RunResult", "Verdict", "judge", "run_project"]
