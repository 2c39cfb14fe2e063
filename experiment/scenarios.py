"""The five scenarios of the experiment: what both sides run, where, and how a run is judged."""

import runpy
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

from jacaros.testing import RunResult, Verdict

FOLDER = Path(__file__).parent
EXAMPLES = FOLDER.parent / "examples"


class Scenario(NamedTuple):
    """A scenario.

    Attributes:
        project: project file of the agents.
        baseline: Python program that does the same.
        world: world file, or name of a shipped world; the project names the same.
        parameters: of the baseline's node.
        goal: what the checker is asked for, if it knows several.
    """

    project: Path
    baseline: Path
    world: str | Path
    parameters: Mapping[str, Any] = {}
    goal: str = ""

    def judge(self, result: RunResult, **limits: float) -> Verdict:
        """Judge a run of either side by the checker of the example, with limits that it takes."""
        folder = self.project.parents[1] if self.goal else self.project.parent
        checker = runpy.run_path(str(folder / "check.py"))
        output = () if self.world != WEAK_BATTERY else (result.lines,)
        goal = (checker["GOALS"][self.goal],) if self.goal else ()
        verdict: Verdict = checker["check"](*output, result.ground_truth, *goal, **limits)
        return verdict


WEAK_BATTERY = EXAMPLES / "03_fake_battery" / "weak_battery.yaml"
"""World of the scenario that is judged by output, too: it is about reporting."""


def _scenario(
    name: str, project: str, world: str | Path, parameters: Mapping[str, Any] | None = None
) -> tuple[str, Scenario]:
    return name, Scenario(EXAMPLES / project, FOLDER / "baseline" / f"{name}.py", world, parameters or {})


SCENARIOS = dict(
    [
        _scenario("out_and_back", "01_out_and_back/turtlebot4.jcm", "empty"),
        _scenario("square", "02_square/turtlebot4.jcm", "empty"),
        _scenario("fake_battery", "03_fake_battery/robot_battery.jcm", WEAK_BATTERY, {"source": "robot"}),
        _scenario("patrol", "04_patrol/turtlebot4.jcm", EXAMPLES / "04_patrol" / "patrol.yaml"),
        _scenario("house_cleaning", "05_house_cleaning/turtlebot4.jcm", "house"),
    ]
)
"""The scenarios by the names of their baselines."""

WORKSHOP = FOLDER / "workshop"
FETCH = Scenario(WORKSHOP / "1_fetch" / "fetch.jcm", FOLDER, WORKSHOP / "building.yaml", goal="1_fetch")
"""A setting of the workshop, with a gripper; it has no baseline."""

FURTHER_SCENARIOS = {
    **{name: each for name, each in SCENARIOS.items() if name != "fake_battery"},
    "fetch": FETCH,
}
"""The scenarios of the further runs: the robot drives."""
