"""A look at a fleet from outside: what its members have, how far away they are; and an end for them.

The commands `jacaros fleet list`, `ping` and `stop` are *visitors*: they get the picture of each member without being one,
so no agent and no log notices them.
"""

import asyncio
from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from types import TracebackType

import msgspec

from jacaros.fleet import protocol
from jacaros.fleet.carrier import Carrier, MemberId
from jacaros.fleet.channel import Channel, Malformed, read_packet
from jacaros.fleet.visits import is_visitor, visitor_id
from jacaros.runtime.clock import Clock

_TURN = 0.02
"""Seconds between two looks at whether something has arrived."""
QUIET = 0.8
"""Seconds without a new member after which all are known."""
_PINGS, _PATIENCE = 3, 0.5
"""Measurements of a delay, and the seconds that they may take together."""


@dataclass(slots=True)
class Seen:
    """A member that is there.

    Attributes:
        id: its run.
        channel: the way to it.
        picture: what it has; None: it has not answered.
        delay: seconds there and back, the shortest of a few; None: it has not answered.
        problem: why it cannot be understood, such as another version; or empty.
        answers: by number of the request, when each was answered, on the clock of the visitor, and why it was refused.
    """

    id: MemberId
    channel: Channel
    picture: protocol.Here | None = None
    delay: float | None = None
    problem: str = ""
    answers: dict[int, tuple[float, str]] = field(default_factory=dict)


class Operator:
    """A visitor of a fleet. Use it as an asynchronous context manager.

    Args:
        carrier: the network.
        name: name of the visitor: `jacaros.fleet.names.OPERATOR`, or with keys the name in their certificate.
        clock: clock for time limits and measurements.

    Attributes:
        members: those that are there, by name.
    """

    def __init__(self, carrier: Carrier, name: str, clock: Clock) -> None:
        self.members: dict[str, Seen] = {}
        self._carrier, self._me, self._clock = carrier, visitor_id(name), clock
        self._came_at = 0.0
        self._calls = 0

    async def __aenter__(self) -> "Operator":
        await self._carrier.open(self._me, self)
        self._came_at = self._clock.elapsed
        return self

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        for seen in self.members.values():
            seen.channel.lose()
        await self._carrier.close()

    # ---- what the carrier tells

    def present(self, member: MemberId, is_present: bool) -> None:
        """Hear that a member is there, or is not."""
        known = self.members.get(member.name)
        if is_visitor(member) or (known is not None and known.id.incarnation > member.incarnation):
            return
        if known is not None and (is_present or known.id == member):
            known.channel.lose()
            del self.members[member.name]
        if is_present:
            transmit = partial(self._carrier.send, member)
            channel = Channel(self._clock, transmit, partial(self._received, member.name))
            self.members[member.name] = Seen(member, channel)
            self._came_at = self._clock.elapsed

    def received(self, sender: MemberId, datagram: bytes) -> None:
        """Receive a datagram of a member."""
        seen = self.members.get(sender.name)
        if seen is None or seen.id != sender:
            return
        try:
            seen.channel.heard(read_packet(datagram))
        except Malformed as error:
            seen.problem = str(error)

    def all_received(self) -> None:
        """Do nothing: each answer is for a command of its own."""

    def refused(self, sender: str, why: str) -> None:
        """Ignore what did not come from a member: a visitor looks at members only."""

    def _received(self, member: str, payload: bytes) -> None:
        seen = self.members[member]
        try:
            said = protocol.read(payload)
        except (msgspec.MsgspecError, RecursionError) as error:
            seen.problem = f"a damaged message ({error})"
            return
        if isinstance(said, protocol.Here):
            seen.picture = said
        elif isinstance(said, protocol.Answer):
            seen.answers[said.call] = self._clock.elapsed, said.refused

    # ---- requests

    async def until(self, holds: Callable[[], bool], timeout: float) -> bool:
        """Wait until something holds, at most *timeout* seconds. Return whether it does."""
        end = self._clock.elapsed + timeout
        while not holds():
            if self._clock.elapsed >= end:
                return False
            await self._clock.sleep(_TURN)
        return True

    async def look(self, timeout: float) -> None:
        """Wait until all members are known and have answered, at most *timeout* seconds, and measure their delays."""
        await self.until(self._is_complete, timeout)
        answering = [each for each in self.members.values() if each.picture is not None]
        await asyncio.gather(*map(self._measure, answering))

    async def _measure(self, seen: Seen) -> None:
        for _ in range(_PINGS):
            took = await self.ping(seen, _PATIENCE / _PINGS)
            if took is not None:
                seen.delay = took if seen.delay is None else min(took, seen.delay)

    def _is_complete(self) -> bool:
        if not self.members or self._clock.elapsed - self._came_at < QUIET:
            return False
        return all(each.picture is not None or each.problem for each in self.members.values())

    async def ping(self, seen: Seen, timeout: float) -> float | None:
        """Return the seconds that a request takes to a member and back. None: it does not answer in time."""
        begun = self._clock.elapsed
        answer = await self._ask(seen, "ping", timeout)
        return None if answer is None else answer[0] - begun

    async def stop(self, seen: Seen, timeout: float) -> str:
        """Stop a member. Return why that is impossible, or an empty text when it has gone."""
        answer = await self._ask(seen, "stop", timeout)
        if answer is None:
            return "it does not answer"
        if answer[1]:
            return answer[1]
        gone = await self.until(lambda: self.members.get(seen.id.name) is not seen, timeout)
        return "" if gone else "it is still ending"

    async def _ask(self, seen: Seen, what: str, timeout: float) -> tuple[float, str] | None:
        self._calls += 1
        call = self._calls
        seen.channel.send(protocol.write(protocol.Ask(call, what)))
        await self.until(lambda: call in seen.answers, timeout)
        return seen.answers.pop(call, None)
