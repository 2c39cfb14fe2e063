"""Judging a run by what truly happened: the frame of a scenario's checker.

A checker is a function from a ground truth to a `Verdict`; it takes what an agent believes or prints for
nothing.  As a program it is::

    def check(truth: GroundTruth) -> Verdict:
        verdict = Verdict()
        verdict.measure("metres driven", truth.odometer())
        verdict.expect(truth.odometer() > 1.0, "the robot did not drive")
        return verdict

    if __name__ == "__main__":
        sys.exit(judge(check, sys.argv[1:]))
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from jacaros.errors import JacarosError
from jacaros.sim.ground_truth import GroundTruth


@dataclass(slots=True)
class Verdict:
    """What a checker found.

    Attributes:
        complaints: what is not as it should be; empty when the run passes.
        measured: figures for people, by what they are.
    """

    complaints: list[str] = field(default_factory=list)
    measured: dict[str, float] = field(default_factory=dict)

    @property
    def passed(self) -> bool:
        """True when there is nothing to complain about."""
        return not self.complaints

    def expect(self, condition: bool, complaint: str) -> None:
        """Complain unless the condition holds."""
        if not condition:
            self.complaints.append(complaint)

    def measure(self, what: str, value: float) -> float:
        """Take note of a figure, and give it back."""
        self.measured[what] = value
        return value

    def at_most(self, what: str, value: float, limit: float) -> None:
        """Take note of a figure, and complain when it is greater than *limit*."""
        self.measure(what, value)
        self.expect(value <= limit, f"{what}: {value:.4g}, more than {limit:g}")

    def lines(self) -> list[str]:
        """The verdict for people."""
        figures = [f"{what}: {value:.4g}" for what, value in self.measured.items()]
        if self.passed:
            return [*figures, "passed"]
        return [*figures, *(f"FAILED: {complaint}" for complaint in self.complaints)]


def judge(check: Callable[[GroundTruth], Verdict], arguments: Sequence[str]) -> int:
    """The main program of a checker: judge the ground truth file that is the only argument.

    Returns:
        The exit code: 0 passed, 1 failed or no ground truth file, 2 wrong usage.
    """
    if len(arguments) != 1:
        print(
            "usage: check.py GROUND_TRUTH_FILE    (written by jacaros run --ground-truth GROUND_TRUTH_FILE)"
        )
        return 2
    try:
        verdict = check(GroundTruth.read(arguments[0]))
    except (OSError, ValueError, JacarosError) as error:
        print(f"{arguments[0]} cannot be judged: {error}")
        return 1
    print("\n".join(verdict.lines()))
    return 0 if verdict.passed else 1
