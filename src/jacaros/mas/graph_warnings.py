"""Warnings about the ROS graph of a run that no middleware gives.

The run ignores a simulator's time; no other node is in the graph, usually because of a different domain; or nothing
declares a given parameter.
"""

import asyncio
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress

from jacaros.files.texts import close_matches, did_you_mean
from jacaros.ros.backend import Backend, GraphContents
from jacaros.ros.errors import RosError
from jacaros.ros.node import Subscription
from jacaros.ros.parameter import GivenParameters
from jacaros.ros.waiting import MISSING_AFTER
from jacaros.runtime.clock import Clock

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
        self._listening: Subscription | None = None
        self._asking: asyncio.Task[None] | None = None
        self._told = False

    def watch(self) -> None:
        """Begin to watch."""
        from jacaros.ros.node import Capability
        from jacaros.ros.ros_clock import CLOCK_QOS, CLOCK_TOPIC, CLOCK_TYPE

        backend = self._backend
        self._listening = backend.subscription(CLOCK_TOPIC, CLOCK_TYPE, self._heard, CLOCK_QOS)
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
        self._backend, self._graph, self._log = backend, graph, log
        self._task: asyncio.Task[None] | None = None
        self._clock, self._begun = clock, clock.elapsed
        self._missing = round(MISSING_AFTER / _STEP)
        self._wait()

    def _wait(self) -> None:
        self._due = self._clock.elapsed + _STEP
        self._timer = self._clock.call_later(_STEP, self._step)

    def _step(self) -> None:
        now = self._clock.elapsed
        self._missing -= now - self._due < _LATE
        if self._missing > 0 and now - self._begun < _AT_MOST:
            self._wait()
        else:
            self._task = asyncio.get_running_loop().create_task(self._look())

    async def _look(self) -> None:
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
        self._timer.cancel()
        if self._task is not None:
            self._task.cancel()


_DECLARING = 3.0
"""Seconds of the run's clock: agents also create artifacts with their first steps."""

_FEW = 5
"""Maximum number of names in a message: a file for all nodes of a robot may have hundreds."""


class UndeclaredParameters:
    """Logs which of the given parameters are not declared `_DECLARING` seconds after the start.

    A run that ends before that logs it at its end.

    Args:
        names: names of the given parameters.
        given: returns the parameters of our node; None without a node.
        clock: measures the seconds.
        log: takes one line.
    """

    def __init__(
        self,
        names: Iterable[str],
        given: "Callable[[], GivenParameters | None]",
        clock: Clock,
        log: Callable[[str], None],
    ) -> None:
        self._names, self._given, self._log = sorted(names), given, log
        self._is_told = False
        self._timer = clock.call_later(_DECLARING, self.tell)

    def tell(self) -> None:
        """Log it, unless it has been logged."""
        if self._is_told:
            return
        self.close()
        given = self._given()
        unknown, known = (self._names, []) if given is None else (given.untaken(), given.known())
        if unknown:
            self._log(_text(unknown, known))

    def close(self) -> None:
        """Stop watching."""
        self._is_told = True
        self._timer.cancel()


def _text(unknown: Sequence[str], known: Sequence[str]) -> str:
    several = len(unknown) > 1
    listed = ", ".join(unknown[:_FEW]) + (f" and {len(unknown) - _FEW} more" if len(unknown) > _FEW else "")
    near = dict.fromkeys(each for name in unknown for each in close_matches(name, known))
    declaration = f"`parameters: {{{unknown[0].rpartition('.')[2]}: {{default: ...}}}}`"
    help = did_you_mean(near, f"declare it in a mapping file: {declaration}")
    return (
        f"parameter{'s' if several else ''} {listed} {'have' if several else 'has'} no effect: nothing declares "
        f"{'them' if several else 'it'}; {help}"
    )
