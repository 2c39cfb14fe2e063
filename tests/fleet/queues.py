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
        """Cut the link between two members. A cut that is not *noticed* shows by their silence only."""
        self._cut.add(frozenset({one, other}))
        if noticed:
            self._tell_both(one, other, False)

    def notice_loss(self, me: str, other: str, seconds: float) -> None:
        """Let one member believe for a while that another one is gone, although it is not, or not yet."""
        pairs = [(a, b) for a in self._open for b in self._open if (a.name, b.name) == (me, other)]
        for here, it in pairs:
            self._open[here].present(it, False)
            self._later(seconds, here, it, True)

    def kill(self, name: str) -> None:
        """End a member without a word."""
        for each in [each for each in self._open if each.name == name]:
            self.left(each)

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
            if me in self._open and present == (it in self._open and not self._is_cut(me, it)):
                self._open[me].present(it, present)

        self.clock.call_later(delay, tell)

    def joined(self, me: MemberId, listener: Listener) -> None:
        """Let a member in."""
        known = dict(self._open)
        self._open[me] = listener
        for it, others in known.items():
            if not self._is_cut(me, it):
                others.present(me, True)
                listener.present(it, True)

    def _is_cut(self, one: MemberId, other: MemberId) -> bool:
        return frozenset({one.name, other.name}) in self._cut

    def left(self, me: MemberId) -> None:
        """Hear that a member has left, or was killed."""
        if self._open.pop(me, None) is not None:
            for it in self._open:
                self._later(self.notice, it, me, False)

    def carry(self, sender: MemberId, to: MemberId, datagram: bytes) -> None:
        """Carry a datagram, or do not."""
        if sender not in self._open:
            return  # it was killed
        copies = 1 + (self.random.random() < self.doubling)
        for _ in range(copies):
            if self.random.random() >= self.loss:
                delay = self.delay + self.random.random() * self.spread
                self.clock.call_later(delay, lambda: self._arrive(sender, to, datagram))

    def _arrive(self, sender: MemberId, to: MemberId, datagram: bytes) -> None:
        listener = self._open.get(to)
        if listener is not None and not self._is_cut(sender, to):
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
