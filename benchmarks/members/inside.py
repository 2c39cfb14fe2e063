"""What a message between two agents of this process costs, in microseconds of processor time: the best of some runs.

inside.py COUNT RUNS

With PYTHONPATH, it measures the source code of another version: ``fleet.py inside --before FOLDER``.
"""

import json
import sys
import time

import jacaros
from jacaros import Mas

PROGRAM = """
+!ping(N)[source(S)] <- .send(S, achieve, pong(N)).
+!pong(N) : N > 0 <- .send(bob, achieve, ping(N - 1)).
+!pong(0) <- +finished.
"""


async def main(count: int, runs: int) -> None:
    """Measure."""
    best = float("inf")
    async with Mas(name="inside") as mas:
        ann = mas.add_agent("ann", PROGRAM)
        mas.add_agent("bob", PROGRAM)
        for _ in range(runs):
            began = time.process_time()
            ann.achieve(f"pong({count})")
            await ann.until("finished", timeout=60)
            best = min(best, time.process_time() - began)
            ann.remove_belief("finished")
    print(json.dumps([best / count / 2 * 1e6]))


if __name__ == "__main__":
    jacaros.run(main(int(sys.argv[1]), int(sys.argv[2])))
