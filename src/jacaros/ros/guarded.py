"""What a node drives, and what interrupts its motions: shared by its artifacts, its heartbeat and its motions."""

from collections import Counter
from collections.abc import Callable, Mapping
from weakref import WeakKeyDictionary

from jacaros.ros.backend import Backend

VELOCITIES = ("geometry_msgs/msg/Twist", "geometry_msgs/msg/TwistStamped")
"""Types of the messages that command a velocity."""

Named = tuple[str, str]
"""Absolute name and type of a topic or an action."""


class Guarded:
    """The velocity topics and actions of one node, which a guard stops if the node no longer can.

    Attributes:
        on_change: called after an addition or removal.
        found: of each guard, the number of receivers that it has found, by the name of the topic or action.
    """

    def __init__(self) -> None:
        self.on_change: Callable[[], None] = lambda: None
        self.found: dict[str, Mapping[str, int]] = {}
        self._topics: Counter[Named] = Counter()
        self._actions: Counter[Named] = Counter()
        self._motions: list[Callable[[], None]] = []
        self._drives: list[Callable[[], None]] = []
        self._reported: set[Named] = set()

    @property
    def topics(self) -> list[Named]:
        """The open velocity topics, sorted."""
        return sorted(self._topics)

    @property
    def actions(self) -> list[Named]:
        """The actions with a client, sorted."""
        return sorted(self._actions)

    def covered(self, name: str, receivers: int) -> bool:
        """Return whether every guard has found as many *receivers* of a topic or action as this node has.

        A guard joins the graph later than this node. Until it is matched, its zero velocity reaches no base.
        """
        if name not in dict((*self._topics, *self._actions)):
            return True
        return all(found.get(name, 0) >= receivers for found in self.found.values())

    def add_topic(self, name: str, type_name: str) -> Callable[[], None]:
        """Add a velocity topic. Return a function that removes it."""
        return self._add(self._topics, (name, type_name))

    def add_action(self, name: str, type_name: str) -> Callable[[], None]:
        """Add an action. Return a function that removes it."""
        return self._add(self._actions, (name, type_name))

    def _add(self, group: Counter[Named], item: Named) -> Callable[[], None]:
        def remove() -> None:
            group[item] -= 1
            if group[item] <= 0:
                del group[item]
                self.on_change()

        group[item] += 1
        if group[item] == 1:
            self.on_change()
        return remove

    def is_news(self, publisher: Named) -> bool:
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
