"""For tests of agent programs and projects."""

from jacaros.testing.run import RunResult, run_project

__all__ = ["RunResult", "run_project"]
