"""``jacaros ros check --base-timeout``: drive a robot for a moment, send no more commands, and watch its odometry."""

import math
from dataclasses import dataclass
from functools import partial

from jacaros.robots.ros.backend import TopicInfo
from jacaros.robots.ros.guarded import VELOCITIES, velocity
from jacaros.robots.ros.names import near_names
from jacaros.robots.ros.node import Publisher, Sample
from jacaros.runtime.cli.graph.joining import Joined, NothingThere, hearing
from jacaros.runtime.cli.usage import usage_error

ODOMETRY = "nav_msgs/msg/Odometry"
SPEED = 0.05
"""Speed of the drive, in m/s."""
DRIVING = 1.0
"""Seconds of the drive, from the first odometry that shows motion."""
STARTING = 2.0
"""Seconds that the robot has to begin to move."""
WATCHED = 3.0
"""Seconds for which the robot is watched when commands have ceased."""
STOPPING = 3.0
"""Maximum number of seconds for which zero velocity is sent at the end."""
STANDING = 0.5
"""Seconds after which a robot that stands is taken to stay so."""
STILL = 0.01
"""Speed in m/s below which the robot stands: odometry is noisy."""
PERIOD = 0.1
"""Seconds between two commands."""
LOOK = 0.02
"""Seconds between two looks at odometry."""
GUARDED = 0.6
"""Seconds within which a guard stops a robot."""

QUESTION = (
    f"The robot will drive straight ahead at {SPEED:g} m/s, for up to {SPEED * (STARTING + DRIVING + WATCHED):g} m. "
    "Is the way free?"
)


@dataclass(frozen=True, slots=True)
class Ceased:
    """What a base did when commands ceased.

    Attributes:
        seconds: time from the last command until it stood; None if it kept driving for `WATCHED` seconds.
        metres: distance from the last command on.
    """

    seconds: float | None
    metres: float


class Drive:
    """One drive of a robot.

    Args:
        joined: the graph.
        command, odometry: topics of the robot.
    """

    def __init__(self, joined: Joined, command: TopicInfo, odometry: TopicInfo) -> None:
        self._joined, self._clock = joined, joined.clock
        self._type = command.types[0]
        self._publisher: Publisher = joined.backend.publisher(command.name, self._type)
        self._heard = False
        self._speed = self._x = self._y = 0.0
        joined.backend.subscription(odometry.name, ODOMETRY, self._take, hearing(odometry))
        joined.backend.add_exit_hook(partial(self._command, 0.0))

    def _take(self, sample: Sample) -> None:
        position, twist = sample.message.pose.pose.position, sample.message.twist.twist
        self._x, self._y = position.x, position.y
        self._speed = math.hypot(twist.linear.x, twist.linear.y)
        self._heard = True

    async def run(self) -> Ceased:
        """Drive, send no more commands, and watch the robot. Stop it, however this ends.

        Raises:
            NothingThere: the robot was not found, moves already, or does not move.
        """
        try:
            await self._find()
            await self._drive()
            return await self._watch()
        finally:
            await self._stop()

    async def _find(self) -> None:
        within = self._clock.elapsed + self._joined.timeout
        while not (self._publisher.subscription_count and self._heard):
            if self._clock.elapsed > within:
                raise NothingThere(f"no odometry or no base within {self._joined.timeout:g} s")
            await self._clock.sleep(LOOK)
        await self._clock.sleep(2.0 * PERIOD)  # the base may still be discovering our publisher
        if self._speed > STILL:
            raise NothingThere("the robot is already moving; stop it first")

    async def _drive(self) -> None:
        begun = moved = self._clock.elapsed
        while self._clock.elapsed - moved < DRIVING:
            self._command(SPEED)
            await self._clock.sleep(PERIOD)
            if self._speed <= STILL:
                moved = self._clock.elapsed
            if moved - begun > STARTING:
                raise NothingThere(
                    f"odometry shows no motion at {SPEED:g} m/s: the robot may need more to roll, or be blocked, or its "
                    "odometry has no velocity"
                )

    async def _watch(self) -> Ceased:
        """Watch the robot until it has stood for a while."""
        begun = self._clock.elapsed - PERIOD
        x, y, stood = self._x, self._y, math.inf
        while self._clock.elapsed - begun < WATCHED and self._clock.elapsed - stood < STANDING:
            await self._clock.sleep(LOOK)
            stood = math.inf if self._speed > STILL else min(stood, self._clock.elapsed)
        metres = math.hypot(self._x - x, self._y - y)
        return Ceased(None if stood == math.inf else stood - begun, metres)

    async def _stop(self) -> None:
        """Send zero velocity until the robot stands, and a little longer: its odometry may be late."""
        begun = self._clock.elapsed
        while self._clock.elapsed - begun < 5.0 * PERIOD or (
            self._speed > STILL and self._clock.elapsed - begun < STOPPING
        ):
            self._command(0.0)
            await self._clock.sleep(PERIOD)

    def _command(self, speed: float) -> None:
        self._publisher.publish(velocity(self._publisher, self._type, self._clock.now(), speed))


def find_base(joined: Joined, named: set[str], namespace: str) -> tuple[TopicInfo, TopicInfo]:
    """Return the velocity topic and the odometry of a robot.

    Args:
        joined: the graph.
        named: names in a mapping file; they come first.
        namespace: the robot's namespace. A robot in another one is never driven.

    Raises:
        UsageError: no base is found, or several are.
    """
    commands = [info for info in joined.contents.topics.values() if info.subscriptions]
    odometry = [info for info in joined.contents.topics.values() if info.publishers]
    return (
        _topic(joined, "cmd_vel", VELOCITIES, commands, named, namespace),
        _topic(joined, "odom", (ODOMETRY,), odometry, named, namespace),
    )


def _topic(
    joined: Joined,
    usual: str,
    types: tuple[str, ...],
    topics: list[TopicInfo],
    named: set[str],
    namespace: str,
) -> TopicInfo:
    """Return the topic that is named, else that with the usual name, else the only one."""
    found = {info.name: info for info in topics if info.types and info.types[0] in types}
    name = joined.backend.resolve(usual)
    for choice in (named & set(found), {name} & set(found), set() if namespace else set(found)):
        if len(choice) == 1:
            return found[choice.pop()]
    listed = ", ".join(f"`{each}`" for each in near_names(name, sorted(found))) or "none"
    raise usage_error(
        f"unknown robot: no topic `{name}` ({' or '.join(types)}); found {listed}",
        "select it with --namespace, or with a mapping file that names its topics",
    )


def verdict(ceased: Ceased) -> str:
    """Return what to print about a base."""
    way = f"{1000.0 * ceased.metres:.0f} mm further"
    if ceased.seconds is None:
        return (
            f"error: the base was still driving {WATCHED:g} s after the last command, {way}, and was sent zero velocity\n"
            "  = help: start `jacaros guard` on the robot's computer; see docs/how-to/guard_a_robot.md"
        )
    text = f"the base stood {ceased.seconds:.2f} s after the last command, {way}"
    if ceased.seconds > GUARDED:
        text += f"\n  = help: `jacaros guard` on the robot's computer stops it within {GUARDED:g} s"
    return text
