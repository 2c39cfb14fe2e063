"""A whole system under faults: agents in a disturbed graph, and an observed robot.

The robot is a separate node in the same process, with its own clock: it can be killed and restarted, and its time can be
set back, while the agents continue. The ground truth is recorded ten times a second.
"""

import asyncio
import copy
import itertools
from collections.abc import Callable
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.drivers.memory.graph import Disturbance, MemoryGraph
from jacaros.robots.ros.open import open_backend
from jacaros.robots.ros.ros_clock import CLOCK_TYPE, RosClock
from jacaros.robots.world.data.ground_truth import GroundTruth
from jacaros.robots.world.files.world import load_world
from jacaros.robots.world.node import SimNode
from jacaros.robots.world.physics.world import World
from jacaros.runtime.clock import Clock, Timer, VirtualClock, run
from jacaros.runtime.mas.launch import load_deployment
from jacaros.runtime.mas.mappings import with_mappings
from jacaros.runtime.mas.options import RunOptions
from jacaros.runtime.mas.ros_graph import RosGraph
from jacaros.runtime.mas.system import System

PROGRAMS = Path(__file__).parent / "programs"

GLANCE = 0.1
"""Seconds between two checks of the robot."""


@dataclass(frozen=True, slots=True)
class Moment:
    """What the robot truly did: m/s and rad/s, and where it was."""

    time: float
    speed: float
    turn_rate: float
    x: float
    y: float

    @property
    def still(self) -> bool:
        """Whether it stood."""
        return self.speed == 0.0 and self.turn_rate == 0.0


class SimulatorClock:
    """The time of a simulator: it passes as that of the laboratory does, from another beginning that can be set back."""

    virtual = False

    def __init__(self, clock: VirtualClock, begin: float) -> None:
        self._clock, self._ahead = clock, begin - clock.now()

    @property
    def elapsed(self) -> float:
        return self._clock.elapsed

    def now(self) -> float:
        return self._clock.now() + self._ahead

    def reset(self, to: float) -> None:
        """Set it back, as a simulator that begins again does."""
        self._ahead = to - self._clock.now()

    def call_later(self, delay: float, callback: Callable[[], None]) -> Timer:
        return self._clock.call_later(delay, callback)

    async def sleep(self, delay: float) -> None:
        await self._clock.sleep(delay)

    def busy(self, cycles: int) -> None:
        self._clock.busy(cycles)


class RobotElsewhere(RosGraph):
    """The graph of a run whose robot runs elsewhere."""

    agents_node: Backend

    async def start(self) -> None:
        """The laboratory creates everything."""

    def backend(self) -> Backend:
        return self.agents_node

    async def close(self) -> None:
        await self.agents_node.close()


@dataclass
class Lab:
    """One run.

    Attributes:
        told: what agents printed, with the seconds since the beginning.
        errors: the other lines of the log.
        moments: what the robot truly did.
    """

    clock: VirtualClock
    robot_clock: Clock
    graph: MemoryGraph
    world: World
    told: list[tuple[float, str]] = field(default_factory=list)
    errors: list[str] = field(default_factory=list)
    moments: list[Moment] = field(default_factory=list)
    exit_code: int | None = None
    _nodes: Any = field(default_factory=lambda: itertools.count(1))

    # Faults

    def at(self, seconds: float, fault: Callable[[], object]) -> None:
        """Inject a fault this number of seconds after the beginning."""
        self.clock.call_later(seconds - self.clock.elapsed, fault)  # type: ignore[arg-type]  # what it gives is dropped

    def node(self, name: str = "", clock: Clock | None = None) -> Backend:
        """A further node in the graph."""
        made = open_backend(
            "memory",
            clock or self.clock,
            name or f"other_{next(self._nodes)}",
            log=self.errors.append,
            graph=self.graph,
        )
        with_no_wait(made.start())
        return made

    def start_robot(self) -> None:
        """Let the robot join the graph at its current pose."""
        self.robot_node = self.node("world", self.robot_clock)
        self.sim = SimNode(self.world, self.robot_node, self.robot_clock)
        self.sim.start()

    def kill_robot(self) -> None:
        """The process that talks to the wheels is gone without a word: they stop for want of commands."""
        self.graph.vanish("/world")
        self.sim.stop()
        world, clock = self.world, self.clock

        def step() -> None:
            if world.robot().moving:
                for _ in range(5):
                    world.step()
                clock.call_later(0.1, step)

        step()

    def change(self, topic: str, type_name: str, change: Callable[[Any], None]) -> Callable[[], None]:
        """Change all messages of a topic in transit, like a faulty driver. Return a function that ends this."""
        publisher = self.node().publisher(topic, type_name)
        forged: dict[int, Any] = {}
        seen: dict[int, Any] = {}
        loop = asyncio.get_running_loop()

        def disturbance(message: Any) -> tuple[float, ...]:
            if id(message) in forged:
                return (0.0,)
            if id(message) not in seen:
                # Kept, so that no other message gets the number.
                seen[id(message)] = message
                false = copy.deepcopy(message)
                change(false)
                forged[id(false)] = false
                loop.call_soon(publisher.publish, false)
            return ()

        end = self.graph.disturb(topic, disturbance)

        def over() -> None:
            end()
            publisher.close()

        return over

    # What was perceived

    @property
    def lines(self) -> list[str]:
        """What agents printed."""
        return [text for _, text in self.told]

    def when(self, beginning: str) -> float:
        """When a line that begins so was printed first; fails when none was."""
        for time, text in self.told:
            if text.startswith(beginning):
                return time
        raise AssertionError(f"{beginning!r} is not among {self.told}")

    # What truly happened

    @property
    def truth(self) -> GroundTruth:
        return self.world.ground_truth

    def stands(self, begin: float, end: float) -> bool:
        """Whether the robot stood all the time between two moments; both are within the run."""
        between = [each for each in self.moments if begin <= each.time <= end]
        assert between, f"the run lasted {self.clock.elapsed:g} s only"
        return all(each.still for each in between)

    def drives(self, begin: float, end: float) -> bool:
        """Whether it moved at some time between two moments."""
        return any(not each.still for each in self.moments if begin <= each.time <= end)

    @property
    def safe(self) -> bool:
        """Return whether the robot stops at the end and never touched anything."""
        return self.moments[-1].still and not self.truth.events_of("bump", "collision", "bad_command")

    @property
    def place(self) -> tuple[float, float]:
        """Where the robot is, rounded to centimetres."""
        robot = self.world.robot()
        return round(robot.x, 2) + 0.0, round(robot.y, 2) + 0.0

    # The port of a run's console

    def print(self, agent: str, text: str) -> None:
        self.told.append((round(self.clock.elapsed, 2), text))

    def log(self, text: str, level: str = "info") -> None:
        self.errors.append(text)


def with_no_wait(coroutine: Any) -> None:
    """Run a coroutine that waits for nothing."""
    try:
        coroutine.send(None)
    except StopIteration:
        return
    raise AssertionError("it waits")


def between(begin: float, end: float, fault: Callable[[Lab], Callable[[], None]]) -> Callable[[Lab], None]:
    """Faults of a run: one that begins at a moment, and that what it returns ends at another."""
    return lambda lab: lab.at(begin, lambda: lab.at(end, fault(lab)))


def disturbed(topic: str, disturbance: Disturbance, begin: float, end: float) -> Callable[[Lab], None]:
    """Faults of a run: messages of a topic are late, repeated or lost from one moment to another."""
    return between(begin, end, lambda lab: lab.graph.disturb(topic, disturbance))


def in_lab(
    program: str,
    faults: Callable[[Lab], None] = lambda lab: None,
    *,
    mapping: str | None = None,
    world: str = "empty",
    seconds: float = 60.0,
    simulated: float | None = None,
    followed: bool = True,
) -> Lab:
    """Run a program of the folder `programs` under faults, to its end or for a number of seconds.

    Args:
        program: its name.
        faults: arranges what goes wrong.
        mapping: mapping file of that folder, or one of those that come with the package, whose artifacts the agent focuses.
        world: where the robot is; its odometry has no noise.
        seconds: longest time; a run that should have ended before tells so by its exit code, which is None.
        simulated: time of the robot's own clock at the beginning; without it there is one clock for all.
        followed: whether that clock is published on ``/clock``, as by a simulator, and the agents follow it.
    """
    clock = VirtualClock()
    robot_clock = clock if simulated is None else SimulatorClock(clock, simulated)
    lab = Lab(clock, robot_clock, MemoryGraph(), World(load_world(world).with_noise(0.0), 0))
    time: Clock = (
        clock if simulated is None or not followed else RosClock(lambda text: lab.log(f"[ros] {text}"))
    )
    deployment = load_deployment(PROGRAMS / program)
    if mapping is not None:
        deployment = with_mappings(deployment, (mapping,))
    timers: list[Timer] = []

    def every(period: float, what: Callable[[], None]) -> None:
        def tick() -> None:
            timers.append(clock.call_later(period, tick))
            del timers[:-10]
            what()

        tick()

    def glance() -> None:
        robot = lab.world.robot()
        lab.moments.append(Moment(round(clock.elapsed, 3), robot.speed, robot.turn_rate, robot.x, robot.y))

    async def main() -> None:
        mas = System(deployment, time, lab, RunOptions(seed=0))
        mas.ros = RobotElsewhere(mas.options, time, "agents", None, lab.log)
        mas.ros.agents_node = open_backend(
            "memory", time, "agents", log=lambda text: lab.log(f"[ros] {text}"), graph=lab.graph
        )
        await mas.ros.agents_node.start()
        lab.start_robot()
        if isinstance(time, RosClock):
            time.listen(mas.ros.agents_node)
            ticks = lab.node("simulator").publisher("/clock", CLOCK_TYPE)
            every(0.02, lambda: ticks.publish(ticks.message(clock=robot_clock.now())))
        every(GLANCE, glance)
        faults(lab)
        timer = clock.call_later(seconds, lambda: mas.end(99))
        lab.exit_code = await mas.run()
        timer.cancel()
        if isinstance(time, RosClock):
            time.close()
        # Commands that are on their way arrive, and the robot obeys.
        await clock.sleep(1.0)
        for each in timers:
            each.cancel()
        lab.sim.close()
        await lab.robot_node.close()

    run(main, clock)
    if lab.exit_code == 99:
        lab.exit_code = None
    return lab
