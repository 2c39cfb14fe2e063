"""What an operation costs, from the agent to the artifact and back, as JSON; the best of five runs."""

import json

import projects
from yardstick import call

COUNT = 20_000
ROUNDS = 5
PROGRAM = """
!start.
+!start <- makeArtifact("bench", "Bench", [], _); operate(0); !go(COUNT, OPERATION).
+!go(0, _) <- .stopMAS.
+!go(N, true) : N > 0 <- operate(N); !go(N - 1, true).
+!go(N, false) : N > 0 <- true; !go(N - 1, false).
"""
ARTIFACTS = """
from jacaros.artifacts import Artifact, operation

class Bench(Artifact):
    @operation
    def operate(self, number: int) -> None:
        self.number = number
"""


def seconds(operation: str) -> float:
    """Of processor time for all rounds, with the operation or without it."""
    program = PROGRAM.replace("COUNT", str(COUNT)).replace("OPERATION", operation)
    return projects.seconds("bench.asl", {"bench.asl": program, "artifacts.py": ARTIFACTS})


def main() -> None:
    """Measure: the same loop without the operation is taken off."""
    yardsticks = []
    best = {"true": 1e9, "false": 1e9}
    for _ in range(ROUNDS):
        for operation in best:
            yardsticks.append(call())
            best[operation] = min(best[operation], seconds(operation))
    trip = (best["true"] - best["false"]) / COUNT * 1e6
    print(json.dumps({"round_trip": trip, "goal": 20, "call": min(yardsticks)}))


if __name__ == "__main__":
    main()
