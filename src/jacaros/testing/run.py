"""Running a whole project inside a test, on virtual time."""

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jacaros.errors import JacarosError
from jacaros.mas.deployment import Deployment
from jacaros.mas.launch import launch
from jacaros.mas.options import RunOptions
from jacaros.mas.system import System

if TYPE_CHECKING:
    from jacaros.ros.parameter import ParameterValue


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
    *,
    seed: int | None = 0,
    world: str | Path | None = None,
    seconds: float | None = None,
    until_idle: bool = False,
    fail_on_lost_goal: bool = False,
    fast: bool = True,
    ros: str = "memory",
    mappings: Iterable[str | Path] = (),
    remap: Mapping[str, str] | None = None,
    parameters: "Mapping[str, ParameterValue] | None" = None,
    namespace: str = "",
    when_started: Callable[[System], None] | None = None,
) -> RunResult:
    """Run a project as ``jacaros run`` does, on the virtual clock unless told otherwise.

    Mistakes of programs and projects do not raise: they are among the `RunResult.errors`, with exit code 1.

    Args:
        project: a project file, a lone program, or a deployment.
        seed: of all random numbers.
        world: world file or name in place of the project's own.
        seconds: end after so many seconds of the run's clock.
        until_idle: end when no agent has anything to do.
        fail_on_lost_goal: the exit code is 1 instead of 0 if a goal failed and no plan took over.
        fast: on the virtual clock.
        ros: kind of the ROS graph.
        mappings: mapping files whose artifacts are made at the start.
        remap: ROS names to use in place of others.
        parameters: values of parameters of our node, in place of the defaults.
        namespace: put before relative ROS names.
        when_started: called with the run before its first agent has its turn.

    Raises:
        InternalError: a defect of JaCaROS showed itself.
    """
    result = RunResult()
    options = RunOptions(
        fast=fast,
        seed=seed,
        ros=ros,
        world=world,
        keep_ground_truth=True,
        until_idle=until_idle,
        fail_on_lost_goal=fail_on_lost_goal,
        seconds=seconds,
        mappings=tuple(map(str, mappings)),
        remap=dict(remap or {}),
        parameters=dict(parameters or {}),
        namespace=namespace,
    )
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
