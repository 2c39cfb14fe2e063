"""The first questions at each connection: whose graph it is, and what the server can do."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from typing import Any

from jacaros.clock import Clock
from jacaros.ros.errors import ServiceError

PATIENCE = 3.0
"""Seconds for one answer."""
ATTEMPTS, PAUSE = 6, 0.5
"""How often rosapi is asked, and seconds between: it may start after the server."""
FIRST_SIGN_OF_2 = "/msg/"
"""What the names of types have on ROS 2 alone."""


@dataclass(frozen=True, slots=True)
class Greeting:
    """What was found out.

    Attributes:
        ros_version: 1 or 2.
        packs: the server can write CBOR; of ROS 2, the first ones lost messages over it.
        told: rosapi has answered; else ROS 2 is assumed.
    """

    ros_version: int
    packs: bool
    told: bool = True


async def greet(
    ask: Callable[[str, dict[str, Any], float], Awaitable[Any]], clock: Clock, is_up: Callable[[], bool]
) -> Greeting | None:
    """Ask rosapi; None when the connection is lost meanwhile.

    Args:
        ask: calls a service of rosapi, with a time-out.
        clock: measures the pauses.
        is_up: tells whether there is a connection.
    """
    for _ in range(ATTEMPTS):
        try:
            answer = await ask("get_ros_version", {}, PATIENCE)
            return Greeting(int(answer["version"]), packs=True)
        except (ServiceError, KeyError, TypeError, ValueError):
            pass  # ROS 1 does not have it, nor ROS 2 in its first years
        try:
            types = (await ask("topics", {}, PATIENCE))["types"]
            version = 2 if any(FIRST_SIGN_OF_2 in kind for kind in types) else 1
            return Greeting(version, packs=version == 1)
        except (ServiceError, KeyError, TypeError):
            await clock.sleep(PAUSE)
        if not is_up():
            return None
    return Greeting(2, packs=False, told=False)
