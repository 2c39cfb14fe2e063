"""How many updates of a property a second reach the beliefs of ten agents, as JSON.

Each update is a step of its own.  In the first run, the agents have a plan for the event that is not applicable, as
when a sensor shows nothing of interest; in the second, a plan that is run.
"""

import json

import pieces
import projects

OBSERVERS = 10
UPDATES, PIECE = 12_000, 200
ARTIFACTS = f"""
import pieces
from jacaros.artifacts import Artifact, operation

class Ticker(Artifact):
    def init(self) -> None:
        self.define_property("tick", 0)

    @operation
    async def run(self) -> None:
        for first in range(0, {UPDATES}, {PIECE}):
            pieces.begin()
            for number in range(first, first + {PIECE}):
                self.update_property("tick", number)
                await self.sleep(0.001)
            pieces.end({PIECE})
"""
WATCHER = "!start. +!start <- focusWhenAvailable(ticker). +tick(N) : CONDITION <- true."
DRIVER = """
!start.
+!start <- makeArtifact("ticker", "Ticker", [], Id); .wait(10); run; .stopMAS.
"""
PROJECT = f"""
MAS bench {{ environment: jacaros.Environment agents: watcher watcher.asl #{OBSERVERS}; driver driver.asl; }}
"""


def measured(condition: str) -> tuple[float, float, float]:
    """What an update costs when that is the context of the plan (see `pieces.take`)."""
    watcher = WATCHER.replace("CONDITION", condition)
    files = {"watcher.asl": watcher, "driver.asl": DRIVER, "artifacts.py": ARTIFACTS, "bench.mas2j": PROJECT}
    projects.seconds("bench.mas2j", files)
    return pieces.take()


def main() -> None:
    """Measure."""
    update, call, calls = measured("N < 0")
    reaction, _, reaction_calls = measured("N >= 0")
    figures = {
        "observers": OBSERVERS,
        "update": update,
        "rate": 1e6 / update,
        "calls": calls,
        "reaction": reaction,
        "reaction_rate": 1e6 / reaction,
        "reaction_calls": reaction_calls,
        "goal": 10_000,
        "call": call,
    }
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
