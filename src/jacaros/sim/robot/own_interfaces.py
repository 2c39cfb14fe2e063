"""Topics and services that a world file adds to a robot: constant messages, received ones, constant responses."""

from jacaros.errors import UsageError
from jacaros.ros.errors import MessageMismatch, UnknownInterface
from jacaros.ros.message import plain
from jacaros.ros.names import response_type
from jacaros.ros.node import Publisher, Sample
from jacaros.sim.interface import OwnService, OwnTopic, absolute
from jacaros.sim.robot.on_graph import TICKS_PER_SECOND, RobotOnGraph


class OwnInterfaces:
    """The added topics and services of one robot; a message that it receives is an event ``received`` of the ground truth.

    Raises:
        UsageError: a type is not installed, or does not have the fields that the world file states.
    """

    def __init__(self, at: RobotOnGraph) -> None:
        self._at = at
        self._published: list[tuple[int, OwnTopic, Publisher]] = []
        interface = at.robot.description.interface
        added: list[OwnTopic | OwnService] = [*interface.topics, *interface.services]
        for each in added:
            name = absolute(each.name, at.prefix)
            try:
                if isinstance(each, OwnTopic):
                    self._topic(each, name)
                else:
                    self._service(each, name)
            except (UnknownInterface, MessageMismatch) as error:
                raise UsageError(f"`{each.name}` of the robot `{at.robot.name}`: {error}") from None

    def _topic(self, topic: OwnTopic, name: str) -> None:
        if not topic.rate:
            self._at.keep(self._at.backend.subscription(name, topic.type_name, self._receive))
            return
        publisher = self._at.keep(self._at.backend.publisher(name, topic.type_name))
        publisher.message(**topic.message)
        self._published.append((max(1, round(TICKS_PER_SECOND / topic.rate)), topic, publisher))

    def _service(self, service: OwnService, name: str) -> None:
        self._at.backend.message(response_type(service.type_name), **service.response)
        self._at.keep(self._at.backend.service(name, service.type_name, lambda request: service.response))

    def _receive(self, sample: Sample) -> None:
        self._at.time.catch_up()
        data = {"topic": sample.topic, "message": plain(sample.message)}
        self._at.time.world.note(self._at.robot.name, "received", data)

    def publish(self, ticks: int) -> None:
        """Publish the messages that are due at this tick of 20 Hz."""
        for period, topic, publisher in self._published:
            if ticks % period == 0:
                message = publisher.message(**topic.message)
                if hasattr(message, "header"):
                    self._at.fill_header(message.header, message.header.frame_id or "base_link")
                publisher.publish(message)
