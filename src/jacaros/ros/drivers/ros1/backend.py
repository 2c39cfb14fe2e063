"""ROS 1 through rospy: one node per process, callbacks handed to the loop, registrations looked after.

Nothing here waits on the loop: joining, registering and calling services happen in threads, see
`jacaros.ros.drivers.ros1.master`.  The addresses are rospy's: ``ROS_MASTER_URI``, ``ROS_IP``,
``ROS_HOSTNAME``; with none given and a master on this machine everything stays on the loopback interface.
"""

from collections.abc import Callable, Mapping

from jacaros.ros.action import ActionPolicy, Execute
from jacaros.ros.action_calling import GoalSender
from jacaros.ros.actionlib_client import ActionlibWire
from jacaros.ros.actionlib_server import ActionlibServer
from jacaros.ros.backend import (
    ACTIONS,
    DEFAULT_POLICY,
    DISCOVERY,
    PARAMETER_EVENTS,
    PARAMETERS,
    REGISTRATION,
    SERVICE_ERRORS,
    SERVICES,
    TOPICS,
    TRANSFORMS,
    Backend,
    Handler,
    Sample,
    TopicEvent,
)
from jacaros.ros.drivers.ros1.graph import graph_contents
from jacaros.ros.drivers.ros1.node import Ros1Node
from jacaros.ros.drivers.ros1.services import Ros1Client, Ros1Parameters, Ros1Service, give
from jacaros.ros.drivers.ros1.topics import Feeds, Ros1Publisher, Ros1Subscription
from jacaros.ros.graph import GraphContents
from jacaros.ros.names import action_type, message_type, service_type
from jacaros.ros.node import NodeSettings
from jacaros.ros.qos import DEFAULT_QOS, QoS


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

    def __init__(self, settings: NodeSettings) -> None:
        super().__init__(settings)
        self._feeds = Feeds(self)
        give(self)

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Ros1Publisher:
        """Make a publisher."""
        self.require_no_deadline(qos)
        return Ros1Publisher(self, self.resolve(topic), message_type(type_name), qos)

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> Ros1Subscription:
        """Have *callback* called for every message."""
        self.require_no_deadline(qos)
        full_type = message_type(type_name)
        made = Ros1Subscription(self, self._feeds, self.resolve(topic), full_type, callback, qos, on_event)
        self._feeds.see_types()
        return made

    def types_changed(self, types: Mapping[str, str]) -> None:
        """Tell subscriptions whose topic has another type."""
        self._feeds.see_types(types)

    def definition_differs(self, topic: str, kind: str, theirs: str, ours: str) -> None:
        """Tell subscriptions whose publisher has another definition."""
        self._feeds.see_definition(topic, kind, theirs, ours)

    def service(self, name: str, type_name: str, handler: Handler) -> Ros1Service:
        """Offer a service."""
        return Ros1Service(self, self.resolve(name), service_type(type_name), handler)

    def client(self, name: str, type_name: str) -> Ros1Client:
        """Make a client of a service."""
        return Ros1Client(self, self.resolve(name), service_type(type_name))

    def action_client(self, name: str, type_name: str) -> GoalSender:
        """Make a client of an action."""
        full_type = action_type(type_name)
        sender = GoalSender(
            self.clock,
            self.log,
            self.factory,
            self.resolve(name),
            full_type,
            self.leaving_goals,
            self.orphans,
        )
        sender.wire = ActionlibWire(self, sender)
        self.actions[sender] = None
        return sender

    def action_server(
        self, name: str, type_name: str, execute: Execute, policy: ActionPolicy = DEFAULT_POLICY
    ) -> ActionlibServer:
        """Offer an action."""
        server = ActionlibServer(self, self.resolve(name), action_type(type_name), execute, policy)
        self.actions[server] = None
        return server

    def parameters(self, node: str | None = None) -> Ros1Parameters:
        """Give the parameters below a node's name."""
        return Ros1Parameters(self, node)

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Look at the graph."""
        return await graph_contents(self, timeout)


BACKEND: type[Backend] = Ros1Backend
