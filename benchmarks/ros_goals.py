"""Goals over ROS under load: what is lost, how long goals take, and what the agents' own work loses.

    python benchmarks/ros_goals.py --ros memory --rate 500 --seconds 60 --watchers 100

The agents of the run count fifty times a second. Meanwhile another node gives one of them goals at a rate, and others
watch the count. On a real graph the run is a process of its own, and so is this client.
"""

import argparse
import asyncio
import gc
import json
import os
import resource
import subprocess
import sys
import tempfile
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from statistics import median
from typing import Any

import jacaros
from jacaros import Mas
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.qos import LATCHED
from jacaros.runtime.clock import clock_of
from jacaros.runtime.mas.launch import GARBAGE_THRESHOLD
from jacaros.serving.ros.door import RosDoor

ACHIEVE = "jacaros_interfaces/action/Achieve"
PROGRAM = """
{ offer(goal, add(n(number), m(out(number))), at_most(any)) }
{ offer(belief, count(n(number))) }
count(0).
!tick.
+!tick <- .wait(20); ?count(N); -+count(N + 1); !!tick.
+!add(N, N + 1).
"""
WARM_UP = 5.0


def used(process: int | str = "self") -> float:
    """Return the megabytes that a process uses."""
    pages = int(Path(f"/proc/{process}/statm").read_text().split()[1])
    return pages * resource.getpagesize() / 1e6


def processor_seconds(process: int | str) -> float:
    """Return the processor time that a process has used."""
    fields = Path(f"/proc/{process}/stat").read_text().rpartition(")")[2].split()
    return (int(fields[11]) + int(fields[12])) / os.sysconf("SC_CLK_TCK")


class Load:
    """Goals at a rate, and what became of them.

    Args:
        node: gives the goals.
        agent: takes them.
    """

    def __init__(self, node: Any, agent: str) -> None:
        self._client = node.action_client(f"{agent}/add", ACHIEVE)
        self._clock = clock_of(asyncio.get_running_loop())
        self.sent = 0
        self.ends: Counter[str] = Counter()
        self.took: list[float] = []

    async def give(self, rate: float, seconds: float) -> None:
        """Give goals, and wait for their ends."""
        begun, tasks = self._clock.elapsed, set[asyncio.Task[None]]()
        while (passed := self._clock.elapsed - begun) < seconds:
            while self.sent < passed * rate:
                task = asyncio.get_running_loop().create_task(self._one(self.sent))
                tasks.add(task)
                task.add_done_callback(tasks.discard)
                self.sent += 1
            await self._clock.sleep(0.005)
        if tasks:
            await asyncio.wait(tasks, timeout=30)

    async def _one(self, number: int) -> None:
        began = self._clock.elapsed
        try:
            goal = await self._client.send({"goal": f"[{number}]"}, timeout=20)
            outcome = await goal.outcome(timeout=20)
            right = json.loads(outcome.result.results or "{}") == {"m": number + 1}
            self.ends["achieved" if right else outcome.result.state] += 1
            self.took.append(self._clock.elapsed - began)
        except Exception as error:
            self.ends[type(error).__name__] += 1


class Watchers:
    """Nodes that watch the count."""

    def __init__(self, nodes: list[Any], agent: str) -> None:
        self.counts = [0.0] * len(nodes)
        for number, node in enumerate(nodes):
            node.subscription(f"{agent}/count", "std_msgs/msg/String", self._taker(number), LATCHED)

    def _taker(self, number: int) -> Callable[[Any], None]:
        def take(sample: Any) -> None:
            self.counts[number] = json.loads(sample.message.data)[-1]["n"]

        return take

    def report(self) -> str:
        """Return how many of them know the newest count."""
        newest = max(self.counts)
        return f"{sum(newest - each <= 10 for each in self.counts)} of {len(self.counts)} watchers up to date"


async def measure(nodes: list[Any], given: argparse.Namespace, process: int | str = "self") -> None:
    """Give goals, and print the figures."""
    clock, watchers, load = (
        clock_of(asyncio.get_running_loop()),
        Watchers(nodes, "robot"),
        Load(nodes[0], "robot"),
    )
    await load.give(10.0, WARM_UP)
    count, began, before = max(watchers.counts), clock.elapsed, used(process)
    await clock.sleep(WARM_UP)
    alone = (max(watchers.counts) - count) / (clock.elapsed - began)
    load.sent, load.took = 0, []
    load.ends.clear()
    count, began, worked = max(watchers.counts), clock.elapsed, processor_seconds(process)
    await load.give(given.rate, given.seconds)
    seconds, worked = clock.elapsed - began, processor_seconds(process) - worked
    ticks = (max(watchers.counts) - count) / seconds
    took = sorted(load.took) or [0.0]
    print(f"{load.sent} goals in {seconds:.1f} s ({load.sent / seconds:.0f}/s): {dict(load.ends)}")
    print(
        f"a goal takes {1e3 * median(took):.1f} ms, 99 % take {1e3 * took[len(took) * 99 // 100]:.1f} ms at most"
    )
    share, each = 100 * worked / seconds, 1e3 * worked / max(1, load.sent)
    print(f"the run used {share:.0f} % of a processor, {each:.2f} ms for each goal")
    print(f"ticks of the agent: {ticks:.1f}/s, without load {alone:.1f}/s")
    print(f"memory of the run: {before:.0f} MB before, {used(process):.0f} MB after; {watchers.report()}")


async def in_memory(given: argparse.Namespace) -> None:
    """Measure in one process."""
    async with Mas(world="none", on_log=lambda *_: None) as mas:
        mas.add_agent("robot", PROGRAM)
        gc.set_threshold(GARBAGE_THRESHOLD, 20, 100)  # as `jacaros run` does
        gc.freeze()
        RosDoor(mas.system)
        nodes = [mas.system.ros.companion(f"watcher_{number}") for number in range(max(1, given.watchers))]
        await measure(nodes, given)


@contextmanager
def running(file: Path, kind: str) -> Iterator[subprocess.Popen[bytes]]:
    """Run the agents in a process of their own."""
    file.write_text(PROGRAM, encoding="utf-8")
    run = subprocess.Popen([sys.executable, "-m", "jacaros", "run", str(file), "--ros", kind, "--offer"])
    try:
        yield run
    finally:
        run.terminate()
        run.wait()


async def on_graph(given: argparse.Namespace) -> None:
    """Measure a run in a process of its own."""
    with tempfile.TemporaryDirectory() as folder, running(Path(folder, "robot.asl"), given.ros) as run:
        clock = clock_of(asyncio.get_running_loop())
        nodes = [
            open_backend(given.ros, clock, f"watcher_{number}") for number in range(max(1, given.watchers))
        ]
        try:
            for node in nodes:
                await node.start()
            await measure(nodes, given, run.pid)
        finally:
            for node in nodes:
                await node.close()


def main() -> None:
    """Measure as the command line says."""
    parser = argparse.ArgumentParser(description="Measure goals over ROS under load.")
    parser.add_argument("--ros", default="memory", choices=("memory", "ros1", "ros2", "rosbridge"))
    parser.add_argument("--rate", type=float, default=500.0, help="goals per second")
    parser.add_argument("--seconds", type=float, default=60.0)
    parser.add_argument("--watchers", type=int, default=100, help="nodes that watch a belief")
    given = parser.parse_args()
    jacaros.run(in_memory(given) if given.ros == "memory" else on_graph(given))


if __name__ == "__main__":
    main()
