"""One of many systems of a fleet, with ten agents: how soon it knows all others, its traffic and its memory.

crowd.py FLEET NAME
"""

import asyncio
import os
import sys
import time
from collections.abc import Awaitable, Callable
from contextlib import AsyncExitStack
from pathlib import Path

from orders import Orders

import jacaros
from jacaros import Mas
from jacaros.fleet.carrier import MemberId
from jacaros.fleet.joining import joining
from jacaros.fleet.network import Network
from jacaros.fleet.on_zenoh import ZenohCarrier
from jacaros.runtime.mas.launch import SWITCH_INTERVAL

AGENTS = 10
TALKING = """
+!talk : talking
  <- .all_names(L); .random(L, A); .send(A, achieve, hear("a message of a usual length"));
     .random(R); .wait(500 + 1000 * R); !talk.
+!talk.
+!hear(_).
"""
PATIENCE = 60.0
ADDED = 40
"""Bytes that Zenoh adds to each datagram, with the incarnation of the sender but without its name (seen with strace)."""


class Counting(ZenohCarrier):
    """Counts what it sends."""

    sent = datagrams = 0

    def send(self, to: MemberId, datagram: bytes) -> None:
        """Send a datagram."""
        self.datagrams += 1
        self.sent += len(datagram) + ADDED + len(self._me.name)
        super().send(to, datagram)


class Crowd:
    """This process.

    Args:
        fleet: name of the fleet.
        name: name of this member.
        stack: closes the system in the end.
    """

    def __init__(self, fleet: str, name: str, stack: AsyncExitStack) -> None:
        self._name, self._stack = name, stack
        self._carrier = Counting(Network(fleet, name))
        join = joining(self._carrier, name)
        self._mas = Mas(name=name, on_print=_ignore, on_log=_ignore, join=join)

    async def join(self, agents: float) -> list[float]:
        """Join, and return the seconds until this member knows this number of agents."""
        began = time.perf_counter()
        await self._stack.enter_async_context(self._mas)
        for number in range(AGENTS):
            self._mas.add_agent(f"{self._name}_{number}", TALKING)
        await self._known(agents)
        return [time.perf_counter() - began]

    async def know(self, agents: float) -> list[float]:
        """Return the seconds until this member knows this number of agents."""
        began = time.perf_counter()
        await self._known(agents)
        return [time.perf_counter() - began]

    async def _known(self, agents: float) -> None:
        names = self._mas.system.directory.names
        end = time.perf_counter() + PATIENCE
        while len(names()) < agents and time.perf_counter() < end:  # noqa: ASYNC110 - names come one by one
            await asyncio.sleep(0.02)

    async def idle(self, seconds: float) -> list[float]:
        """Return bytes and datagrams sent a second, and the share of a core."""
        carrier, began, used = self._carrier, time.perf_counter(), time.process_time()
        sent, datagrams = carrier.sent, carrier.datagrams
        await asyncio.sleep(seconds)
        passed = time.perf_counter() - began
        counts = (carrier.sent - sent, carrier.datagrams - datagrams, time.process_time() - used)
        return [count / passed for count in counts]

    async def busy(self, seconds: float) -> list[float]:
        """Return the same while each agent sends a message a second to any agent."""
        for agent in self._mas.agents:
            agent.add_belief("talking")
            agent.achieve("talk")
        found = await self.idle(seconds)
        for agent in self._mas.agents:
            agent.remove_belief("talking")
        return found

    async def memory(self, _: float) -> list[float]:
        """Return megabytes: resident, and without what is shared."""
        return _megabytes()


def _megabytes() -> list[float]:
    texts = Path("/proc/self/smaps_rollup").read_text(encoding="ascii").splitlines()
    sizes = {line.split(":")[0]: int(line.split()[1]) / 1024 for line in texts[1:]}
    return [sizes["Rss"], sizes["Pss"], sizes["Private_Clean"] + sizes["Private_Dirty"]]


def _ignore(*_: object) -> None:
    return


async def main(fleet: str, name: str) -> None:
    """Run until the input ends."""
    orders = Orders()
    async with AsyncExitStack() as stack:
        crowd = Crowd(fleet, name, stack)
        acts: dict[str, Callable[[float], Awaitable[list[float]]]] = {
            "join": crowd.join,
            "know": crowd.know,
            "idle": crowd.idle,
            "busy": crowd.busy,
            "memory": crowd.memory,
        }
        orders.ready()
        while order := await asyncio.to_thread(orders.next):
            what, amount = order
            orders.answer(await acts[what](amount))
        os._exit(0)  # all end at the same time: goodbyes are not measured


if __name__ == "__main__":
    sys.setswitchinterval(SWITCH_INTERVAL)
    jacaros.run(main(sys.argv[1], sys.argv[2]))
