"""How many times faster than life the patrol runs on the virtual clock: simulated seconds per wall second."""

import time
from pathlib import Path

from jacaros.testing import run_project

PATROL = Path(__file__).resolve().parent.parent / "examples" / "04_patrol" / "patrol.jcm"
RUNS = 3


def main() -> None:
    """Run it a few times, and print the best."""
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
