"""Run 1,000 agents in one thread, and 500 in each of two threads, and compare the time by the clock.

    python benchmarks/mind/threads.py [ROUNDS]

Two threads gain something only on a free-threaded Python (``python3.13t`` with PYTHON_GIL=0).
"""

import asyncio
import sys
import threading
import time

from jacaros import Mas

AGENTS, STEPS = 1_000, 100
PROGRAM = """
+!work(0).
+!work(N) : N > 0 <- -+left(N); ?left(M); +done(M mod 7); !work(M - 1).
"""


def run(agents: int, begin: threading.Barrier) -> None:
    """Run a system until each of its agents has worked; all systems begin at once."""

    async def main() -> None:
        async with Mas(seed=1) as mas:
            made = [mas.add_agent(f"a{number}", PROGRAM) for number in range(agents)]
            await asyncio.gather(*(agent.achieve("work(1)") for agent in made))
            begin.wait()
            await asyncio.gather(*(agent.achieve(f"work({STEPS})") for agent in made))

    asyncio.run(main())


def seconds(threads: int) -> tuple[float, float]:
    """Return the seconds by the clock, and of processor time, that all agents take in that number of threads."""
    begin = threading.Barrier(threads + 1)
    running = [threading.Thread(target=run, args=(AGENTS // threads, begin)) for _ in range(threads)]
    for thread in running:
        thread.start()
    begin.wait()
    began, spent = time.perf_counter(), time.process_time()
    for thread in running:
        thread.join()
    return time.perf_counter() - began, time.process_time() - spent


def main(rounds: int) -> None:
    """Measure alternately, and print the best of each, since other processes can only slow a run down."""
    taken: dict[int, list[tuple[float, float]]] = {1: [], 2: []}
    for _ in range(rounds):
        for threads, each in taken.items():
            each.append(seconds(threads))
    gil = getattr(sys, "_is_gil_enabled", lambda: True)()
    print(f"{sys.version.split()[0]}, {'with' if gil else 'without'} the GIL, {AGENTS:,} agents")
    for threads, each in taken.items():
        clock, processor = (min(times) for times in zip(*each, strict=True))
        print(f"  {threads} threads: {clock:.2f} s by the clock, {processor:.2f} s of processor time")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 5)
