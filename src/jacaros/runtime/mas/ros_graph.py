"""The ROS graph of a run, and the embedded world in it.

The in-process graph, and the world with it, are created when the first artifact uses them: a program without robots
does not load them. A real graph is joined at the start.
"""

from collections.abc import Callable, Coroutine
from contextlib import AsyncExitStack
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any

from jacaros.agents.language.diagnostics import Diagnostic
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.console import entered
from jacaros.runtime.mas.deployment import ProjectError
from jacaros.runtime.mas.options import RunOptions

if TYPE_CHECKING:
    from jacaros.agents.language.diagnostics import Span
    from jacaros.robots.ros.backend import Backend
    from jacaros.robots.world.node import SimNode
    from jacaros.robots.world.physics.world import World
    from jacaros.runtime.mas.guarding import RunGuard
    from jacaros.runtime.trace import Tracer

DEFAULT_WORLD = "empty"
"""The world of a project that does not name one: an open floor with one robot, whose odometry is exact."""


NO_WORLD = "none"
"""Instead of the name of a world: no other node is in the in-process graph."""

_DECLARING = 3.0
"""Seconds of the run's clock in which given parameters must be declared: first steps of agents also create artifacts."""

_GROUND_TRUTH = 1000
"""Number of points of a robot's path, and of events, that are kept by default: some minutes of motion."""


@dataclass(eq=False)
class RosGraph:
    """Opens backend and world of a run.

    Attributes:
        options: options of the run.
        clock: clock of the run.
        name: name of the agent system, which is also the name of its ROS node.
        source: the world that the options or the project name. None for the default one.
        log: takes a line of the log.
        hurry: called when messages of other processes have been delivered, so that agents need not wait for the next
            round of the event loop.
        source_span: location of the world's name in the project.
        joined: the node of the run; None before the graph is opened.
        node: the node of the embedded world; None without one, or before the graph is opened.
        world: the embedded world, or None.
    """

    options: RunOptions
    clock: Clock
    name: str
    source: str | Path | None
    log: Callable[[str], None]
    hurry: Callable[[], None] = lambda: None
    source_span: "Span | None" = None
    joined: "Backend | None" = None
    node: "SimNode | None" = None
    world: "World | None" = None
    _tracer: "Tracer | None" = None
    _companions: "list[Backend]" = field(default_factory=list)
    _watches: list[Callable[[], object]] = field(default_factory=list)
    """What ends the observation of the graph."""
    _undeclared: Timer | None = None
    _guard: "RunGuard | None" = None
    _world_watchers: "list[Callable[[World], None]]" = field(default_factory=list)

    def __post_init__(self) -> None:
        self.name = node_name(self.name)
        if self.options.world is not None:
            self.source, self.source_span = self.options.world, None

    async def start(self) -> None:
        """Join a real graph, and create the world if it was requested by name.

        On a real graph, the world of the project is ignored. Only one given for this run is created.

        Raises:
            BackendUnavailable: the library for the graph is missing. The text has help.
            WorldError: the world file is invalid.
            ProjectError: the project names a world that does not exist.
            UsageError: there are faults or noise, but no world.
        """
        made = self.options.world is not None if self.options.ros != "memory" else self.source != NO_WORLD
        for option in ("faults", "noise"):
            if getattr(self.options, option) is not None and not made:
                raise UsageError(f"--{option} needs an embedded world; add --world")
        if self.options.ros != "memory":
            backend = self._open()
            self.joined = backend
            backend.after_delivery(self.hurry)
            await backend.start()
            if self.options.ros_clock:
                self._follow_clock(backend)
            else:
                from jacaros.runtime.mas.graph_warnings import GraphTime  # here: only for real graphs

                self._watches.append(GraphTime(backend, self._log_ros).close)
            # Only on request: a project that names a world for practice also runs on the real robot.
            if self.options.world is not None:
                self._start_world(backend)
            elif self.options.ros == "ros2":
                self._look_for_others(backend)
        elif self.source is not None or self.options.show_world or self.options.faults is not None:
            self.backend()

    async def guard(self) -> None:
        """Start the guard, if the options ask for one, and the heartbeat.

        Raises:
            UsageError: the guard did not start.
        """
        if self.options.guard:
            from jacaros.runtime.mas.guarding import RunGuard  # here: only for runs with a guard

            options = self.options
            self._guard = RunGuard(options, self.backend(), options.ros_clock, self._log_ros)
            await self._guard.start()

    def backend(self) -> "Backend":
        """Return the node of the agent system in the ROS graph."""
        if self.joined is None:
            self.joined = self._open()
            _finish_at_once(self.joined.start())
            if self.source != NO_WORLD:
                self._start_world(self.companion("world"))
        return self.joined

    def companion(self, name: str) -> Any:
        """Return another node in the in-process graph, such as that of the world or of a test. It ends with the run."""
        from jacaros.robots.ros.open import open_backend

        beside: Any = self.backend()
        made = open_backend("memory", self.clock, name, log=self._log_ros, graph=beside.graph)
        self._companions.append(made)
        _finish_at_once(made.start())
        return made

    def watch_world(self, watcher: "Callable[[World], None]") -> Callable[[], None]:
        """Call *watcher* with the embedded world, now or when it is created. Return a function that ends this."""
        if self.world is not None:
            watcher(self.world)
            return lambda: None
        return entered(self._world_watchers, watcher)

    def catch_up(self) -> None:
        """Let the embedded world make all steps that are due."""
        if self.node is not None:
            self.node.time.catch_up()

    def watch_parameters(self) -> None:
        """Check whether the given parameters are declared. Called when everything has been created."""
        if self.options.parameters:
            self._undeclared = self.clock.call_later(_DECLARING, self.ending)
            self._watches.append(self._undeclared.cancel)

    def ending(self) -> None:
        """Log given parameters that nothing has declared; in any case before the run ends."""
        if self._undeclared is None:
            return
        from jacaros.runtime.mas.graph_warnings import undeclared  # here: few runs are given any

        self._undeclared.cancel()
        self._undeclared = None
        given = self.joined.given_parameters if self.joined is not None else None
        names = self.options.parameters
        unknown, known = (sorted(names), []) if given is None else (given.untaken(), given.known())
        if unknown:
            self._log_ros(undeclared(unknown, known))

    async def close(self) -> None:
        """Stop the robots, then the world, and leave the graph."""
        async with AsyncExitStack() as steps:  # runs in reverse order
            if self._guard is not None:
                steps.push_async_callback(self._guard.close)
            for companion in self._companions:
                steps.push_async_callback(companion.close)
            if self.node is not None:
                steps.callback(self.node.close)
            if self.joined is not None:
                steps.push_async_callback(self.joined.close)
            for close in self._watches:
                steps.callback(close)

    def _open(self) -> "Backend":
        backend = self.options.open(self.clock, self.name, self._log_ros)
        backend.tracer = self._tracer
        return backend

    def trace(self, tracer: "Tracer | None") -> None:
        """Pass each message that reaches our node to *tracer*, from now on."""
        self._tracer = tracer
        if self.joined is not None:
            self.joined.tracer = tracer

    def _follow_clock(self, backend: "Backend") -> None:
        from jacaros.robots.ros.ros_clock import RosClock

        assert isinstance(self.clock, RosClock), "the launch makes the clock that the options ask for"
        self.clock.listen(backend)
        self._watches.append(self.clock.close)

    def _look_for_others(self, backend: "Backend") -> None:
        from jacaros.runtime.mas.graph_warnings import EmptyGraph

        where = f"the ROS 2 graph of domain {self.options.identity}"
        self._watches.append(EmptyGraph(backend, self.clock, where, self._log_ros).close)

    def _log_ros(self, text: str) -> None:
        self.log(f"[ros] {text}")

    def _start_world(self, backend: "Backend") -> None:
        from jacaros.robots.world.data.world import UnknownWorld
        from jacaros.robots.world.node import SimNode
        from jacaros.robots.world.physics.world import World

        source, options, noise = self.source, self.options, self.options.noise
        if source is None:
            # A robot that misses its goal surprises users who have not asked for slipping wheels.
            source, noise = DEFAULT_WORLD, noise or 0.0
        try:
            self.world = World.load(source, options.seed, options.faults, noise)
        except UnknownWorld as unknown:
            if self.source_span is None:
                raise
            raise ProjectError(
                [Diagnostic("error", unknown.message, self.source_span, unknown.help)]
            ) from unknown
        self.world.ground_truth.keep = None if self.options.keep_ground_truth else _GROUND_TRUTH
        self.node = SimNode(self.world, backend, self.clock)
        self.node.start()
        for watcher in tuple(self._world_watchers):
            watcher(self.world)
        self._world_watchers.clear()


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
