"""How a system joins a fleet."""

from collections.abc import Awaitable, Callable

from jacaros.fleet.carrier import Carrier
from jacaros.fleet.member import SILENCE, Member, new_id
from jacaros.fleet.rights import Rights
from jacaros.runtime.mas.system import Join, System


def joining(
    carrier: Carrier,
    name: str,
    rights: Rights | None = None,
    silence: float = SILENCE,
    joined: Callable[[Member], None] | None = None,
) -> Join:
    """Return a function that joins a system to the fleet of a carrier.

    Args:
        carrier: the network.
        name: name of the member, unique in the fleet.
        rights: what other members may do here. Default: send messages, observe and use artifacts.
        silence: seconds after which a member that says nothing is lost.
        joined: called with the member when it has joined.
    """

    async def join(system: System) -> Callable[[], Awaitable[None]]:
        member = Member(system, carrier, new_id(name), rights or Rights(), silence)
        await member.join()
        if joined is not None:
            joined(member)
        return member.leave

    return join
