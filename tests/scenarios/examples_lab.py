"""The examples in tests: run in this process, judged by their own checkers, and falsified."""

import importlib.util
import shutil
import time
from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace
from functools import cache
from pathlib import Path
from types import ModuleType

from jacaros.robots.world import GroundTruth, PathSample, RobotEvent
from jacaros.runtime.mas.deployment import Deployment
from jacaros.runtime.mas.launch import launch, load_deployment
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.system import System
from jacaros.testing import RunResult, Verdict, run_project

EXAMPLES = Path(__file__).parents[2] / "examples"

PROJECTS = (
    "01_out_and_back/out_and_back.jcm",
    "02_square/square.jcm",
    "03_fake_battery/fake_battery.jcm",
    "03_fake_battery/robot_battery.jcm",
    "04_patrol/patrol.jcm",
    "05_house_cleaning/house_cleaning.jcm",
    "07_shared_robot/shared_robot.jcm",
    "08_parcels/parcels.jcm",
    "09_three_robots/three_robots.jcm",
    "10_explore/explore.jcm",
)

LONGEST = 3000.0
"""Seconds of the virtual clock after which a scenario that should have ended by itself is ended."""


def checker(folder: str) -> ModuleType:
    """The module ``check.py`` of an example."""
    path = EXAMPLES / folder / "check.py"
    spec = importlib.util.spec_from_file_location(f"check_{folder}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@cache
def run_of(project: str) -> RunResult:
    """The run of an example, made once. It must end without warnings."""
    return run(project)


def truth_of(project: str) -> GroundTruth:
    """What truly happened in the run of an example."""
    truth: GroundTruth = run_of(project).ground_truth
    return truth


def passed(verdict: Verdict) -> Verdict:
    """Print a verdict and expect no complaints."""
    print(*verdict.lines(), sep="\n")
    assert verdict.complaints == []
    return verdict


def unexpected(errors: Sequence[str]) -> list[str]:
    """Return the messages of a run but for the advice to robots that drive by odometry."""
    return [each for each in errors if "odometry and localisation have drifted" not in each]


def run(project: str, beliefs: str = "", world: Path | None = None, seed: int = 0) -> RunResult:
    """Run an example whose agent has further beliefs, or in another world."""
    began = time.perf_counter()
    result = run_project(example(project, beliefs), seed=seed, world=world, seconds=LONGEST)
    took = time.perf_counter() - began
    print(
        f"{project}: {result.seconds:.1f} simulated seconds in {took:.2f} s, {result.seconds / took:.0f} times as fast"
    )
    assert unexpected(result.errors) == []
    assert result.exit_code == 0
    assert result.seconds < LONGEST
    return result


def example(project: str, beliefs: str) -> Deployment:
    """An example whose agent has further beliefs."""
    deployment = load_deployment(EXAMPLES / project)
    if not beliefs:
        return deployment
    return replace(deployment, agents=(replace(deployment.agents[0], beliefs=beliefs),))


def spoilt(folder: Path, project: str, old: str, new: str, program: str = "robot.asl") -> Path:
    """Copy an example with one change in its program. Return the copied project file."""
    original = EXAMPLES / project
    copy = folder / "example"
    shutil.copytree(original.parent, copy)
    path = copy / program
    text = path.read_text(encoding="utf-8")
    assert text.count(old) == 1
    path.write_text(text.replace(old, new), encoding="utf-8")
    return copy / original.name


class Stop:
    """The console of a run that ends when an agent prints a certain text.

    Attributes:
        doing: what the robot truly did then: ``driving``, ``turning`` or ``standing``.
    """

    def __init__(self, beginning: str) -> None:
        self.doing = "nothing"
        self._beginning = beginning
        self._mas: System | None = None

    def begin(self, mas: System) -> None:
        """Take the run."""
        self._mas = mas

    def print(self, agent: str, text: str) -> None:
        """Look at the robot and end the run if this is the text."""
        if text.startswith(self._beginning):
            assert self._mas is not None
            assert self._mas.ros.world is not None
            robot = self._mas.ros.world.robot()
            turning = "turning" if abs(robot.turn_rate) > 0.1 else "standing"
            self.doing = "driving" if abs(robot.speed) > 0.05 else turning
            self._mas.end(0)

    def log(self, text: str, level: str = "info") -> None:
        """Nothing is to be said."""
        raise AssertionError(text)


def doing_at(beginning: str, project: str, beliefs: str, world: Path) -> str:
    """What the robot truly does when its agent prints a text with this *beginning* for the first time."""
    console = Stop(beginning)
    options = RunOptions(fast=True, seed=0, world=world, seconds=LONGEST)
    launch(example(project, beliefs), options, console, console.begin, own_process=False)
    return console.doing


def world_with(folder: Path, original: Path, old: str, new: str) -> Path:
    """A world file that differs from another one in one place."""
    text = original.read_text(encoding="utf-8")
    assert text.count(old) == 1
    path = folder / original.name
    path.write_text(text.replace(old, new), encoding="utf-8")
    return path


def falsified(
    truth: GroundTruth,
    sample: Callable[[PathSample], PathSample | None] = lambda sample: sample,
    event: Callable[[RobotEvent], RobotEvent | None] = lambda event: event,
    more: Iterable[RobotEvent] = (),
) -> GroundTruth:
    """A ground truth in which something else happened.

    Args:
        truth: what happened.
        sample, event: what becomes of each sample and each event; None leaves it out.
        more: events that are put in.
    """
    false = GroundTruth(truth.robots, truth.world)
    for robot in truth.robots:
        for true in [*truth.path(robot), truth.latest(robot)]:
            if (changed := sample(true)) is not None:
                false.record_sample(robot, changed)
    kept = [changed for true in truth.events if (changed := event(true)) is not None]
    for each in sorted([*kept, *more], key=lambda event: event.time):
        false.record_event(each)
    return false
