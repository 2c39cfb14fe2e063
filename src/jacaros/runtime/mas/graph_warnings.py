"""Warnings about the ROS graph of a run that no middleware gives.

The run ignores a simulator's time; no other node is in the graph, usually because of a different domain; or nothing
declares a given parameter.
"""

import asyncio
from collections.abc import Callable, Iterator, Sequence
from contextlib import suppress

from jacaros.robots.ros.backend import Backend, GraphContents
from jacaros.robots.ros.errors import RosError
from jacaros.robots.ros.node import Capability, Subscription
from jacaros.robots.ros.ros_clock import CLOCK_QOS, CLOCK_TOPIC, CLOCK_TYPE
from jacaros.robots.ros.waiting import MISSING_AFTER
from jacaros.runtime.clock import Clock
from jacaros.runtime.files.texts import close_matches, did_you_mean

SIM_TIME = "use_sim_time"
PATIENCE = 5.0
"""Seconds to wait for a parameter of the ROS 1 master."""


class GraphTime:
    """Detects a simulator's time in a graph, for a run on the real clock.

    A simulator publishes ``/clock``. On ROS 1, the parameter ``/use_sim_time`` also tells nodes to use it, possibly
    before the simulator runs: rospy and roscpp read it when a node starts.

    Args:
        backend: the node of the run.
        log: takes a line of the log.
    """

    def __init__(self, backend: Backend, log: Callable[[str], None]) -> None:
        self._backend, self._log = backend, log
        self._asking: asyncio.Task[None] | None = None
        self._told = False
        listening = backend.subscription(CLOCK_TOPIC, CLOCK_TYPE, self._heard, CLOCK_QOS)
        self._listening: Subscription | None = listening
        if backend.ros_version == 1 and Capability.PARAMETERS in backend.capabilities:
            backend.on_connection(self._connected)
            self._connected(backend.connected)

    def close(self) -> None:
        """Stop watching."""
        self._unsubscribe()
        if self._asking is not None:
            self._asking.cancel()

    def _heard(self, _: object) -> None:
        self._unsubscribe()
        self._tell(
            "a simulator publishes its time on /clock, but this run uses the real clock; to follow the simulator, run with "
            "--clock ros"
        )

    def _unsubscribe(self) -> None:
        if self._listening is not None:
            self._listening.close()
            self._listening = None

    def _connected(self, present: bool) -> None:
        if present and self._asking is None:
            self._asking = asyncio.get_running_loop().create_task(self._ask())

    async def _ask(self) -> None:
        with suppress(RosError):  # the parameter does not exist, or the master is gone
            if await self._backend.parameters("/").get(SIM_TIME, PATIENCE):
                self._tell(
                    "use_sim_time is set on the ROS master, so other nodes follow /clock, but this run uses the "
                    "real clock; to follow the simulator, run with --clock ros"
                )

    def _tell(self, text: str) -> None:
        if not self._told:
            self._told = True
            self._log(text)


_ANSWER = 5.0
"""Seconds to wait for the contents of the graph."""
_STEP, _LATE = 0.1, 0.02
"""Seconds between two checks of the event loop, and the delay up to which it counts as on time."""
_AT_MOST = 30.0
"""Seconds after which a loop that is always late is checked no longer."""


def _participants(contents: GraphContents) -> Iterator[str]:
    """Return the names of all other participants.

    The topics of a busy process may be known before the names of its nodes. Then the name is empty.
    """
    yield from contents.nodes
    for topic in contents.topics.values():
        yield from (endpoint.node for endpoint in (*topic.publishers, *topic.subscriptions))


class EmptyGraph:
    """Logs if no other node is in the graph `MISSING_AFTER` seconds after our node was started.

    Only seconds in which the event loop is on time count: on a busy machine, discovery and other nodes are late, too.

    Args:
        backend: the node of the run, started.
        clock: measures the seconds.
        graph: name of the graph, for messages.
        log: takes one line.
    """

    def __init__(self, backend: Backend, clock: Clock, graph: str, log: Callable[[str], None]) -> None:
        self._backend, self._clock, self._graph, self._log = backend, clock, graph, log
        self._task = asyncio.get_running_loop().create_task(self._watch())

    async def _watch(self) -> None:
        missing, begun = round(MISSING_AFTER / _STEP), self._clock.elapsed
        while missing > 0 and self._clock.elapsed - begun < _AT_MOST:
            due = self._clock.elapsed + _STEP
            await self._clock.sleep(_STEP)
            missing -= self._clock.elapsed - due < _LATE
        try:
            contents = await self._backend.contents(_ANSWER)
        except RosError:
            return  # without an answer there is nothing to report
        if not any(who != self._backend.node_name for who in _participants(contents)):
            self._log(
                f"no other node is in {self._graph}; check that the robot is running with the same ROS_DOMAIN_ID (or "
                "--domain-id) and ROS_AUTOMATIC_DISCOVERY_RANGE"
            )

    def close(self) -> None:
        """Stop watching."""
        self._task.cancel()


_FEW = 5
"""Maximum number of names in a message: a file for all nodes of a robot may have hundreds."""


def undeclared(unknown: Sequence[str], known: Sequence[str]) -> str:
    """Return the warning about given parameters that nothing declares."""
    several = len(unknown) > 1
    listed = ", ".join(unknown[:_FEW]) + (f" and {len(unknown) - _FEW} more" if len(unknown) > _FEW else "")
    near = dict.fromkeys(each for name in unknown for each in close_matches(name, known))
    declaration = f"`parameters: {{{unknown[0].rpartition('.')[2]}: {{default: ...}}}}`"
    help = did_you_mean(near, f"declare it in a mapping file: {declaration}")
    return (
        f"parameter{'s' if several else ''} {listed} {'have' if several else 'has'} no effect: nothing declares "
        f"{'them' if several else 'it'}; {help}"
    )
