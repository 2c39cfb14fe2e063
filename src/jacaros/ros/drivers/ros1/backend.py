"""ROS 1 through rospy: one node per process, callbacks handed to the loop, registrations looked after.

Nothing here waits on the loop: joining, registering and calling services happen in threads, see
`jacaros.ros.drivers.ros1.master`.  The addresses are rospy's: ``ROS_MASTER_URI``, ``ROS_IP``,
``ROS_HOSTNAME``; with none given and a master on this machine everything stays on the loopback interface.
"""

from collections.abc import Mapping

from jacaros.ros.action_calling import GoalSender
from jacaros.ros.actionlib_client import ActionlibWire
from jacaros.ros.actionlib_server import ActionlibServer
from jacaros.ros.backend import (
    ACTIONS,
    DISCOVERY,
    PARAMETER_EVENTS,
    PARAMETERS,
    REGISTRATION,
    SERVICE_ERRORS,
    SERVICES,
    TOPICS,
    TRANSFORMS,
    Backend,
)
from jacaros.ros.drivers.ros1.graph import graph_contents
from jacaros.ros.drivers.ros1.node import Ros1Node
from jacaros.ros.drivers.ros1.services import Ros1Client, Ros1Parameters, Ros1Service, give
from jacaros.ros.drivers.ros1.topics import Ros1Publisher, Ros1Subscription
from jacaros.ros.graph import GraphContents
from jacaros.ros.names import message_type
from jacaros.ros.node import NodeSettings, Parts


def _action_client(node: Ros1Node, name: str, type_name: str) -> GoalSender:
    sender = GoalSender(node.clock, node.log, node.factory, name, type_name, node.leaving_goals, node.orphans)
    sender.wire = ActionlibWire(node, sender)
    return sender


class Ros1Backend(Ros1Node):
    """The ROS 1 node of this process, as the port shows it.

    Args:
        settings: names, clock and reports; the namespace is ``ROS_NAMESPACE`` when none is given.
    """

    capabilities = frozenset(
        {
            TOPICS,
            SERVICES,
            SERVICE_ERRORS,
            TRANSFORMS,
            ACTIONS,
            DISCOVERY,
            REGISTRATION,
            PARAMETERS,
            PARAMETER_EVENTS,
        }
    )

    parts = Parts(
        publisher=Ros1Publisher,
        subscription=Ros1Subscription,
        service=Ros1Service,
        client=Ros1Client,
        action_client=_action_client,
        action_server=ActionlibServer,
    )

    def __init__(self, settings: NodeSettings) -> None:
        super().__init__(settings)
        give(self)

    def types_changed(self, types: Mapping[str, str]) -> None:
        """Tell subscriptions whose topic has another type."""
        self.types = {topic: message_type(kind) for topic, kind in types.items() if kind != "*"}
        for topic, feed in self.feeds.items():
            feed.see_type(self.types.get(topic, feed.type_name))

    def definition_differs(self, topic: str, kind: str, theirs: str, ours: str) -> None:
        """Tell subscriptions whose publisher has another definition of the type: another md5 sum."""
        if topic in self.feeds:
            package, _, name = kind.partition("/")
            self.feeds[topic].tell(
                f"topic {topic}: a publisher has another definition of {package}/msg/{name} (md5 sum {theirs}, here "
                f"{ours}): nothing will be received from it; install its version of {package} here"
            )

    def parameters(self, node: str | None = None) -> Ros1Parameters:
        """Give the parameters below a node's name."""
        return Ros1Parameters(self, node)

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Look at the graph."""
        return await graph_contents(self, timeout)


BACKEND: type[Backend] = Ros1Backend
