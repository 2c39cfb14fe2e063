"""The port to a network: datagrams to other members of a fleet, and who is present."""

from typing import NamedTuple, Protocol


class MemberId(NamedTuple):
    """One run of one member.

    Attributes:
        name: unique in the fleet.
        incarnation: differs between runs; that of an earlier start sorts first.
    """

    name: str
    incarnation: str

    def __str__(self) -> str:
        return self.name


class Listener(Protocol):
    """What a carrier calls, on the event loop on which it was opened."""

    def received(self, sender: MemberId, datagram: bytes) -> None:
        """Receive a datagram of another member."""

    def all_received(self) -> None:
        """Hear that nothing else has arrived for now, after one or more datagrams."""

    def present(self, member: MemberId, is_present: bool) -> None:
        """Hear that another member is there (True) or no longer answers (False), killed, frozen or cut off."""

    def refused(self, sender: str, why: str) -> None:
        """Hear of something that did not come from a member."""


class Carrier(Protocol):
    """The access of one member to its network.

    Datagrams may be lost, doubled and reordered. `jacaros.fleet.channel` puts that right.
    """

    async def open(self, me: MemberId, listener: Listener) -> None:
        """Begin to receive, and announce this member.

        Raises:
            UsageError: the network cannot be used. The text says why.
        """

    def send(self, to: MemberId, datagram: bytes) -> None:
        """Send a datagram. Never waits."""

    async def close(self) -> None:
        """Leave the network. Without effect if it was not opened."""
