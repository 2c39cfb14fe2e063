"""Several systems in one process that are members of a fleet, over a simulated network."""

import asyncio
from collections.abc import AsyncIterator
from contextlib import AsyncExitStack, asynccontextmanager
from typing import Any

from queues import SimulatedNetwork

from jacaros import Mas
from jacaros.fleet.joining import joining
from jacaros.fleet.member import Member
from jacaros.runtime.clock import clock_of


class Fleet:
    """Systems by the names of their members.

    Attributes:
        network: between them.
        members: what joined each of them to the fleet.
    """

    def __init__(self) -> None:
        self.network = SimulatedNetwork(clock_of(asyncio.get_running_loop()))
        self.systems: dict[str, Mas] = {}
        self.members: dict[str, Member] = {}

    def __getitem__(self, name: str) -> Mas:
        return self.systems[name]

    async def join(self, stack: AsyncExitStack, name: str, **options: Any) -> Mas:
        """Let another system join; it leaves with the stack."""

        def joined(member: Member) -> None:
            self.members[name] = member

        join = joining(self.network.carrier(), name, joined=joined)
        quiet = {"on_print": lambda *_: None, "on_log": lambda *_: None}
        mas = Mas(name=name, seed=1, join=join, **{**quiet, **options})
        self.systems[name] = await stack.enter_async_context(mas)
        return self.systems[name]

    async def known(self) -> None:
        """Wait until all members know all others."""
        for _ in range(500):
            joined = [
                peer
                for each in self.members.values()
                for peer in each.peers.values()
                if peer.state == "joined"
            ]
            if len(joined) == len(self.members) * (len(self.members) - 1):
                return
            await asyncio.sleep(0.02)
        raise AssertionError("they do not know each other")


@asynccontextmanager
async def fleet(*names: str, **options: Any) -> AsyncIterator[Fleet]:
    """Run a system for each name, and wait until all know each other."""
    all = Fleet()
    async with AsyncExitStack() as stack:
        for name in names:
            await all.join(stack, name, **options)
        await all.known()
        yield all
