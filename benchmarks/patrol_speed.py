"""The speed of the patrol on the virtual clock: simulated seconds per second of real time."""

import time
from pathlib import Path

from jacaros.testing import run_project

PATROL = Path(__file__).resolve().parent.parent / "examples" / "04_patrol" / "patrol.jcm"
RUNS = 3


def main() -> None:
    """Run the patrol several times, and print the best result."""
    speeds = []
    for _ in range(RUNS):
        began = time.perf_counter()
        result = run_project(PATROL)
        speeds.append(result.seconds / (time.perf_counter() - began))
    print(
        f"The patrol of the examples: {result.seconds:.0f} simulated seconds, {max(speeds):.0f} times as fast as life "
        f"on the virtual clock (best of {RUNS})."
    )


if __name__ == "__main__":
    main()
