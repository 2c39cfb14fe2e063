"""A laboratory for tests: a virtual clock, a ROS graph in memory, the embedded world, and a workspace."""

import asyncio
import math
from collections.abc import Awaitable, Callable
from typing import Any, cast

import pytest

from jacaros.artifacts import (
    Artifact,
    ArtifactId,
    Environment,
    Observation,
    OperationExecution,
    OperationOutcome,
    OperationRequest,
)
from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.node import Capability, Sample
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.qos import QoS
from jacaros.robots.world import SimNode, World
from jacaros.robots.world.files.world import load_world
from jacaros.runtime.clock import VirtualClock, run

TWIST = "geometry_msgs/msg/Twist"
STANDSTILL = (0.0, 0.0)


def made(
    kind: type[Artifact], *arguments: object, recorded: bool = False, on_graph: bool = False
) -> pytest.MarkDecorator:
    """The mark of a test whose parameters are an `artifact` of that kind, and the `watcher` that observes it.

    *on_graph*: a subscription that the test makes later is like one that is matched late.
    """
    return pytest.mark.makes.with_args(kind, *arguments, recorded=recorded, on_graph=on_graph)


class Watcher:
    """An observer that stores its observations.

    Attributes:
        believed: values of the properties by name, the newest; all of them in `all_believed`.
        changes: (name, values) of every change, in order.
        signals: (name, arguments) of every signal.
        times: when each change came, in seconds of the run.
    """

    agent = "watcher"

    def __init__(self, clock: VirtualClock) -> None:
        self.clock = clock
        self.changes: list[tuple[str, tuple[object, ...]]] = []
        self.signals: list[tuple[str, tuple[object, ...]]] = []
        self.times: list[float] = []
        self.held: dict[object, tuple[str, tuple[object, ...]]] = {}
        self.observations: list[Observation] = []

    def observe(self, observation: Observation) -> None:
        self.observations.append(observation)
        self.signals += [(signal.name, signal.arguments) for signal in observation.signals]
        for removed in observation.removed:
            self.held.pop(removed.key, None)
        for now in (*(new for _, new in observation.changed), *observation.added):
            self.held[now.key] = (now.name, now.values)
            self.changes.append((now.name, now.values))
            self.times.append(round(self.clock.elapsed, 6))

    def values(self, name: str) -> list[tuple[object, ...]]:
        """The successive values of the property *name*."""
        return [values for changed, values in self.changes if changed == name]

    def holds(self, name: str) -> list[tuple[object, ...]]:
        """The values of all properties called *name* now."""
        return [values for held, values in self.held.values() if held == name]


class Run:
    """An operation that was asked for."""

    def __init__(
        self, execution: OperationExecution, done: "asyncio.Future[OperationOutcome]", clock: VirtualClock
    ) -> None:
        self.execution, self.done, self.clock = execution, done, clock

    @property
    def outcome(self) -> OperationOutcome | None:
        return self.done.result() if self.done.done() else None

    @property
    def reason(self) -> str:
        """The failure reason as text."""
        assert self.outcome is not None
        return str(self.outcome.reason)

    @property
    def message(self) -> str:
        """What the failure says to people."""
        assert self.outcome is not None
        return self.outcome.message or ""

    @property
    def ok(self) -> bool:
        """Whether it has succeeded; it must have ended."""
        assert self.outcome is not None
        return self.outcome.ok

    async def pause(self, seconds: float) -> None:
        """Suspend its intention, and wait that long."""
        self.execution.pause()
        await self.clock.sleep(seconds)

    async def drop(self, seconds: float) -> None:
        """Drop its intention, and wait that long."""
        self.execution.cancel()
        await self.clock.sleep(seconds)

    async def resumed(self) -> None:
        """Resume its suspended intention, and wait for its end."""
        self.execution.resume()
        await self.done


class Lab:
    """One run: a world, and artifacts that reach it over topics.

    Attributes:
        commands: (time, linear, angular) of every velocity command on the watched topics.
    """

    def __init__(self, clock: VirtualClock, backend: Backend, world: World | None) -> None:
        self.clock, self.backend, self.world = clock, backend, cast(World, world)  # of a lab that has one
        self.environment = Environment(clock, {"ros": backend}, log=self.take_log)
        self.workspace = self.environment.workspace("/main")
        self.logged: list[str] = []
        self.nodes: list[Backend] = []
        self.commands: list[tuple[float, float, float]] = []
        self.sim = SimNode(world, backend, clock) if world is not None else None

    def take_log(self, text: str) -> None:
        self.logged.append(text)

    def match_late(self) -> None:
        """From now on a subscription that a test makes is like one that is matched late."""
        self.backend.capabilities |= {Capability.DISCOVERY}  # type: ignore[misc]  # the graph in memory has none

    def record(self, topic: str = "/cmd_vel") -> None:
        self.backend.subscription(topic, TWIST, self._command)

    def _command(self, sample: Sample) -> None:
        twist = sample.message
        self.commands.append((round(self.clock.elapsed, 6), twist.linear.x, twist.angular.z))

    @property
    def last_command(self) -> tuple[float, float]:
        return self.commands[-1][1:]

    async def node(self, name: str) -> Any:
        """Another node of the graph, which is closed with the laboratory."""
        node = open_backend("memory", self.clock, name, log=lambda text: None, graph=self.backend.graph)  # type: ignore[attr-defined]
        await node.start()
        self.nodes.append(node)
        return node

    async def make(self, kind: type[Artifact], *arguments: object, name: str = "") -> ArtifactId:
        number = len(self.workspace.artifacts())
        return await self.workspace.make_artifact(name or f"a{number}", kind, arguments)

    def say(self, topic: str, kind: str, *qos: QoS, **fields: object) -> None:
        """Publish one message."""
        publisher = self.backend.publisher(topic, kind, *qos)
        publisher.publish(publisher.message(**fields))

    def hear(self, topic: str, kind: str) -> list[Any]:
        """The messages of a topic from now on."""
        heard: list[Any] = []
        self.backend.subscription(topic, kind, lambda sample: heard.append(sample.message))
        return heard

    def watch(self, artifact: ArtifactId) -> Watcher:
        watcher = Watcher(self.clock)
        self.workspace.focus(artifact, watcher)
        return watcher

    def begin(self, artifact: ArtifactId, operation: str, *arguments: object) -> Run:
        done: asyncio.Future[OperationOutcome] = asyncio.get_running_loop().create_future()
        request = OperationRequest(artifact, operation, arguments, "tester", None, done.set_result)
        return Run(self.workspace.execute(request), done, self.clock)

    async def begun(self, seconds: float, artifact: ArtifactId, operation: str, *arguments: object) -> Run:
        """Begin an operation, and wait that many seconds."""
        run = self.begin(artifact, operation, *arguments)
        await self.sleep(seconds)
        return run

    async def call(self, artifact: ArtifactId, operation: str, *arguments: object) -> Run:
        """Run an operation to its end."""
        started = self.begin(artifact, operation, *arguments)
        await started.done
        return started

    async def do(self, artifact: ArtifactId, operation: str, *arguments: object) -> None:
        """Run an operation that must succeed."""
        outcome = (await self.call(artifact, operation, *arguments)).outcome
        assert outcome is not None
        assert outcome.ok, f"{operation}: {outcome.message} {outcome.reason}"

    async def sleep(self, seconds: float) -> None:
        await self.clock.sleep(seconds)

    def pose(self, robot: str | None = None) -> tuple[float, float, float]:
        """The robot's true pose: metres, metres, degrees."""
        assert self.sim is not None
        self.sim.time.catch_up()
        x, y, yaw = self.world.robot(robot).pose
        return x, y, math.degrees(yaw)

    def speed(self, robot: str | None = None) -> tuple[float, float]:
        assert self.sim is not None
        self.sim.time.catch_up()
        state = self.world.robot(robot)
        return state.speed, state.turn_rate


def in_lab(body: Callable[[Lab], Awaitable[Any]], world: str | None = "empty") -> Lab:
    """Run *body* in a laboratory; everything is disposed and closed at the end.

    *world* is the text of a world file, or the name of a shipped world, which then has no noise.
    """
    clock = VirtualClock()
    labs = []

    async def main() -> None:
        backend = open_backend("memory", clock, "lab", log=lambda text: None)
        await backend.start()
        made = (
            None
            if world is None
            else World.load(world)
            if "\n" in world
            else World(load_world(world).with_noise(0.0))
        )
        lab = Lab(clock, backend, made)
        labs.append(lab)
        if lab.sim is not None:
            lab.sim.start()
        try:
            await body(lab)
        finally:
            await lab.environment.close()
            for node in lab.nodes:
                await node.close()
            if lab.sim is not None:
                lab.sim.close()
            await backend.close()

    run(main, clock)
    return labs[0]


def apart(a: tuple[float, float, float], b: tuple[float, float, float]) -> tuple[float, float]:
    """Metres and degrees between two poses."""
    turned = math.degrees(math.remainder(math.radians(a[2] - b[2]), math.tau))
    return math.hypot(a[0] - b[0], a[1] - b[1]), abs(turned)


def assert_at(
    lab: Lab, x: float, y: float, heading: float, metres: float = 0.01, degrees: float = 0.5
) -> None:
    distance, turned = apart(lab.pose(), (x, y, heading))
    assert distance < metres, lab.pose()
    assert turned < degrees, lab.pose()
