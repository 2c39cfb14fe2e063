"""Records of the environment of a run: artifacts, the ROS graph, and robots with their scans, paths and estimated poses."""

import asyncio
import math
from collections.abc import Callable, Mapping, Sequence
from contextlib import ExitStack
from typing import TYPE_CHECKING, Any, Protocol

from msgspec.structs import replace

from jacaros.look.records import records
from jacaros.look.records.records import RecordSink
from jacaros.robots.ros.backend import Backend, GraphContents
from jacaros.robots.ros.errors import RosError
from jacaros.runtime.clock import Clock, Timer
from jacaros.runtime.mas.agents.lifecycle import AgentLifecycle
from jacaros.runtime.mas.console import RunConsole
from jacaros.runtime.mas.deployment import Deployment
from jacaros.runtime.mas.directory import Directory, Mailboxes
from jacaros.runtime.mas.fleet import Fleet
from jacaros.runtime.mas.history.causes import CauseRecords
from jacaros.runtime.mas.history.environment import EnvironmentRecords, robot_finder
from jacaros.runtime.mas.history.fleet import FleetRecords
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.ros_graph import RosGraph
from jacaros.runtime.mas.scheduler import Scheduler
from jacaros.runtime.trace import Tracer

if TYPE_CHECKING:
    from jacaros.artifacts.env.environment import Environment
    from jacaros.robots.world.node import SimNode

PERIOD = 1.0
"""Seconds between two checks of what does not report its changes."""
ONLY_ROBOT = {"": "robot"}
"""The robot of a real graph whose topics have no namespace, and its name on the page."""


class ObservedSystem(Protocol):
    """A running system (`jacaros.runtime.mas.system.System`, which makes them), for its history and debugger."""

    clock: Clock
    scheduler: Scheduler
    directory: Directory
    lifecycle: AgentLifecycle
    mailboxes: Mailboxes
    ros: RosGraph
    deployment: Deployment
    options: RunOptions
    fleet: Fleet | None
    console: RunConsole

    def trace(self, tracer: Tracer | None) -> None:
        """Let *tracer* create the causes. None ends this."""

    def when_situated(self, callback: "Callable[[Environment], None]") -> Callable[[], None]:
        """Call *callback* with the environment, now or when it is created. Return a function that ends this."""

    def listen_to_log(self, listener: Callable[[str, str], None]) -> Callable[[], None]:
        """Call *listener* with text and level of each line of the log. Return a function that ends this."""


class RunEnvironmentRecords:
    """Records the environment of the agents of a system.

    Args:
        system: the system.
        beginning: seconds of the clock from which times of records count.
        tell: takes the records.

    Attributes:
        causes: numbers the causes of the run.
    """

    def __init__(self, system: ObservedSystem, beginning: float, tell: RecordSink) -> None:
        self._system, self._tell = system, tell
        self._clock = system.clock
        self._moving = RobotRecords(system.clock, tell, self._robot_at, lambda: system.ros.node, self._truths)
        self.causes = CauseRecords(system.clock, beginning, tell, self._moving.listener_of)
        self._environment = EnvironmentRecords(system.clock, tell, robot_finder(self._robots))
        self._graph = GraphRecords(tell, self.causes)
        self._fleet = FleetRecords(lambda: system.fleet, tell)
        self._timer: Timer | None = None
        self._looked = system.clock.elapsed
        self._looking: asyncio.Task[None] | None = None

    def start(self, ends: ExitStack) -> None:
        """Observe until *ends* is closed."""
        system = self._system
        ends.callback(system.listen_to_log(self._logged))
        ends.callback(self.causes.flush, all_of_them=True)
        ends.callback(system.trace, None)
        system.trace(self.causes)
        ends.callback(self._environment.end)
        ends.callback(system.when_situated(self._environment.observe))
        ends.callback(self._stop_looking)
        ends.callback(self._fleet.watch())
        self._look()

    def _stop_looking(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        if self._looking is not None:
            self._looking.cancel()

    def _look(self) -> None:
        self._timer = self._clock.call_later(PERIOD, self._look)
        self._environment.flush()
        self.causes.flush()
        self._moving.look()
        self._fleet.look()
        backend, passed = self._system.ros.joined, self._clock.elapsed - self._looked
        is_looking = self._looking is not None and not self._looking.done()
        if backend is not None and passed >= self._graph.pause and not is_looking:
            self._looked = self._clock.elapsed
            self._looking = asyncio.get_running_loop().create_task(self._graph.look(backend, passed))

    def _logged(self, text: str, level: str) -> None:
        if level != "debug":
            self._tell(records.LogRecord(level, text))

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


# ---- the graph

GRAPH_PERIOD = 3.0
"""Seconds between two checks of a changing graph."""
_CHANGED = 0.5
"""Relative change of a rate that causes a new record."""
_MOST_TOPICS = 300


class GraphRecords:
    """Makes the record ``graph`` when something has changed.

    Args:
        tell: takes the records.
        messages: counts the messages of our node.

    Attributes:
        pause: seconds until the next check; longer while nothing changes.
    """

    def __init__(self, tell: RecordSink, messages: CauseRecords) -> None:
        self._tell, self._messages = tell, messages
        self._recorded: list[records.TopicRecord] | None = None
        self.pause = GRAPH_PERIOD

    async def look(self, backend: Backend, seconds: float) -> None:
        """Check the graph, *seconds* after the last check."""
        try:
            contents = await backend.contents()
        except RosError:  # the graph may be unreachable for a while
            return
        counts = self._counts(backend)
        topics = self._topics(contents, counts, seconds, backend.node_name)
        self.pause = min(10.0 * GRAPH_PERIOD, 2.0 * self.pause)
        if self._recorded is None or _differ(self._recorded, topics):
            if self._recorded is None or len(self._recorded) != len(topics):
                self.pause = GRAPH_PERIOD
            self._recorded = topics
            self._tell(records.GraphRecord(backend.node_name, topics))

    def _counts(self, backend: Backend) -> dict[tuple[str, str], float]:
        """Return the number of messages since the last call, by topic and direction."""
        counts: dict[tuple[str, str], float] = {}
        for traffic in self._messages.sent.values():
            counts[traffic.topic, "out"] = traffic.count
            traffic.count = 0
        for traffic in self._messages.received.values():
            # All our subscriptions to a topic, such as an artifact's and the page's, count the same messages.
            counts[traffic.topic, "in"] = traffic.count / max(1, backend.receivers(traffic.topic))
            traffic.count = 0
        return counts

    def _topics(
        self, contents: GraphContents, counts: Mapping[tuple[str, str], float], seconds: float, node: str
    ) -> list[records.TopicRecord]:
        rows = []
        for name, info in sorted(contents.topics.items())[:_MOST_TOPICS]:
            ours = ""
            if (name, "in") in counts or any(each.node == node for each in info.subscriptions):
                ours = "in"
            if (name, "out") in counts or any(each.node == node for each in info.publishers):
                ours = "out"
            rate = round(counts.get((name, ours), 0) / seconds, 1) if ours else 0.0
            publishers, subscribers = len(info.publishers), len(info.subscriptions)
            rows.append(records.TopicRecord(name, ", ".join(info.types), publishers, subscribers, ours, rate))
        return rows


def _differ(before: list[records.TopicRecord], now: list[records.TopicRecord]) -> bool:
    if len(before) != len(now):
        return True
    return any(
        replace(old, rate=new.rate) != new or abs(old.rate - new.rate) > max(1.0, _CHANGED * old.rate)
        for old, new in zip(before, now, strict=True)
    )


# ---- robots

MOST_RAYS = 90
SCAN_PERIOD = 0.1
"""Seconds between two recorded scans of one topic."""
OFF = (0.05, math.radians(5.0))
"""Difference in metres and radians from the true pose up to which an estimate counts as equal."""
_SCAN = "LaserScan"
_PATH = "Path"

Truths = Callable[[], Mapping[str, tuple[float, float, float]]]
"""Returns the true pose of each robot: x, y, yaw."""


class RobotRecords:
    """Makes the records ``laser``, ``path`` and ``believed``.

    Args:
        clock: clock of the run.
        tell: takes the records.
        robot_at: returns a robot's name for a topic prefix, such as ``/robot_0``.
        find_robots: returns the node of the embedded world, or None.
        truths: returns their true poses.
    """

    def __init__(
        self,
        clock: Clock,
        tell: RecordSink,
        robot_at: Callable[[str], str],
        find_robots: "Callable[[], SimNode | None]",
        truths: Truths,
    ) -> None:
        self._clock, self._tell, self._robot_at = clock, tell, robot_at
        self._find_robots, self._truths = find_robots, truths
        self._scanned: dict[str, float] = {}
        self._paths: dict[str, Sequence[tuple[float, float]]] = {}
        self._astray: set[str] = set()

    def listener_of(self, message: Any) -> Callable[[str, Any], None] | None:
        """Return what records messages such as this one (scans and paths), or None."""
        kind = type(message).__name__
        if kind.endswith(_SCAN):
            return self._scan
        return self._planned if kind.endswith(_PATH) and hasattr(message, "poses") else None

    def _planned(self, topic: str, path: Any) -> None:
        points = [(pose.pose.position.x, pose.pose.position.y) for pose in path.poses]
        self._path(self._robot_at(topic.rpartition("/")[0]), points)

    def _scan(self, topic: str, scan: Any) -> None:
        now = self._clock.elapsed
        # Slightly less, because scans at 10 Hz do not arrive at exact intervals.
        if now - self._scanned.get(topic, -SCAN_PERIOD) < 0.9 * SCAN_PERIOD:
            return
        self._scanned[topic] = now
        robot = self._robot_at(topic.rpartition("/")[0])
        self._tell(thinned(robot, scan))

    def look(self) -> None:
        """Record paths and estimated poses that have changed. Call it a few times a second."""
        robots = self._find_robots()
        if robots is None:
            return
        for robot, path in robots.paths().items():
            if path is not self._paths.get(robot, ()) and (path or self._paths.get(robot)):
                self._path(robot, path)
        truths = self._truths()
        for robot, (x, y, yaw) in robots.beliefs().items():
            true_x, true_y, true_yaw = truths[robot]
            turned = math.remainder(yaw - true_yaw, math.tau)
            self._belief(
                robot, x, y, yaw, math.hypot(x - true_x, y - true_y) > OFF[0] or abs(turned) > OFF[1]
            )

    def _path(self, robot: str, path: Sequence[tuple[float, float]]) -> None:
        self._paths[robot] = path
        self._tell(records.PathRecord(robot, [(round(x, 3), round(y, 3)) for x, y in path]))

    def _belief(self, robot: str, x: float, y: float, yaw: float, astray: bool) -> None:
        if astray:
            self._astray.add(robot)
            self._tell(records.BelievedRecord(robot, round(x, 3), round(y, 3), round(yaw, 3)))
        elif robot in self._astray:
            self._astray.discard(robot)
            self._tell(records.BelievedRecord(robot))


def thinned(robot: str, scan: Any) -> records.LaserRecord:
    """Return a scan with at most `MOST_RAYS` rays: of adjacent rays the shortest, in whole centimetres."""
    ranges = scan.ranges
    share = max(1, math.ceil(len(ranges) / MOST_RAYS))
    least, most = scan.range_min, scan.range_max
    rays = []
    for start in range(0, len(ranges), share):
        # NaN fails both comparisons, infinity the second.
        seen = [metres for metres in ranges[start : start + share] if least <= metres <= most]
        rays.append(round(100.0 * float(min(seen))) if seen else 0)
    middle = 0.5 * (share - 1) * scan.angle_increment
    first, step = float(scan.angle_min + middle), float(scan.angle_increment * share)
    return records.LaserRecord(robot, round(first, 5), round(step, 6), rays)
