"""What a node drives, and what interrupts its motions: shared by its artifacts, its heartbeat and its motions."""

from collections import Counter
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import Any
from weakref import WeakKeyDictionary, WeakSet

from jacaros.robots.ros.backend import Backend
from jacaros.robots.ros.node import Publisher

STAMPED = "geometry_msgs/msg/TwistStamped"
VELOCITIES = ("geometry_msgs/msg/Twist", STAMPED)
"""Types of the messages that command a velocity."""

GuardedName = tuple[str, str]
"""Absolute name and type of a topic or an action."""


def velocity(publisher: Publisher, type_name: str, now: float, forward: float = 0.0) -> Any:
    """Return a message that commands a velocity straight ahead.

    Args:
        publisher: sends it.
        type_name: one of `VELOCITIES`.
        now: the time for a stamp. A stamp of 0.0 means "now", but some bases require a real one.
        forward: m/s.
    """
    twist = {"linear": {"x": forward}}
    return (
        publisher.message(header={"stamp": now}, twist=twist)
        if type_name == STAMPED
        else publisher.message(**twist)
    )


def guards_of(node: str) -> set[str]:
    """Return the names of the guards of a node: the one on the robot's computer, and the one that the run starts."""
    return {f"{node}_guard", f"{node}_local_guard"}


class Guarded:
    """The velocity topics and actions of one node, which a guard stops if the node no longer can.

    Attributes:
        on_change: called after an addition or removal.
        found: of each guard, the number of receivers that it has found, by the name of the topic or action.
    """

    def __init__(self) -> None:
        self.on_change: Callable[[], None] = lambda: None
        self.found: dict[str, Mapping[str, int]] = {}
        self._topics: Counter[GuardedName] = Counter()
        self._actions: Counter[GuardedName] = Counter()
        self._on_drive: Callable[[], None] | None = None
        self._publishers: WeakSet[Publisher] = WeakSet()
        self._moving: set[str] = set()
        self._goals = 0
        self._motions: list[Callable[[], None]] = []
        self._drives: list[Callable[[], None]] = []
        self._reported: set[GuardedName] = set()

    @property
    def topics(self) -> list[GuardedName]:
        """The open velocity topics, sorted."""
        return sorted(self._topics)

    @property
    def actions(self) -> list[GuardedName]:
        """The actions with a client, sorted."""
        return sorted(self._actions)

    def covered(self, name: str, receivers: int) -> bool:
        """Return whether every guard has found as many *receivers* of a topic or action as this node has.

        A guard joins the graph later than this node. Until it is matched, its zero velocity reaches no base.
        """
        ready = all(found.get(name, 0) >= receivers for found in self.found.values())
        return ready or name not in dict((*self._topics, *self._actions))

    @property
    def driving(self) -> bool:
        """Whether the robot may be moving: its last velocity was not zero, or a goal is running."""
        return bool(self._moving or self._goals)

    @contextmanager
    def goal(self) -> Iterator[None]:
        """Note that a goal is running."""
        self._goals += 1
        if self._on_drive is not None:
            self._on_drive()
        try:
            yield
        finally:
            self._goals -= 1

    def announce(self, on_drive: Callable[[], None] | None) -> None:
        """Call *on_drive* before the first command that moves the robot after it stood; None: no longer.

        Only then are the velocities noted that the robot is sent, so `driving` is not known before.
        """
        self._on_drive = on_drive
        for publisher in self._publishers:
            self.watch(publisher)

    def watch(self, publisher: Publisher) -> None:
        """Note the velocities that *publisher* sends, from the first call of `announce` on."""
        self._publishers.add(publisher)
        publisher.watcher = self._on_drive and partial(self._note, publisher.topic, self._on_drive)

    def _note(self, topic: str, on_drive: Callable[[], None], message: Any) -> None:
        twist = getattr(message, "twist", message)
        ahead, turn = twist.linear, twist.angular
        # NaN is true, too.
        if not (ahead.x or ahead.y or ahead.z or turn.x or turn.y or turn.z):
            self._moving.discard(topic)
        elif topic not in self._moving:
            self._moving.add(topic)
            on_drive()

    def add_topic(self, name: str, type_name: str) -> Callable[[], None]:
        """Add a velocity topic. Return a function that removes it."""
        return self._add(self._topics, (name, type_name))

    def add_action(self, name: str, type_name: str) -> Callable[[], None]:
        """Add an action. Return a function that removes it."""
        return self._add(self._actions, (name, type_name))

    def _add(self, group: Counter[GuardedName], item: GuardedName) -> Callable[[], None]:
        def remove() -> None:
            group[item] -= 1
            if group[item] <= 0:
                del group[item]
                self.on_change()

        group[item] += 1
        if group[item] == 1:
            self.on_change()
        return remove

    def is_news(self, publisher: GuardedName) -> bool:
        """Return whether a topic and another node that publishes on it are reported for the first time."""
        news = publisher not in self._reported
        self._reported.add(publisher)
        return news

    def on_standstill(self, command: Callable[[], None]) -> Callable[[], None]:
        """Call *command*, which commands zero velocity, when the run is paused. Return a function that removes it."""
        self._drives.append(command)
        return lambda: self._drives.remove(command)

    def stand_still(self) -> None:
        """Command zero velocity to everything the node drives; motions continue with their next command."""
        for command in list(self._drives):
            command()

    def on_interruption(self, callback: Callable[[], None]) -> Callable[[], None]:
        """Call *callback*, on the loop, when a guard has stopped the robot. Return a function that removes it."""
        self._motions.append(callback)
        return lambda: self._motions.remove(callback)

    def interrupt(self) -> None:
        """Interrupt all motions: a guard has stopped the robot meanwhile."""
        for callback in list(self._motions):
            callback()


_guarded: WeakKeyDictionary[Backend, Guarded] = WeakKeyDictionary()


def guarded_by(backend: Backend) -> Guarded:
    """Return what the node of *backend* drives: the same object for the same backend."""
    return _guarded.setdefault(backend, Guarded())
