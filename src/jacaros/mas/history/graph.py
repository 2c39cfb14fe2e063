"""Records of the ROS graph around our node: its topics, their nodes, and rates of our messages."""

from collections.abc import Callable, Mapping
from typing import Any

from jacaros.mas.history.causes import CauseRecords
from jacaros.ros.backend import Backend, GraphContents
from jacaros.ros.errors import RosError

PERIOD = 3.0
"""Seconds between two checks of a changing graph."""
_CHANGED = 0.5
"""Relative change of a rate that causes a new record."""
_MOST_TOPICS = 300

Tell = Callable[[str, Mapping[str, Any]], None]


class GraphRecords:
    """Makes the record ``graph`` when something has changed.

    Args:
        tell: takes the kind of a record and its data.
        messages: counts the messages of our node.

    Attributes:
        pause: seconds until the next check; longer while nothing changes.
    """

    def __init__(self, tell: Tell, messages: CauseRecords) -> None:
        self._tell, self._messages = tell, messages
        self._recorded: list[dict[str, Any]] | None = None
        self.pause = PERIOD

    async def look(self, backend: Backend, seconds: float) -> None:
        """Check the graph, *seconds* after the last check."""
        try:
            contents = await backend.contents()
        except RosError:  # the graph may be unreachable for a while
            return
        counts = self._counts(backend)
        topics = self._topics(contents, counts, seconds, backend.node_name)
        self.pause = min(10.0 * PERIOD, 2.0 * self.pause)
        if self._recorded is None or _differ(self._recorded, topics):
            if self._recorded is None or len(self._recorded) != len(topics):
                self.pause = PERIOD
            self._recorded = topics
            self._tell("graph", {"node": backend.node_name, "topics": topics})

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
    ) -> list[dict[str, Any]]:
        rows = []
        for name, info in sorted(contents.topics.items())[:_MOST_TOPICS]:
            ours = ""
            if (name, "in") in counts or any(each.node == node for each in info.subscriptions):
                ours = "in"
            if (name, "out") in counts or any(each.node == node for each in info.publishers):
                ours = "out"
            rows.append(
                {
                    "name": name,
                    "type": ", ".join(info.types),
                    "publishers": len(info.publishers),
                    "subscribers": len(info.subscriptions),
                    "ours": ours,
                    "rate": round(counts.get((name, ours), 0) / seconds, 1) if ours else 0.0,
                }
            )
        return rows


def _differ(before: list[dict[str, Any]], now: list[dict[str, Any]]) -> bool:
    if len(before) != len(now):
        return True
    for old, new in zip(before, now, strict=True):
        if any(old[key] != new[key] for key in ("name", "type", "publishers", "subscribers", "ours")):
            return True
        if abs(old["rate"] - new["rate"]) > max(1.0, _CHANGED * old["rate"]):
            return True
    return False
