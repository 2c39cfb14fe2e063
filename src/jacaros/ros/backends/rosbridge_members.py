"""All that a node has at the server: told to it again after each connection."""

import itertools
from collections.abc import Callable

from jacaros.ros.backends.rosbridge_admission import Admission
from jacaros.ros.backends.rosbridge_node import BridgeNode, Member
from jacaros.ros.backends.rosbridge_topics import TopicFeed


class Members:
    """What the node has made, in its order.

    Args:
        node: whose members these are.
    """

    def __init__(self, node: BridgeNode) -> None:
        self._node = node
        self._members: list[Member] = []
        self._feeds: dict[str, TopicFeed] = {}
        self.admission = Admission(node)
        self._numbers = itertools.count(1)

    def number(self, operation: str, name: str) -> str:
        """An id for an operation; the server names it when it has something to say about it."""
        return f"{operation}:{name}:{next(self._numbers)}"

    def add(self, member: Member) -> None:
        """Keep *member* until it is closed."""
        self._members.append(member)

    def drop(self, member: Member) -> None:
        """Forget a member that was closed."""
        if member in self._members:
            self._members.remove(member)

    def feed(self, topic: str, written_type: Callable[[], str], packed: Callable[[], bool]) -> TopicFeed:
        """The one subscription of *topic* at the server, made at its first use."""
        if topic not in self._feeds:
            self._feeds[topic] = TopicFeed(self._node, topic, written_type, packed)
        return self._feeds[topic]

    def known_feed(self, topic: str) -> TopicFeed | None:
        """The subscription of *topic*, if there is one; from any thread."""
        return self._feeds.get(topic)

    def drop_feed(self, feed: TopicFeed) -> None:
        """Leave a topic: nobody here listens to it any more."""
        if self._feeds.get(feed.topic) is feed:
            del self._feeds[feed.topic]
            self.admission.forget(feed)
            feed.leave()

    def feed_of(self, number: str) -> TopicFeed | None:
        """The feed whose subscription has this id."""
        return next((feed for feed in self._feeds.values() if feed.number == number), None)

    def join(self) -> None:
        """Tell all to a server that does not know us yet."""
        for feed in list(self._feeds.values()):
            feed.join()
        for member in list(self._members):
            join = getattr(member, "join", None)
            if join is not None:
                join()

    def lost(self) -> None:
        """The link is down; some have to act on it."""
        for feed in list(self._feeds.values()):
            feed.lost()
        for member in list(self._members):
            lost = getattr(member, "lost", None)
            if lost is not None:
                lost()

    def close(self) -> None:
        """Give all up."""
        self.admission.close()
        for member in list(self._members):
            member.close()
        self._members.clear()
