"""What an operation costs, from the agent to the artifact and back, as JSON; the best of three runs."""

import json
import tempfile
import time
from pathlib import Path
from typing import Any

from yardstick import call

from jacaros.testing import run_project

COUNT = 20_000
ROUNDS = 3
PROGRAM = """
!start.
+!start <- makeArtifact("bench", "Bench", [], _); operate(0); !go(COUNT, OPERATION).
+!go(0, _) <- .stopMAS.
+!go(N, true) : N > 0 <- operate(N); !go(N - 1, true).
+!go(N, false) : N > 0 <- true; !go(N - 1, false).
"""
ARTIFACTS = """
from jacaros.env import Artifact, operation

class Bench(Artifact):
    @operation
    def operate(self, number: int) -> None:
        self.number = number
"""


def seconds(operation: str) -> float:
    """Of processor time for all rounds, with the operation or without it."""
    began = 0.0

    def started(mas: Any) -> None:
        nonlocal began
        del mas
        began = time.process_time()

    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "bench.asl"
        source.write_text(
            PROGRAM.replace("COUNT", str(COUNT)).replace("OPERATION", operation), encoding="utf-8"
        )
        (Path(folder) / "artifacts.py").write_text(ARTIFACTS, encoding="utf-8")
        result = run_project(source, when_started=started)
    if result.exit_code or result.errors:
        raise SystemExit("\n".join(result.errors))
    return time.process_time() - began


def main() -> None:
    """Measure: the same loop without the operation is taken off."""
    yardstick = call()
    best = {"true": 1e9, "false": 1e9}
    for _ in range(ROUNDS):
        for operation in best:
            best[operation] = min(best[operation], seconds(operation))
    trip = (best["true"] - best["false"]) / COUNT * 1e6
    print(json.dumps({"round_trip": trip, "goal": 20, "call": yardstick}))


if __name__ == "__main__":
    main()
