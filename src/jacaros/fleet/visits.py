"""Visitors of this member: commands that look at a fleet and stop its members, without being a member.

A visitor gets the picture of each member, and measures the delay. It can do nothing else, unless it has the right to stop
members.
"""

import os
import time
from collections.abc import Callable
from functools import partial
from secrets import token_hex

import msgspec

from jacaros.fleet import protocol
from jacaros.fleet.carrier import MemberId
from jacaros.fleet.channel import Channel, Packet
from jacaros.fleet.rights import STOP, Rights
from jacaros.runtime.clock import Clock

_MARK = "visit"
_MOST = 16
"""Visitors at a time. Another one displaces the oldest."""
_FULL = 1 << 20
"""Bytes under way to a visitor beyond which it gets no answers."""


def visitor_id(name: str) -> MemberId:
    """Return the id of a visit that begins now. It differs from all ids of members."""
    return MemberId(name, f"{_MARK}{time.time_ns():016x}{os.getpid() & 0xFFFF:04x}{token_hex(2)}")


def is_visitor(id: MemberId) -> bool:
    """Return whether an id is that of a visitor."""
    return id.incarnation.startswith(_MARK)


class Visits:
    """All visitors of one member.

    Args:
        clock: clock of the run.
        transmit: sends a datagram to a visitor.
        picture: returns what this member has.
        rights: what visitors may do, by their names.
        stop: ends this member's system, because of a visitor with this name.
    """

    def __init__(
        self,
        clock: Clock,
        transmit: Callable[[MemberId, bytes], None],
        picture: Callable[[], protocol.Here],
        rights: Rights,
        stop: Callable[[str], None],
    ) -> None:
        self._clock, self._transmit, self._picture = clock, transmit, picture
        self._rights, self._stop = rights, stop
        self._channels: dict[MemberId, Channel] = {}

    @property
    def backlog(self) -> int:
        """Bytes that have not arrived at visitors."""
        return sum(each.backlog for each in self._channels.values())

    def present(self, visitor: MemberId, is_present: bool) -> None:
        """Hear that a visitor came or went."""
        former = self._channels.pop(visitor, None)
        if former is not None:
            former.lose()
        if is_present:
            if len(self._channels) == _MOST:
                self.present(next(iter(self._channels)), False)
            transmit, receive = partial(self._transmit, visitor), partial(self._received, visitor)
            channel = self._channels[visitor] = Channel(self._clock, transmit, receive)
            channel.send(protocol.write(self._picture()))

    def received(self, visitor: MemberId, packet: Packet) -> None:
        """Take in a packet, unless the visitor is not there."""
        channel = self._channels.get(visitor)
        if channel is not None:
            channel.heard(packet)

    def _received(self, visitor: MemberId, payload: bytes) -> None:
        try:
            said = protocol.read(payload)
        except (msgspec.MsgspecError, RecursionError):
            return
        if isinstance(said, protocol.Ask) and self._channels[visitor].backlog <= _FULL:
            self._answer(visitor, said)

    def _answer(self, visitor: MemberId, asked: protocol.Ask) -> None:
        stops = asked.what == "stop"
        refused = "" if asked.what == "ping" else f"unknown request: {asked.what[:20]!r}"
        if stops:
            allowed = STOP in self._rights.of(visitor.name)
            refused = "" if allowed else f"`{visitor.name}` lacks the right `{STOP}`"
        self._channels[visitor].send(protocol.write(protocol.Answer(asked.call, refused)))
        if stops and not refused:
            self._stop(visitor.name)

    def end(self) -> None:
        """Dismiss all visitors."""
        for visitor in list(self._channels):
            self.present(visitor, False)
