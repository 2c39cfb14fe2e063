"""Actions of a ROS 1 robot through the bridge: where `ActionlibWire` and `ActionlibServer` have their topics.

The protocol knows no actions of ROS 1, so goals, requests for cancelling and news are ordinary messages of the types that
actionlib wraps around an action's own (``pkg/NameActionGoal`` and so on).
"""

from collections.abc import Callable

from jacaros.ros.backend import Sample
from jacaros.ros.backends.rosbridge_node import BridgeNode
from jacaros.ros.backends.rosbridge_topics import BridgePublisher, BridgeSubscription
from jacaros.ros.orphans import Orphans
from jacaros.ros.qos import DEFAULT_QOS, QoS

WAITING = 300
"""Messages of each of an action's topics that may wait for the loop: none is dropped, so their order stays."""


class ActionTopics:
    """The topics of one action, an `ActionTopicsNode`.

    What comes on them is delivered in the order in which it came: the end of a goal not before its feedback.  And what
    goes out is not dropped because the network is slow: a lost request for cancelling would not be repeated.

    Args:
        node: the backend.
    """

    def __init__(self, node: BridgeNode) -> None:
        self._node = node
        self.clock = node.clock
        self.log = node.log
        self.factory = node.factory

    @property
    def orphans(self) -> Orphans:
        """What recognises goals of earlier runs."""
        return self._node.orphans

    @property
    def node_name(self) -> str:
        """Absolute name of the node."""
        return self._node.node_name

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> BridgePublisher:
        """Make a publisher."""
        made = BridgePublisher(self._node, topic, type_name, qos, droppable=False)
        self._node.members.add(made)
        return made

    def subscription(
        self, topic: str, type_name: str, callback: Callable[[Sample], None], qos: QoS = DEFAULT_QOS
    ) -> BridgeSubscription:
        """Have *callback* called for every message."""

        made = BridgeSubscription(self._node, topic, type_name, callback, qos, None, WAITING)
        self._node.members.add(made)
        return made

    def add_exit_hook(self, hook: Callable[[], None]) -> Callable[[], None]:
        """Have *hook* called when the process stops."""
        return self._node.add_exit_hook(hook)
