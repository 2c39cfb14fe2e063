"""A carrier for tests: a simulated network in one process, which delays, loses, doubles and reorders, and can be cut."""

import asyncio
from random import Random

from jacaros.fleet.carrier import Listener, MemberId
from jacaros.runtime.clock import Clock


class SimulatedNetwork:
    """A network between the members of one process.

    Args:
        clock: clock of the run.
        seed: seed of what it does to datagrams.

    Attributes:
        delay, spread: seconds that a datagram takes at least, and more at most.
        loss, doubling: shares of datagrams that are lost, or come twice.
        notice: seconds after which the end or loss of a member is noticed.
    """

    def __init__(self, clock: Clock, seed: int = 0) -> None:
        self.clock, self.random = clock, Random(seed)
        self.delay, self.spread, self.loss, self.doubling, self.notice = 0.001, 0.0, 0.0, 0.0, 0.1
        self._open: dict[MemberId, Listener] = {}
        self._cut: set[frozenset[str]] = set()

    def carrier(self) -> "SimulatedCarrier":
        """Return the access of one member."""
        return SimulatedCarrier(self)

    def cut(self, one: str, other: str, noticed: bool = True) -> None:
        """Cut the link between two members."""
        self._cut.add(frozenset({one, other}))
        if noticed:
            self._tell_both(one, other, False)

    def heal(self, one: str, other: str) -> None:
        """Heal it."""
        self._cut.discard(frozenset({one, other}))
        self._tell_both(one, other, True)

    def _tell_both(self, one: str, other: str, present: bool) -> None:
        ids = [each for each in self._open if each.name in (one, other)]
        for me in ids:
            for it in ids:
                if me.name != it.name:
                    self._later(self.notice, me, it, present)

    def _later(self, delay: float, me: MemberId, it: MemberId, present: bool) -> None:
        def tell() -> None:
            is_cut = frozenset({me.name, it.name}) in self._cut
            if me in self._open and present == (it in self._open and not is_cut):
                self._open[me].present(it, present)

        self.clock.call_later(delay, tell)

    def joined(self, me: MemberId, listener: Listener) -> None:
        """Let a member in."""
        for it, others in self._open.items():
            others.present(me, True)
            listener.present(it, True)
        self._open[me] = listener

    def left(self, me: MemberId) -> None:
        """Hear that a member has left, or was killed."""
        if self._open.pop(me, None) is not None:
            for it in self._open:
                self._later(self.notice, it, me, False)

    def carry(self, sender: MemberId, to: MemberId, datagram: bytes) -> None:
        """Carry a datagram, or do not."""
        copies = 1 + (self.random.random() < self.doubling)
        for _ in range(copies):
            if self.random.random() >= self.loss:
                delay = self.delay + self.random.random() * self.spread
                self.clock.call_later(delay, lambda: self._arrive(sender, to, datagram))

    def _arrive(self, sender: MemberId, to: MemberId, datagram: bytes) -> None:
        listener = self._open.get(to)
        if listener is not None and frozenset({sender.name, to.name}) not in self._cut:
            listener.received(sender, datagram)


class SimulatedCarrier:
    """The access of one member to a `SimulatedNetwork`."""

    def __init__(self, network: SimulatedNetwork) -> None:
        self._network = network
        self._me = MemberId("", "")

    async def open(self, me: MemberId, listener: Listener) -> None:
        """Join. See `jacaros.fleet.carrier.Carrier`."""
        self._me = me
        await asyncio.sleep(0)
        self._network.joined(me, listener)

    def send(self, to: MemberId, datagram: bytes) -> None:
        """Send a datagram."""
        self._network.carry(self._me, to, datagram)

    async def close(self) -> None:
        """Leave."""
        self._network.left(self._me)
