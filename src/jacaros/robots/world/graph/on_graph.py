"""The world, and a robot of it, on a clock and a ROS graph."""

import math
from collections.abc import Awaitable, Callable, Mapping
from contextlib import suppress
from typing import Any, Final, NoReturn, TypeVar, cast

from jacaros.robots.ros.action import Abort, ActionPolicy, GoalCallback, GoalStatus, ServerGoal
from jacaros.robots.ros.backend import Backend, Sample
from jacaros.robots.ros.errors import RosError, UnknownInterface
from jacaros.robots.ros.message import stamp
from jacaros.robots.ros.names import result_type
from jacaros.robots.ros.node import Capability, Closable, Publisher
from jacaros.robots.ros.qos import DEFAULT_QOS, QoS
from jacaros.robots.ros.services import Handler
from jacaros.robots.world.physics.localisation import SimulatedLocalisation
from jacaros.robots.world.physics.robot import Robot
from jacaros.robots.world.physics.world import STEP, World
from jacaros.runtime.clock import Clock

TICKS_PER_SECOND: Final = 20
SET_BACK = 0.1
"""Seconds that a clock must be behind the world to count as set back; rounding errors are smaller."""
LATCHED: Final = QoS(durability="transient_local", depth=1)
_NEARLY = 1e-3
"""Fraction of a step by which a rounding error may make a step seem not yet due."""

E = TypeVar("E", bound=Closable)


class WorldTime:
    """The time of a world on a clock.

    A world is visible only through its messages. It is therefore stepped just before a message is published or a command
    arrives, several steps of 20 ms in a row. A command takes effect at the first step after its arrival, exactly as if the
    steps had been made one by one, and a virtual run need not stop fifty times a second.

    Attributes:
        world: the world.
        clock: the clock.
        epoch: the clock's time at which the world's time was 0, in seconds.
    """

    def __init__(self, world: World, clock: Clock) -> None:
        self.world, self.clock = world, clock
        self.epoch = clock.now() - world.time

    def catch_up(self) -> None:
        """Make all steps that are due now."""
        due = math.floor(self.passed() / STEP + _NEARLY) - round(self.world.time / STEP)
        for _ in range(due):
            self.world.step()

    def passed(self) -> float:
        """Seconds since the world began; if the clock is set back, the world continues from its current state."""
        passed = self.clock.now() - self.epoch
        if passed < self.world.time - SET_BACK:
            self.epoch = self.clock.now() - self.world.time
            return self.world.time
        return passed

    def now(self) -> float:
        """Time of the current state on the clock (seconds): the stamp of its messages."""
        return self.epoch + self.world.time


class Overtaken(Exception):
    """Raised when a newer goal has claimed what a goal needs."""

    def __init__(self) -> None:
        super().__init__("preempted by a newer goal")


class ActiveGoal:
    """An active goal of an action.

    Attributes:
        request: goal message.
        feedback: sends fields of a feedback message to the client.
    """

    def __init__(self, backend: Backend, type_name: str, served: ServerGoal) -> None:
        self._backend, self._type_name = backend, type_name
        self.request = served.request
        self.feedback = served.feedback

    def abort(self, why: str, /, **result: Any) -> NoReturn:
        """Abort the goal, with a reason and fields of the result."""
        raise Abort(why, self.result({**result, "error_msg": why}))

    def result(self, fields: Mapping[str, Any]) -> dict[str, Any]:
        """Remove fields that the installed release of the action lacks (``error_msg`` came with Kilted)."""
        known = self._backend.fields(result_type(self._type_name))
        return {name: value for name, value in fields.items() if name in known}


GoalExecution = Callable[[ActiveGoal], Awaitable[Mapping[str, Any]]]


class OnGraph:
    """What the world offers on a ROS graph, as far as the types are installed; it closes together.

    Args:
        time: the world on a clock.
        backend: graph; already started.
    """

    def __init__(self, time: WorldTime, backend: Backend) -> None:
        self.time, self.backend = time, backend
        self._entities: list[Closable] = []

    def name(self, name: str) -> str | None:
        """Return the name on the graph for a name of the simulator; None if it is not offered."""
        return name

    def keep(self, entity: E) -> E:
        """Close an entity of the graph with the others; return it."""
        self._entities.append(entity)
        return entity

    def close(self) -> None:
        """Withdraw everything; active goals are aborted."""
        for entity in self._entities:
            entity.close()
        self._entities.clear()

    def publisher(
        self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS, optional: bool = False
    ) -> Publisher:
        """Make a publisher, reliable by default.

        If the topic is not offered, or the type of an *optional* one is not installed, it has no subscriptions, and nothing
        may be published.
        """
        name = self.name(topic)
        with suppress(*((UnknownInterface,) if optional else ())):
            if name is not None:
                return self.keep(self.backend.publisher(name, type_name, qos))
        return cast(Publisher, _Silent())

    def subscribe(self, topic: str, type_name: str, callback: Callable[[Sample], object]) -> None:
        """Call back with each message, after the world has caught up; not if the type is not installed."""
        name = self.name(topic)

        def receive(sample: Sample) -> None:
            self.time.catch_up()
            callback(sample)

        with suppress(UnknownInterface):
            if name is not None:
                self.keep(self.backend.subscription(name, type_name, receive))

    def service(self, name: str, type_name: str, handler: Handler) -> None:
        """Offer a service; if its type is unknown, log a warning instead."""
        self._offer("service", name, type_name, lambda to: self.backend.service(to, type_name, handler))

    def switch(self, name: str, switch: Callable[[bool], str | None]) -> None:
        """Offer a service that switches on or off; *switch* returns why it cannot, or None."""

        def answer(request: Any) -> Mapping[str, Any]:
            self.time.catch_up()
            problem = switch(bool(request.data))
            return {"success": problem is None, "message": problem or ""}

        self.service(name, "std_srvs/srv/SetBool", answer)

    def action(
        self,
        name: str,
        type_name: str,
        execute: GoalExecution,
        accept: GoalCallback | None = None,
        overtaken: GoalStatus = GoalStatus.ABORTED,
    ) -> None:
        """Offer an action whose newer goals preempt older ones, which then end as *overtaken*.

        If the type of the action is unknown, log a warning instead.
        """

        async def carry_out(served: ServerGoal) -> Any:
            goal = ActiveGoal(self.backend, type_name, served)
            try:
                return goal.result(await execute(goal))
            except Overtaken as overtaken:
                goal.abort(str(overtaken), success=False)

        policy = ActionPolicy(accept=accept, preempt=True, overtaken=overtaken)
        if Capability.ACTIONS in self.backend.capabilities:
            self._offer(
                "action",
                name,
                type_name,
                lambda to: self.backend.action_server(to, type_name, carry_out, policy),
            )

    def _offer(self, what: str, name: str, type_name: str, offer: Callable[[str], Closable]) -> None:
        offered = self.name(name)
        if offered is None:
            return
        try:
            self.keep(offer(offered))
        except UnknownInterface:
            with suppress(RosError):
                self.backend.rosout("warn", f"{what} {offered} is not offered: unknown type {type_name}")


class _Silent:
    """Stands for the publisher of a topic that is not offered."""

    subscription_count = 0


class RobotOnGraph(OnGraph):
    """A robot of the world with its access to a ROS graph, below its namespace and as far as its kind has the names.

    Args:
        time: the world on a clock.
        robot: robot of that world.
        backend: graph; already started.
        localisation: its estimated pose.

    Attributes:
        prefix: prefix of the robot's topics, services and actions.
        frame_prefix: prefix of its frames.
    """

    def __init__(
        self,
        time: WorldTime,
        robot: Robot,
        backend: Backend,
        localisation: SimulatedLocalisation,
    ) -> None:
        super().__init__(time, backend)
        self.robot = robot
        self.localisation = localisation
        namespace = robot.description.namespace
        self.prefix = f"/{namespace}" if namespace else ""
        self.frame_prefix = f"{namespace}/" if namespace else ""

    def name(self, name: str) -> str | None:
        """Return the robot's name; None if its kind does not have it."""
        return self.robot.description.interface.name_of(name, self.prefix)

    def fill_header(self, header: Any, frame: str) -> None:
        """Fill a header with the time of the world and a frame of the robot."""
        stamp(header.stamp, self.time.now())
        header.frame_id = self.frame_prefix + frame
