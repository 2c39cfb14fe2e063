"""Load on what agents offer: goals per second from one session, and sessions that watch, while the agent has its own work.

    python benchmarks/offers.py [SECONDS] [GOALS_PER_SECOND] [WATCHING]

Prints goals lost, the time from a goal to its end, the agent's ticks per second, and memory in the middle and at the end.
The garbage collector is set up as by `jacaros run`: otherwise it stops the agent for up to 0.3 s at a time.
"""

import asyncio
import gc
import resource
import statistics
import sys
import time
from contextlib import suppress
from typing import Any

from jacaros import Mas
from jacaros.runtime.mas.launch import GARBAGE_THRESHOLD
from jacaros.serving.callers import Caller, RequestError
from jacaros.serving.service import service_of

PROGRAM = """
{ offer(goal, add(a(number), b(number), sum(out(number))), at_most(any)) }
{ offer(goal, pause(ms(number)), at_most(any)) }
{ offer(belief, ticks(n(number))) }
ticks(0).
!tick.
@tick[urgency(10)] +!tick : ticks(N) <- -+ticks(N + 1); .wait(20); !!tick.
+!add(A, B, A + B).
+!pause(Ms) <- .wait(Ms).
"""


def megabytes() -> float:
    """Return the memory of this process now, in MB."""
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * resource.getpagesize() / 1e6


class Load:
    """Gives goals, and forgets those that have ended.

    Attributes:
        given, lost: number of goals given, and of those that were not achieved.
        seconds: from a short goal to its end.
    """

    def __init__(self, session: Any) -> None:
        self._session, self._alive = session, list[Any]()
        self.given = self.lost = 0
        self.seconds: list[float] = []

    async def give(self, rate: float, seconds: float) -> None:
        """Give goals at a rate; every tenth one waits for 200 ms. What is too much now is given later."""
        began, before = time.perf_counter(), self.given
        while (now := time.perf_counter() - began) < seconds or self.given - before < rate * seconds:
            with suppress(RequestError):
                while self.given - before < min(now, seconds) * rate:
                    name, data = ("add", [self.given, 1]) if self.given % 10 else ("pause", [200])
                    self._alive.append(self._session.achieve("robot", name, data))
                    self.given += 1
            self.forget()
            await asyncio.sleep(0.01)

    def forget(self) -> None:
        """Count the goals that have ended."""
        over = [each for each in self._alive if each.over]
        self._alive = [each for each in self._alive if not each.over]
        self.lost += sum(each.state != "achieved" for each in over)
        self.seconds += [each.ended - each.began for each in over if each.offer.name == "add"]


async def main(seconds: float, rate: float, watching: int) -> None:
    """Measure."""
    async with Mas(seed=1) as mas:
        robot = mas.add_agent("robot", PROGRAM)
        service = service_of(mas.system)
        session = service.open(Caller("load", "python", frozenset({"user"})))
        changes = 0

        def changed(_: object) -> None:
            nonlocal changes
            changes += 1

        for number in range(int(watching)):
            watcher = service.open(Caller(f"watcher{number}", "python", frozenset({"operator"})))
            watcher.watch("robot", "ticks", changed)
            watcher.listen(changed)
        await asyncio.sleep(1)
        gc.set_threshold(GARBAGE_THRESHOLD, 20, 100)
        gc.freeze()
        first = (robot.ask("ticks(N)") or {})["N"]
        began = time.perf_counter()
        load = Load(session)
        await load.give(rate, seconds / 2)
        middle = megabytes()
        await load.give(rate, seconds / 2)
        await asyncio.sleep(0.5)
        took = time.perf_counter() - began - 0.5
        ticks = ((robot.ask("ticks(N)") or {})["N"] - first) / (took + 0.5)
        load.forget()
        median, longest = statistics.median(load.seconds) * 1000, max(load.seconds) * 1000
        print(f"{load.given / took:.0f} goals/s for {took:.0f} s, {load.lost} not achieved")
        print(f"from a goal to its end: median {median:.2f} ms, longest {longest:.0f} ms")
        print(
            f"{ticks:.1f} ticks/s of the agent (50 wanted), {changes / took:.0f} changes/s heard by {watching:g} sessions"
        )
        print(
            f"{middle:.0f} MB in the middle, {megabytes():.0f} MB at the end, kept: {len(service.goals)} goals"
        )


if __name__ == "__main__":
    given = [float(each) for each in sys.argv[1:]]
    asyncio.run(main(*given, *(60.0, 500.0, 0)[len(given) :]))  # type: ignore[arg-type]
