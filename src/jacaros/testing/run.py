"""Run a whole project in a test, on virtual time."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from jacaros.runtime.errors import JacarosError
from jacaros.runtime.mas.deployment import Deployment
from jacaros.runtime.mas.launch import launch
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System

TEST_RUN: Final = RunOptions(fast=True, seed=0, keep_ground_truth=True)
"""Default options of a run in a test."""


@dataclass(slots=True)
class RunResult:
    """The result of a run.

    Attributes:
        lines: output of agents, as ``[agent] text``.
        errors: other output: errors, warnings and log lines.
        timed: both, in order, each with its seconds on the clock of the run.
        exit_code: exit code that the ``jacaros`` command would return.
        seconds: duration on the clock of the run.
        ground_truth: ground truth of the embedded world (`jacaros.robots.world.GroundTruth`); None without a world.
    """

    lines: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    timed: list[tuple[float, str]] = field(default_factory=list)
    exit_code: int = 0
    seconds: float = 0.0
    ground_truth: Any = None
    now: Callable[[], float] = field(default=lambda: 0.0, repr=False, compare=False)

    def of(self, agent: str) -> list[str]:
        """Return the output of one agent, without its name."""
        prefix = f"[{agent}] "
        return [line.removeprefix(prefix) for line in self.lines if line.startswith(prefix)]

    # The port of a run's console.

    def print(self, agent: str, text: str) -> None:
        """Record a line of an agent's output."""
        self.lines.append(f"[{agent}] {text}")
        self.timed.append((self.now(), self.lines[-1]))

    def log(self, text: str, level: str = "info") -> None:
        """Record a log line."""
        self.errors.append(text)
        self.timed.append((self.now(), text))


def run_project(
    project: str | Path | Deployment,
    options: RunOptions = TEST_RUN,
    *,
    when_started: Callable[[System], None] | None = None,
    **changes: Any,
) -> RunResult:
    """Run a project, as ``jacaros run`` does.

    Errors in programs and projects do not raise: they are in `RunResult.errors`, and the exit code is 1.

    Args:
        project: a project file, a program, or a deployment.
        options: options of the run (default: virtual clock, seed 0).
        when_started: called with the run before the first agent reasons.
        changes: fields of `RunOptions` that override those of *options*, such as ``until_idle=True, seconds=60``.

    Raises:
        TypeError: `RunOptions` has no such field.
        InternalError: JaCaROS has a defect.
    """
    result = RunResult()
    options = replace(options, **changes)
    held: list[tuple[System, float]] = []

    def started(mas: System) -> None:
        began = mas.clock.now()
        held.append((mas, began))
        result.now = lambda: mas.clock.now() - began
        if when_started is not None:
            when_started(mas)

    try:
        result.exit_code = launch(project, options, result, started, own_process=False)
    except JacarosError as wrong:
        result.errors.append(str(wrong))
        result.exit_code = 1
    for mas, began in held:
        result.seconds = mas.clock.now() - began
        result.ground_truth = mas.ros.world.ground_truth if mas.ros.world is not None else None
    return result
