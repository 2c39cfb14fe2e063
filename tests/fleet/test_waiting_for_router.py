"""A member whose router is not there runs, says so, and joins when the router comes; so it is after each restart."""

import asyncio
import uuid
from collections.abc import Callable
from contextlib import ExitStack

import pytest
from players import Member, Player
from ports import free_port

from jacaros.fleet.carrier import MemberId
from jacaros.fleet.network import Network
from jacaros.fleet.on_zenoh import ZenohCarrier
from jacaros.runtime.errors import UsageError

ME = MemberId("me", "1")


class Ears:
    """A listener that keeps who is there."""

    def __init__(self) -> None:
        self.there: set[str] = set()

    def received(self, sender: MemberId, datagram: bytes) -> None:
        """Nothing is sent."""

    def present(self, member: MemberId, is_present: bool) -> None:
        """Hear who comes and goes."""
        (self.there.add if is_present else self.there.discard)(member.name)

    def refused(self, sender: str, why: str) -> None:
        """Nothing is refused."""


async def until(holds: Callable[[], bool]) -> None:
    """Wait until something is true."""
    for _ in range(1000):
        if holds():
            return
        await asyncio.sleep(0.02)
    raise AssertionError("it does not become true")


def test_a_member_runs_without_its_router_and_joins_when_it_comes() -> None:
    fleet, address, lines = f"test-{uuid.uuid4().hex[:8]}", f"127.0.0.1:{free_port()}", list[str]()
    waiting = f"warning: waiting for a router: {address}: connection refused"
    lost = f"warning: lost the router; trying to reach {address}"

    def router(stack: ExitStack) -> Player:
        return stack.enter_context(
            Player(network={"fleet": fleet, "member": "router"}, router=address)
        ).opened()

    async def main(stack: ExitStack) -> None:
        ears, carrier = Ears(), ZenohCarrier(Network(fleet, "me", routers=(address,)), lines.append)
        await carrier.open(ME, ears)
        assert lines == [waiting]
        first = await asyncio.to_thread(router, stack)
        await until(lambda: lines[-1] == "connected to a router")
        other = stack.enter_context(Member(fleet, "other", routers=(address,)))
        await asyncio.to_thread(other.joined)
        await until(lambda: ears.there == {"other"})
        first.kill()
        await until(lambda: lines[-1] == lost and not ears.there)
        await asyncio.to_thread(first.process.wait)
        await asyncio.to_thread(router, stack)
        await until(lambda: lines[-1] == "connected to a router again" and ears.there == {"other"})
        await carrier.close()

    with ExitStack() as stack:
        asyncio.run(main(stack))
    assert lines[-1] == "connected to a router again"  # closing is not a loss


def test_a_member_that_waits_can_leave() -> None:
    async def main() -> None:
        lines: list[str] = []
        carrier = ZenohCarrier(Network("test", "me", routers=(f"127.0.0.1:{free_port()}",)), lines.append)
        await carrier.open(ME, Ears())
        await carrier.close()
        assert len(lines) == 1

    asyncio.run(main())


def test_what_cannot_change_is_an_error() -> None:
    with pytest.raises(UsageError, match="a fleet without keys stays on its computer"):
        asyncio.run(ZenohCarrier(Network("test", "me", routers=("192.168.1.5",))).open(ME, Ears()))
