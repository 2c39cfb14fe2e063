"""Whether the server took what it was asked for.

rosbridge refuses silently: a topic of another type, a type that is not installed on the robot, a name that it may not serve
are lines in its own log and nothing on the link.  So after each subscription and advertisement the graph is looked at,
until the topic is there with our type.
"""

from dataclasses import dataclass
from typing import Any, Protocol

from jacaros.clock import Timer
from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.errors import ServiceError
from jacaros.ros.names import message_type

FIRST_PAUSE, LONGEST_PAUSE = 1.0, 16.0
"""Seconds until the first look, and between two at most; each pause is twice as long as the one before."""
PATIENCE = 3
"""So many looks in which a topic is not there at all, and it was refused."""


class Asked(Protocol):
    """A subscription or a publisher at the server."""

    @property
    def topic(self) -> str:
        """Absolute name."""

    def written_type(self) -> str:
        """The type as the server writes it."""

    def join(self) -> None:
        """Ask for it again."""

    def refused(self, text: str) -> None:
        """The server does not do it; the text says why."""


@dataclass(slots=True)
class _Case:
    misses: int = 0
    conflict: bool = False


class Admission:
    """Looks after what was asked for until it is there.

    Args:
        node: asks.
    """

    def __init__(self, node: BridgeNode) -> None:
        self._node = node
        self._cases: dict[Asked, _Case] = {}
        self._timer: Timer | None = None
        self._pause = FIRST_PAUSE

    def expect(self, asked: Asked) -> None:
        """*asked* was asked for just now; on the loop."""
        if any(part.startswith("_") for part in asked.topic.split("/")):
            return  # hidden: rosapi does not tell it
        self._cases.setdefault(asked, _Case()).misses = 0
        self._pause = FIRST_PAUSE
        self._look_later()

    def forget(self, asked: Asked) -> None:
        """Nobody wants it any more."""
        self._cases.pop(asked, None)

    def close(self) -> None:
        """Look no more."""
        self._cases.clear()
        if self._timer is not None:
            self._timer.cancel()

    def _look_later(self) -> None:
        if self._timer is not None:
            self._timer.cancel()
        self._timer = self._node.clock.call_later(self._pause, self._look)

    def _look(self) -> None:
        self._timer = None
        if self._cases and self._node.attached:
            self._node.requests.begin("/rosapi/topics", {}, self._judge)

    def _judge(self, values: dict[str, Any] | None, _: ServiceError | None) -> None:
        if values is not None and isinstance(values.get("topics"), list):
            types = dict(zip(values["topics"], values.get("types") or (), strict=False))
            for asked, case in list(self._cases.items()):
                self._compare(asked, case, types.get(asked.topic))
        if self._cases:
            self._pause = min(self._pause * 2.0, LONGEST_PAUSE)
            self._look_later()

    def _compare(self, asked: Asked, case: _Case, found: str | None) -> None:
        wanted = asked.written_type()
        if found in (None, "", "*"):
            self._missed(asked, case, wanted)
        elif found != wanted:
            case.conflict = True
            asked.refused(
                f"topic {asked.topic} carries {message_type(str(found))}, not {message_type(wanted)}"
            )
        else:
            del self._cases[asked]
            if case.conflict:  # it was refused, and would not be now
                asked.join()

    def _missed(self, asked: Asked, case: _Case, wanted: str) -> None:
        case.misses += 1
        # rosapi of ROS 1 tells of topics only that are published.
        if self._node.ros_version == 2 and case.misses == PATIENCE:
            case.conflict = True
            asked.refused(
                f"topic {asked.topic} is not in the graph though the rosbridge server was asked for it: is {wanted} "
                "installed on the robot, and may the server serve this topic (its parameter topics_glob)?"
            )
