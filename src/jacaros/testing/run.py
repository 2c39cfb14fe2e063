"""Running a whole project inside a test, on virtual time."""

from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, Final

from jacaros.errors import JacarosError
from jacaros.mas.deployment import Deployment
from jacaros.mas.launch import launch
from jacaros.mas.options import RunOptions
from jacaros.mas.system import System

TEST_RUN: Final = RunOptions(fast=True, seed=0, keep_ground_truth=True)
"""The options of a run in a test."""


@dataclass(slots=True)
class RunResult:
    """What a run did.

    Attributes:
        lines: the agents' output, as ``[agent] text``.
        errors: everything else that was told, warnings and logs.
        exit_code: what the ``jacaros`` command would have ended with.
        seconds: how long it took on its own clock.
        ground_truth: what truly happened in the embedded world (`jacaros.sim.GroundTruth`); None without one.
    """

    lines: list[str] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    exit_code: int = 0
    seconds: float = 0.0
    ground_truth: Any = None

    def of(self, agent: str) -> list[str]:
        """What one agent printed, without its name."""
        prefix = f"[{agent}] "
        return [line.removeprefix(prefix) for line in self.lines if line.startswith(prefix)]

    # The port of a run's console.

    def print(self, agent: str, text: str) -> None:
        """Take a line of an agent's output."""
        self.lines.append(f"[{agent}] {text}")

    def log(self, text: str, level: str = "info") -> None:
        """Take a line for people."""
        self.errors.append(text)


def run_project(
    project: str | Path | Deployment,
    options: RunOptions = TEST_RUN,
    *,
    when_started: Callable[[System], None] | None = None,
    **changes: Any,
) -> RunResult:
    """Run a project as ``jacaros run`` does.

    Mistakes of programs and projects do not raise: they are among the `RunResult.errors`, with exit code 1.

    Args:
        project: a project file, a lone program, or a deployment.
        options: how; on the virtual clock with seed 0 unless given.
        when_started: called with the run before its first agent has its turn.
        changes: single fields of `RunOptions` in place of those of *options*, such as ``until_idle=True, seconds=60``.

    Raises:
        TypeError: `RunOptions` has no such field.
        InternalError: a defect of JaCaROS showed itself.
    """
    result = RunResult()
    options = replace(options, **changes)
    held: list[tuple[System, float]] = []

    def started(mas: System) -> None:
        held.append((mas, mas.clock.now()))
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
