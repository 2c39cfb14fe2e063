"""Judge whether the agent reported every state of the battery, in order and at the right level.

Judged from the agent's output; with a ground truth file, also from the robot's battery::

    python check.py OUTPUT_FILE [GROUND_TRUTH_FILE]
"""

import re
import sys
from collections.abc import Iterable
from pathlib import Path

from jacaros.robots.world import GroundTruth
from jacaros.testing import Verdict

STATES = ((100, "Full Battery"), (50, "Medium Battery"), (20, "Low Battery"), (0, "empty"))
"""States of the battery, each with the percentage at which the agent must report it."""


def check(output: Iterable[str], truth: GroundTruth | None = None) -> Verdict:
    """Judge the lines of the output and, with *truth*, the level of the robot's battery.

    The states of a timer battery must be reported at exactly the right percentage.  A robot publishes its battery
    once a second, so these reports may be one percent late.
    """
    verdict = Verdict()
    told = [match for line in output if (match := re.fullmatch(r"\[\w+\] (\d+) %: (.+)", line.rstrip()))]
    states = [match.group(2) for match in told]
    wanted = [state for _, state in STATES]
    verdict.expect(states == wanted, f"the states are {states}, not {wanted}")
    late = 0 if truth is None else 1
    for match, (level, state) in zip(told, STATES, strict=False):
        percent = int(match.group(1))
        verdict.measure(f"percent at '{state}'", percent)
        verdict.expect(level - late <= percent <= level, f"'{state}' reported at {percent} %, not {level} %")
    if truth is not None:
        levels = [event.data["level"] for event in truth.events_of("battery", "battery_empty")]
        # The agent sees whole percentages only, so it may end the run with half a percent left.
        expected = [*range(99, -1, -1)]
        verdict.expect(levels in (expected, expected[:-1]), f"the battery went through {levels}")
    return verdict


def main(arguments: list[str]) -> int:
    """Judge the files named on the command line; return the exit code."""
    if not 1 <= len(arguments) <= 2:
        print(__doc__)
        return 2
    output = Path(arguments[0]).read_text(encoding="utf-8").splitlines()
    verdict = check(output, GroundTruth.read(arguments[1]) if arguments[1:] else None)
    print("\n".join(verdict.lines()))
    return 0 if verdict.passed else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
