"""Records of the environment of a run: artifacts, robots and the ROS graph."""

import asyncio
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Protocol

from jacaros.mas.agents.lifecycle import AgentLifecycle
from jacaros.mas.deployment import Deployment
from jacaros.mas.directory import Directory, Mailboxes
from jacaros.mas.history.causes import CauseRecords
from jacaros.mas.history.environment import EnvironmentRecords, robot_finder
from jacaros.mas.history.graph import GraphRecords
from jacaros.mas.history.robots import RobotRecords
from jacaros.mas.options import RunOptions
from jacaros.mas.ros_graph import RosGraph
from jacaros.mas.scheduler import Scheduler
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.trace import Tracer

if TYPE_CHECKING:
    from jacaros.artifacts.env.environment import Environment

PERIOD = 1.0
"""Seconds between two checks of what does not report its changes."""
ONLY_ROBOT = {"": "robot"}
"""The robot of a real graph whose topics have no namespace, and its name on the page."""

Tell = Callable[[str, Mapping[str, Any]], None]


class ObservedSystem(Protocol):
    """A running system, as its history and its debugger see it (`jacaros.mas.system.System`)."""

    clock: Clock
    scheduler: Scheduler
    directory: Directory
    lifecycle: AgentLifecycle
    mailboxes: Mailboxes
    ros: RosGraph
    deployment: Deployment
    options: RunOptions

    def trace(self, tracer: Tracer | None) -> None:
        """Let *tracer* create the causes. None ends this."""

    def when_situated(self, callback: "Callable[[Environment], None]") -> Callable[[], None]:
        """Call *callback* with the environment, now or when it is created. Return a function that ends this."""

    def listen_to_log(self, callback: Callable[[str, str], None]) -> Callable[[], None]:
        """Call *callback* with text and level of each line of the log. Return a function that ends this."""


class RunEnvironmentRecords:
    """Records the environment of the agents of a system. `start` returns a function that ends this.

    Args:
        system: the system.
        beginning: seconds of the clock from which times of records count.
        tell: takes the kind of a record and its data.

    Attributes:
        causes: numbers the causes of the run.
    """

    def __init__(self, system: ObservedSystem, beginning: float, tell: Tell) -> None:
        self._system, self._tell = system, tell
        self._clock = system.clock
        self.causes = CauseRecords(system.clock, beginning, tell, self._listener_of)
        self._environment = EnvironmentRecords(system.clock, tell, robot_finder(self._robots))
        self._graph = GraphRecords(tell, self.causes)
        self._moving = RobotRecords(system.clock, tell, self._robot_at, lambda: system.ros.node, self._truths)
        self._timer: Timer | None = None
        self._looked = system.clock.elapsed
        self._looking: asyncio.Task[None] | None = None

    def start(self) -> Callable[[], None]:
        """Begin to observe. Return a function that ends this."""
        system = self._system
        ends = (
            system.when_situated(self._environment.observe),
            self._environment.end,
            self.causes.listen_to(system.trace),
            system.listen_to_log(self._logged),
        )
        self._look()

        def end() -> None:
            if self._timer is not None:
                self._timer.cancel()
            if self._looking is not None:
                self._looking.cancel()
            for each in ends:
                each()

        return end

    def _look(self) -> None:
        self._timer = self._clock.call_later(PERIOD, self._look)
        self._environment.flush()
        self.causes.flush()
        self._moving.look()
        backend, passed = self._system.ros.joined, self._clock.elapsed - self._looked
        is_looking = self._looking is not None and not self._looking.done()
        if backend is not None and passed >= self._graph.pause and not is_looking:
            self._looked = self._clock.elapsed
            self._looking = asyncio.get_running_loop().create_task(self._graph.look(backend, passed))

    def _listener_of(self, message: Any) -> Callable[[str, Any], None] | None:
        return self._moving.listener_of(message)

    def _logged(self, text: str, level: str) -> None:
        if level != "debug":
            self._tell("log", {"level": level, "text": text})

    # ---- robots

    def _robots(self) -> Mapping[str, str]:
        world = self._system.ros.world
        if world is None:
            joined = self._system.ros.joined
            return {} if joined is None or joined.name == "memory" else ONLY_ROBOT
        names = {robot.description.namespace.strip("/"): name for name, robot in world.robots.items()}
        return {f"/{namespace}" if namespace else "": name for namespace, name in names.items()}

    def _robot_at(self, prefix: str) -> str:
        return self._robots().get(prefix) or prefix.strip("/") or "robot"

    def _truths(self) -> Mapping[str, tuple[float, float, float]]:
        world = self._system.ros.world
        if world is None:
            return {}
        return {name: (robot.x, robot.y, robot.yaw) for name, robot in world.robots.items()}
