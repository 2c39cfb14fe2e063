"""How many updates of a property a second reach the beliefs of ten agents, as JSON; the best of three runs."""

import json
import tempfile
import time
from pathlib import Path
from typing import Any

from yardstick import call

from jacaros.testing import run_project

OBSERVERS = 10
UPDATES = 5000
ROUNDS = 3
ARTIFACTS = """
from jacaros.env import Artifact, operation

class Ticker(Artifact):
    def init(self) -> None:
        self.define_property("tick", 0)

    @operation
    async def run(self, count: int) -> None:
        for number in range(count):
            self.update_property("tick", number)
            await self.sleep(0.001)
        self.signal("over")
"""
WATCHER = "!start. +!start <- focusWhenAvailable(ticker). +tick(N) : N < 0 <- true."
DRIVER = """
!start.
+!start <- makeArtifact("ticker", "Ticker", [], Id); .wait(10); run(COUNT); .stopMAS.
"""


def seconds(count: int) -> float:
    """Of processor time for so many updates, each in a step of its own."""
    began = 0.0

    def started(mas: Any) -> None:
        nonlocal began
        del mas
        began = time.process_time()

    with tempfile.TemporaryDirectory() as folder:
        files = {
            "watcher.asl": WATCHER,
            "driver.asl": DRIVER.replace("COUNT", str(count)),
            "artifacts.py": ARTIFACTS,
            "bench.mas2j": "MAS bench { environment: jacaros.Environment "
            f"agents: watcher watcher.asl #{OBSERVERS}; driver driver.asl; }}",
        }
        for name, text in files.items():
            (Path(folder) / name).write_text(text, encoding="utf-8")
        result = run_project(Path(folder) / "bench.mas2j", when_started=started)
    if result.exit_code or result.errors:
        raise SystemExit("\n".join(result.errors))
    return time.process_time() - began


def main() -> None:
    """Measure: what few updates cost is taken off, and with it the start."""
    yardstick = call()
    few, many = (min(seconds(count) for _ in range(ROUNDS)) for count in (UPDATES // 10, UPDATES))
    update = (many - few) / (UPDATES - UPDATES // 10) * 1e6
    figures = {
        "observers": OBSERVERS,
        "update": update,
        "rate": 1e6 / update,
        "goal": 10_000,
        "call": yardstick,
    }
    print(json.dumps(figures))


if __name__ == "__main__":
    main()
