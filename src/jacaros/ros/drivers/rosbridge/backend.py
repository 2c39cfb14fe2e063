"""A robot behind a rosbridge server, for a machine without ROS: JSON over a WebSocket.

The server (``rosbridge_server`` of ROS 1 or ROS 2) is the node in the graph; we are one of its clients. So the graph
knows us by the server's name, and what rosapi, the node next to it, does not report remains unknown. The version of
ROS is requested at each connection. The message classes are those of the `memory` backend.

Everything happens on the loop; only exit hooks may send from another thread (see `Link`).
"""

import os

from jacaros.ros.backend import Backend, GraphContents
from jacaros.ros.drivers.rosbridge.actions import BridgeActionClient, BridgeActionServer
from jacaros.ros.drivers.rosbridge.link import checked_url
from jacaros.ros.drivers.rosbridge.node import BridgeNode
from jacaros.ros.drivers.rosbridge.services import (
    BridgeClient,
    BridgeParameters,
    BridgeService,
    absolute,
    look,
)
from jacaros.ros.drivers.rosbridge.topics import BridgePublisher, BridgeSubscription
from jacaros.ros.errors import CapabilityMissing
from jacaros.ros.node import Capability, NodeSettings, Parts
from jacaros.ros.parameter_services import ParameterEvents, read_value
from jacaros.ros.protocols.rosbridge_wire import PATIENCE

DEFAULT_URL = "ws://127.0.0.1:9090"


class RosbridgeBackend(BridgeNode):
    """A client of a rosbridge server.

    Args:
        settings: names, clock and log.
        url: address of the server; default: ``ROSBRIDGE_URI``, else port 9090 of this machine.
    """

    name = "rosbridge"
    parts = Parts(
        publisher=BridgePublisher,
        subscription=BridgeSubscription,
        service=BridgeService,
        client=BridgeClient,
        action_client=BridgeActionClient,
        action_server=BridgeActionServer,
    )

    def __init__(self, settings: NodeSettings, url: str | None = None) -> None:
        if settings.parameters:
            raise CapabilityMissing(
                f"parameter {next(iter(settings.parameters))} cannot be set: over rosbridge there is no node of our own, "
                "and so there are no parameters"
            )
        super().__init__(settings, checked_url(url or os.environ.get("ROSBRIDGE_URI") or DEFAULT_URL))
        self._parameter_events = ParameterEvents(self.subscription, read_value)

    @property
    def capabilities(self) -> frozenset[Capability]:  # type: ignore[override]
        """The capabilities with the robot's version of ROS."""
        # Only services of ROS 1 that are not served over a bridge report failed handlers.
        events = {Capability.PARAMETER_EVENTS} if self.ros_version == 2 else set()
        return frozenset(
            {
                Capability.TOPICS,
                Capability.SERVICES,
                Capability.TRANSFORMS,
                Capability.ACTIONS,
                Capability.DISCOVERY,
                Capability.PARAMETERS,
                *events,
            }
        )

    def parameters(self, node: str | None = None) -> BridgeParameters:
        """Return the parameters of a node; our own exist on ROS 1 only, where the master stores them."""
        return BridgeParameters(
            self, self.node_name if node is None else self.resolve(node), self._parameter_events
        )

    async def contents(self, timeout: float = 5.0) -> GraphContents:
        """Return the contents of the graph."""
        return await look(self, timeout)

    async def _publishers(self, topic: str) -> list[str]:
        answer = await self.rosapi("publishers", {"topic": topic}, PATIENCE)
        # The server publishes for its clients, and does not tell which.
        return [name for name in absolute(answer["publishers"]) if "rosbridge" not in name]


BACKEND: type[Backend] = RosbridgeBackend
