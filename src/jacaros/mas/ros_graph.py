"""The ROS graph of a run, and the embedded world in it.

The in-process graph, and the world with it, are created when the first artifact uses them: a program without robots
does not load them. A real graph is joined at the start.
"""

from collections.abc import Callable, Coroutine
from contextlib import AsyncExitStack
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.errors import UsageError
from jacaros.mas.deployment import ProjectError
from jacaros.mas.options import RunOptions
from jacaros.runtime.clock import Clock

if TYPE_CHECKING:
    from jacaros.agents.language.diagnostics import Span
    from jacaros.mas.graph_warnings import EmptyGraph, GraphTime, UndeclaredParameters
    from jacaros.mas.guarding import RunGuard
    from jacaros.ros.backend import Backend
    from jacaros.ros.parameter import GivenParameters
    from jacaros.ros.ros_clock import RosClock
    from jacaros.runtime.trace import Tracer
    from jacaros.sim.node import SimNode
    from jacaros.sim.physics.world import World

DEFAULT_WORLD = "empty"
"""The world of a project that does not name one: an open floor with one robot, whose odometry is exact."""


NO_WORLD = "none"
"""Instead of the name of a world: no other node is in the in-process graph."""

_GROUND_TRUTH = 1000
"""Number of points of a robot's path, and of events, that are kept by default: some minutes of motion."""


class RosGraph:
    """Opens backend and world of a run.

    Args:
        options: options of the run.
        clock: clock of the run.
        name: name of the agent system, which is also the name of its ROS node.
        world: the world that the project names. None for the default one.
        log: takes a line of the log.
        hurry: called when messages of other processes have been delivered, so that agents need not wait for the next
            round of the event loop.
        world_span: location of the world's name in the project.

    Attributes:
        world: the embedded world, or None.
    """

    def __init__(
        self,
        options: RunOptions,
        clock: Clock,
        name: str,
        world: str | Path | None,
        log: Callable[[str], None],
        hurry: Callable[[], None] = lambda: None,
        world_span: "Span | None" = None,
    ) -> None:
        self._hurry = hurry
        self._options = options
        self._clock = clock
        self._name = node_name(name)
        self._source = options.world if options.world is not None else world
        self._source_span = world_span if options.world is None else None
        self._log = log
        self._backend: Backend | None = None
        self._tracer: Tracer | None = None
        self._companions: list[Backend] = []
        self._node: SimNode | None = None
        self._followed: RosClock | None = None
        self._time: GraphTime | None = None
        self._empty: EmptyGraph | None = None
        self._undeclared: UndeclaredParameters | None = None
        self._guard: RunGuard | None = None
        self.world: World | None = None
        self._world_watchers: tuple[Callable[[World], None], ...] = ()

    async def start(self) -> None:
        """Join a real graph, and create the world if it was requested by name.

        On a real graph, the world of the project is ignored. Only one given for this run is created.

        Raises:
            BackendUnavailable: the library for the graph is missing. The text has help.
            WorldError: the world file is invalid.
            ProjectError: the project names a world that does not exist.
            UsageError: there are faults or noise, but no world.
        """
        made = self._options.world is not None if self._options.ros != "memory" else self._source != NO_WORLD
        for option in ("faults", "noise"):
            if getattr(self._options, option) is not None and not made:
                raise UsageError(f"--{option} needs an embedded world; add --world")
        if self._options.ros != "memory":
            backend = self._open()
            self._backend = backend
            backend.after_delivery(self._hurry)
            await backend.start()
            if self._options.ros_clock:
                self._follow_clock(backend)
            else:
                from jacaros.mas.graph_warnings import GraphTime  # here: only for real graphs

                self._time = GraphTime(backend, self._log_ros)
                self._time.watch()
            # Only on request: a project that names a world for practice also runs on the real robot.
            if self._options.world is not None:
                self._start_world(backend)
            elif self._options.ros == "ros2":
                self._look_for_others(backend)
        elif self._source is not None or self._options.show_world or self._options.faults is not None:
            self.backend()

    async def guard(self) -> None:
        """Start the guard, if the options ask for one, and the heartbeat.

        Raises:
            UsageError: the guard did not start.
        """
        if self._options.guard:
            from jacaros.mas.guarding import RunGuard  # here: only for runs with a guard

            options = self._options
            self._guard = RunGuard(options, self.backend(), options.ros_clock, self._log_ros)
            await self._guard.start()

    def backend(self) -> "Backend":
        """Return the node of the agent system in the ROS graph."""
        if self._backend is None:
            self._backend = self._open()
            _finish_at_once(self._backend.start())
            if self._source != NO_WORLD:
                self._start_world(self.companion("world"))
        return self._backend

    def companion(self, name: str) -> Any:
        """Return another node in the in-process graph, such as that of the world or of a test. It ends with the run."""
        from jacaros.ros.open import open_backend

        beside: Any = self.backend()
        made = open_backend("memory", self._clock, name, log=self._log_ros, graph=beside.graph)
        self._companions.append(made)
        _finish_at_once(made.start())
        return made

    @property
    def node(self) -> "SimNode | None":
        """The node of the embedded world; None without one, or before the graph is opened."""
        return self._node

    @property
    def joined(self) -> "Backend | None":
        """The node of the run; None before the graph is opened."""
        return self._backend

    def watch_world(self, watcher: "Callable[[World], None]") -> Callable[[], None]:
        """Call *watcher* with the embedded world, now or when it is created. Return a function that ends this."""
        if self.world is not None:
            watcher(self.world)
            return lambda: None
        self._world_watchers = (*self._world_watchers, watcher)

        def end() -> None:
            self._world_watchers = tuple(each for each in self._world_watchers if each is not watcher)

        return end

    def catch_up(self) -> None:
        """Let the embedded world make all steps that are due."""
        if self._node is not None:
            self._node.time.catch_up()

    def watch_parameters(self) -> None:
        """Check whether the given parameters are declared. Called when everything has been created."""
        if not self._options.parameters:
            return
        from jacaros.mas.graph_warnings import UndeclaredParameters  # here: few runs are given any

        def given() -> "GivenParameters | None":
            return self._backend.given_parameters if self._backend is not None else None

        self._undeclared = UndeclaredParameters(self._options.parameters, given, self._clock, self._log_ros)

    def ending(self) -> None:
        """Log pending warnings before the run ends."""
        if self._undeclared is not None:
            self._undeclared.tell()

    async def close(self) -> None:
        """Stop the robots, then the world, and leave the graph."""
        async with AsyncExitStack() as steps:  # runs in reverse order
            if self._guard is not None:
                steps.push_async_callback(self._guard.close)
            for companion in self._companions:
                steps.push_async_callback(companion.close)
            if self._node is not None:
                steps.callback(self._node.close)
            if self._backend is not None:
                steps.push_async_callback(self._backend.close)
            if self._followed is not None:
                steps.callback(self._followed.close)
            if self._time is not None:
                steps.callback(self._time.close)
            if self._empty is not None:
                steps.callback(self._empty.close)
            if self._undeclared is not None:
                steps.callback(self._undeclared.close)

    def _open(self) -> "Backend":
        backend = self._options.open(self._clock, self._name, self._log_ros)
        backend.tracer = self._tracer
        return backend

    def trace(self, tracer: "Tracer | None") -> None:
        """Pass each message that reaches our node to *tracer*, from now on."""
        self._tracer = tracer
        if self._backend is not None:
            self._backend.tracer = tracer

    def _follow_clock(self, backend: "Backend") -> None:
        from jacaros.ros.ros_clock import RosClock

        assert isinstance(self._clock, RosClock), "the launch makes the clock that the options ask for"
        self._followed = self._clock
        self._clock.listen(backend)

    def _look_for_others(self, backend: "Backend") -> None:
        from jacaros.mas.graph_warnings import EmptyGraph

        where = f"the ROS 2 graph of domain {self._options.identity}"
        self._empty = EmptyGraph(backend, self._clock, where, self._log_ros)

    def _log_ros(self, text: str) -> None:
        self._log(f"[ros] {text}")

    def _start_world(self, backend: "Backend") -> None:
        from jacaros.sim.data.world import UnknownWorld
        from jacaros.sim.node import SimNode
        from jacaros.sim.physics.world import World

        source, options, noise = self._source, self._options, self._options.noise
        if source is None:
            # A robot that misses its goal surprises users who have not asked for slipping wheels.
            source, noise = DEFAULT_WORLD, noise or 0.0
        try:
            self.world = World.load(source, options.seed, options.faults, noise)
        except UnknownWorld as unknown:
            if self._source_span is None:
                raise
            raise ProjectError(
                [Diagnostic("error", unknown.message, self._source_span, unknown.help)]
            ) from unknown
        self.world.ground_truth.keep = None if self._options.keep_ground_truth else _GROUND_TRUTH
        self._node = SimNode(self.world, backend, self._clock)
        self._node.start()
        for watcher in self._world_watchers:
            watcher(self.world)
        self._world_watchers = ()


def _finish_at_once(coroutine: Coroutine[Any, Any, None]) -> None:
    """Run a coroutine that does not wait: an artifact that opens the graph cannot wait."""
    try:
        coroutine.send(None)
    except StopIteration:
        return
    coroutine.close()
    raise RuntimeError("the in-process ROS graph must start without waiting")


def node_name(name: str) -> str:
    """Return a ROS name for the name of the agent system."""
    plain = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in name)
    return plain if plain[:1].isalpha() else f"mas_{plain}"
