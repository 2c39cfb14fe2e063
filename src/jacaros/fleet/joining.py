"""How a system joins a fleet."""

from collections.abc import Awaitable, Callable, Collection

from jacaros.fleet.carrier import Carrier
from jacaros.fleet.member import Member, new_id
from jacaros.runtime.mas.system import Join, System


def joining(
    carrier: Carrier,
    name: str,
    tell_how: Collection[str] = (),
    joined: Callable[[Member], None] | None = None,
) -> Join:
    """Return a function that joins a system to the fleet of a carrier.

    Args:
        carrier: the network.
        name: name of the member, unique in the fleet.
        tell_how: names of members that may change the programs of agents here; ``*``: all.
        joined: called with the member when it has joined.
    """

    async def join(system: System) -> Callable[[], Awaitable[None]]:
        member = Member(system, carrier, new_id(name), tell_how)
        await member.join()
        if joined is not None:
            joined(member)
        return member.leave

    return join
