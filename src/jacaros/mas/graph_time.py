"""Whether the nodes of a real graph go by a simulator's time; people are told once when the run does not."""

import asyncio
from collections.abc import Callable
from contextlib import suppress
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from jacaros.ros.backend import Backend, Subscription

SIM_TIME = "use_sim_time"
PATIENCE = 5.0
"""Seconds that the ROS 1 master has to tell a parameter."""


class GraphTime:
    """Looks for signs of a simulator in a graph, for a run that goes by the time of day.

    A simulator publishes ``/clock``.  On ROS 1 the parameter ``/use_sim_time`` says besides that nodes go by it, and may do
    so before the simulator runs: rospy and roscpp read it when a node begins.

    Args:
        backend: our node.
        log: takes a line for people.
    """

    def __init__(self, backend: "Backend", log: Callable[[str], None]) -> None:
        self._backend, self._log = backend, log
        self._listening: Subscription | None = None
        self._asking: asyncio.Task[None] | None = None
        self._told = False

    def watch(self) -> None:
        """Begin to look."""
        from jacaros.ros.backend import PARAMETERS
        from jacaros.ros.ros_clock import CLOCK_QOS, CLOCK_TOPIC, CLOCK_TYPE

        backend = self._backend
        self._listening = backend.subscription(CLOCK_TOPIC, CLOCK_TYPE, self._heard, CLOCK_QOS)
        if backend.ros_version == 1 and PARAMETERS in backend.capabilities:
            backend.on_connection(self._connected)
            self._connected(backend.connected)

    def close(self) -> None:
        """Look no more."""
        self._hear_no_more()
        if self._asking is not None:
            self._asking.cancel()

    def _heard(self, _: object) -> None:
        self._hear_no_more()
        self._tell(
            "a simulator gives the time on /clock, and this run goes by the time of day; to follow the simulator run "
            "with --clock ros"
        )

    def _hear_no_more(self) -> None:
        if self._listening is not None:
            self._listening.close()
            self._listening = None

    def _connected(self, present: bool) -> None:
        if present and self._asking is None:
            self._asking = asyncio.get_running_loop().create_task(self._ask())

    async def _ask(self) -> None:
        from jacaros.ros.errors import RosError

        with suppress(RosError):  # there is no such parameter, or the master has gone again
            if await self._backend.parameters("/").get(SIM_TIME, PATIENCE):
                self._tell(
                    "the ROS master says use_sim_time: nodes go by a simulator's time on /clock, and this run goes by the "
                    "time of day; to follow the simulator run with --clock ros"
                )

    def _tell(self, text: str) -> None:
        if not self._told:
            self._told = True
            self._log(text)
