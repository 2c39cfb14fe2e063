"""What people are told once of the graph of a run, since no middleware does.

Its nodes go by a simulator's time, and the run does not; nobody else is in it, which is most often another domain; nobody
declares a parameter that was given.
"""

import asyncio
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import suppress

from jacaros.clock import Clock
from jacaros.ros.backend import Backend, Subscription
from jacaros.ros.errors import RosError
from jacaros.ros.graph import GraphContents
from jacaros.ros.parameter import GivenParameters
from jacaros.ros.waiting import MISSING_AFTER

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

    def __init__(self, backend: Backend, log: Callable[[str], None]) -> None:
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


_ANSWER = 5.0
"""Seconds for the graph to tell what is in it."""
_STEP, _LATE = 0.1, 0.02
"""Seconds between two looks at the loop, and how late it may be to count as on time."""
_AT_MOST = 30.0
"""Seconds after which a loop that is always late is waited for no longer."""


def _everybody(contents: GraphContents) -> Iterator[str]:
    """The names of all who are there.

    Of a busy process its topics may be known before the names of its nodes; then they have an empty one.
    """
    yield from contents.nodes
    for topic in contents.topics.values():
        yield from (endpoint.node for endpoint in (*topic.publishers, *topic.subscriptions))


class EmptyGraph:
    """Logs when nobody else is in the graph `MISSING_AFTER` seconds after our node was started.

    Only seconds in which the loop is on time count: on a busy machine discovery is late, too, and so are other nodes.

    Args:
        backend: our node, started.
        clock: measures the seconds.
        graph: says which graph it is, for people.
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
            return  # who cannot ask cannot tell either
        if not any(who != self._backend.node_name for who in _everybody(contents)):
            self._log(
                f"no other node is in {self._graph}. Is the robot running? It must have the same ROS_DOMAIN_ID (here "
                "--domain-id, too) and ROS_AUTOMATIC_DISCOVERY_RANGE"
            )

    def close(self) -> None:
        """Tell nothing any more."""
        self._timer.cancel()
        if self._task is not None:
            self._task.cancel()


_DECLARING = 3.0
"""Seconds of the run's clock: agents make artifacts with their first steps, too."""

_FEW = 5
"""So many names are told: a file for all nodes of a robot may have hundreds."""


class UndeclaredParameters:
    """Tells in a log which of the given parameters nobody has declared `_DECLARING` seconds after the start.

    A run that ends before that tells it at its end.

    Args:
        names: of the parameters that were given.
        given: those of our node; None while there is no node.
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
        """Tell it, unless it is told."""
        if self._is_told:
            return
        self.close()
        given = self._given()
        unknown, known = (self._names, []) if given is None else (given.untaken(), given.known())
        if unknown:
            self._log(_text(unknown, known))

    def close(self) -> None:
        """Tell nothing any more."""
        self._is_told = True
        self._timer.cancel()


def _text(unknown: Sequence[str], known: Sequence[str]) -> str:
    from jacaros.asl.slips import close_matches  # here: only for mistakes

    several = len(unknown) > 1
    listed = ", ".join(unknown[:_FEW]) + (f" and {len(unknown) - _FEW} more" if len(unknown) > _FEW else "")
    near = [found[0] for name in unknown if (found := close_matches(name, known))]
    help = (
        f"did you mean {', '.join(dict.fromkeys(near))}?"
        if near
        else f"a mapping file does that, parameters: {{{unknown[0].rpartition('.')[2]}: {{default: ...}}}}"
    )
    return (
        f"the parameter{'s' if several else ''} {listed} {'have' if several else 'has'} no effect: nothing here declares "
        f"{'them' if several else 'it'}; {help}"
    )
