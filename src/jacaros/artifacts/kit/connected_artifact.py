"""The part of an artifact that opens topics, services and actions below its robot's name, and closes them on
disposal."""

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, ClassVar, TypeVar

from jacaros.artifacts.env.artifact import Artifact, internal_operation
from jacaros.artifacts.env.errors import InvalidArtifact
from jacaros.artifacts.env.operation import marks_of
from jacaros.artifacts.env.values import Structure
from jacaros.artifacts.kit.connection import (
    GUARD_TIMEOUT,
    MATCH_LOOK,
    MATCH_TIMEOUT,
    Connection,
    Matching,
    MissingTopic,
)
from jacaros.artifacts.kit.faults import Faults, Listener
from jacaros.artifacts.kit.options import Reader, WrongOption, read_arguments, text, watching
from jacaros.artifacts.kit.other_publishers import OtherPublishers
from jacaros.artifacts.kit.services import ServedOperation
from jacaros.ros.action import ActionPolicy, ActionServer
from jacaros.ros.action_client import ActionClient
from jacaros.ros.backend import DEFAULT_POLICY, Backend
from jacaros.ros.errors import RosError
from jacaros.ros.guarded import VELOCITIES, guarded_by
from jacaros.ros.names import message_type
from jacaros.ros.node import Capability, Closable, Publisher, Sample, Subscription, TopicEvent
from jacaros.ros.parameter import Declaration, ParameterValue
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.ros.services import Client, Service

C = TypeVar("C", bound=Closable)


class ConnectedArtifact(Artifact):
    """An artifact that closes its topics and services on disposal; see
    `jacaros.artifacts.kit.ros_artifact.RosArtifact`.

    Attributes:
        known_options: options of the class with their readers, in addition to those of its parent classes.
        robot_in_properties: whether the robot's name is put before property names.
        robot: the robot's name, empty if the artifact was made without one.
        options: the options that the artifact was made with.
    """

    known_options: ClassVar[Mapping[str, Reader]] = {"namespace": text, "watch_connection": watching}
    robot_in_properties: ClassVar[bool] = False

    robot: str = ""
    options: Mapping[str, object] = {}

    def init(self, *arguments: object) -> None:
        """Read the robot's name and the options, such as ``"robot_1", rate(5)``; both are optional.

        Raises:
            OperationFailed: an option is unknown (the message lists the known ones) or invalid, or ROS does not allow
                the name.
        """
        try:
            read = read_arguments(arguments, self.all_options(), type(self).__name__)
        except WrongOption as wrong:
            self.fail(str(wrong), "wrong_option", type(self).__name__)
        self.robot, self.options = read.robot, read.options
        try:
            self.open()
        except RosError as error:
            self.fail(str(error), "ros_error", type(self).__name__)

    def open(self) -> None:
        """Define the properties and open the topics. Subclasses override it."""

    def dispose(self) -> None:
        """Close all topics and services."""
        closings: list[Callable[[], None]] = self.__dict__.pop("_closings", [])
        for closing in reversed(closings):
            closing()

    @classmethod
    def all_options(cls) -> dict[str, Reader]:
        """Return the options of this class and its parents."""
        found: dict[str, Reader] = {}
        for each in reversed(cls.__mro__):
            found.update(vars(each).get("known_options", {}))
        return found

    @property
    def ros(self) -> Backend:
        """The middleware, which the environment provides as the resource ``ros``."""
        backend = self.resources.get("ros")
        if backend is None:
            self.fail(f"{type(self).__name__} needs ROS, but this system runs without it", "no_ros")
        return backend  # type: ignore[return-value]  # resources are untyped; the host puts a Backend here

    @property
    def robot_prefix(self) -> str:
        """Prefix of the robot's topics, such as ``/robot_0``; empty if there is only one robot."""
        parts = (str(self.options.get("namespace", "")).strip("/"), self.robot.strip("/"))
        return "".join(f"/{part}" for part in parts if part)

    def robot_topic(self, name: str) -> str:
        """Return a name below the robot's namespace, which is below that of the node; an absolute name stays."""
        if name.startswith(("/", "~")) or not self.robot_prefix:
            return name
        return f"{self.robot_prefix.lstrip('/')}/{name}"

    @property
    def robot_namespace(self) -> str:
        """Absolute namespace of the robot's topics, including that of the node; empty for the root."""
        return self.ros.resolve(self.robot_topic("name")).rpartition("/")[0]

    @property
    def frame_prefix(self) -> str:
        """Prefix of the robot's frames: the namespace of its topics, without leading slash."""
        return self.robot_namespace.lstrip("/")

    def robot_property(self, name: str) -> str:
        """Return the name of a property, prefixed with the robot's name where the thesis does so."""
        return f"{self.robot}_{name}" if self.robot and self.robot_in_properties else name

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Publisher:
        """Publish on the robot's *topic* until the artifact is disposed.

        Of a topic of velocities, the property ``other_publisher(Topic,Node)`` shows other nodes that publish on it.
        """
        made = self.kept(self.ros.publisher(self.robot_topic(topic), type_name, qos))
        full = message_type(type_name)
        if full in VELOCITIES:
            self.at_dispose(guarded_by(self.ros).add_topic(made.topic, full))
            changed = partial(self.start, self.show_other_publisher, made.topic)
            self.kept(OtherPublishers(self.ros, self.clock, made.topic, changed, self.log))
            guarded_by(self.ros).watch(made)
        return made

    @internal_operation
    def show_other_publisher(self, topic: str, node: str, publishes: bool) -> None:
        """Show the property ``other_publisher(Topic,Node)``, or remove it."""
        if publishes:
            self.define_property("other_publisher", topic, node)
        else:
            self.remove_property("other_publisher", topic, node)

    def matching_of(
        self,
        publisher: Publisher,
        timeout: float | None = None,
        unmatched: str | None = None,
        warn: Callable[[str, str], None] | None = None,
    ) -> Matching:
        """Prepare operations to wait for subscribers of *publisher*; see `matched` for the simple way.

        Args:
            publisher: made by `publisher`.
            timeout: seconds; None: the option ``match_timeout``.
            unmatched: ``warn`` or ``fail``; None: the option ``unmatched``.
            warn: called with the warning and the help; None: they are logged, once each time the topic loses its last
                subscriber.
        """
        found = (
            timeout if timeout is not None else float(str(self.options.get("match_timeout", MATCH_TIMEOUT)))
        )
        fails = (unmatched or self.options.get("unmatched")) == "fail"
        guarded = guarded_by(self.ros)

        def missed(topic: str, seconds: float, again: bool) -> None:
            what = "no subscriber on topic"
            help = "start the node that subscribes to it; `jacaros ros list` shows the topics of the graph"
            if publisher.subscription_count:
                what = "the guard has not found the subscriber of topic"
                help = f"`jacaros ros show {topic}` shows the quality of service of its subscribers"
            text = f"{what} {topic}{f' after {seconds:g} s' if seconds else ''}"
            if fails:
                self.fail(f"{text}; nothing was published", "unmatched", topic)
            if again or not self.ros.connected:
                return  # the backend reports a graph that cannot be reached
            message = f"{text}; publishing anyway"
            if warn is not None:
                warn(message, help)
            else:
                self.log(f"warning: {message}\n  help: {help}")

        return Matching(
            publisher,
            found if Capability.DISCOVERY in self.ros.capabilities else 0.0,
            missed,
            lambda count: guarded.covered(publisher.topic, count),
        )

    async def matched(self, publisher: Publisher) -> None:
        """Wait until *publisher* has a subscriber, so that the next message arrives.

        This is a step boundary only if it waits: at most ``match_timeout`` seconds, the first time. Without a
        subscriber it then logs a warning and returns. It does not return while the intention is suspended.

        Raises:
            OperationFailed: ``unmatched(Topic)``, with the option ``unmatched(fail)``.
        """
        known: dict[Publisher, Matching] = self.__dict__.setdefault("_matchings", {})
        if publisher not in known:
            known[publisher] = self.matching_of(publisher)
        for seconds in known[publisher].pauses():
            await self.sleep(seconds)
            await self.pause_point()

    def subscription(
        self,
        topic: str,
        type_name: str,
        callback: Callable[[Sample], None],
        qos: QoS = DEFAULT_QOS,
        on_event: Callable[[TopicEvent], None] | None = None,
    ) -> Subscription:
        """Call *callback* with the messages of the robot's *topic* until the artifact is disposed.

        The callback runs on the loop, outside of any operation, and changes properties with `start`. If no node
        publishes the topic, a warning is logged after a few seconds; the subscription stays. It also stays when the
        callback raises an exception, which is logged.

        Args:
            topic: name of the topic, below the robot's name.
            type_name: message type.
            callback: called with each message.
            qos: requested quality of service.
            on_event: called with problems of the topic; without it they are logged.
        """
        name = self.robot_topic(topic)
        listener = Listener(
            self.ros.resolve(name), callback, partial(self._steps.setting.log_error, self.name)
        )
        watch = self.options.get("watch_connection", False)
        if watch is False:
            made = self.kept(self.ros.subscription(name, type_name, listener, qos, on_event))
        else:
            expire = None if watch is True else float(str(watch))
            made = self._watched(name, type_name, listener, qos, on_event, expire)
        self.kept(MissingTopic(self.ros, self.clock, made, type_name, self.log, lambda: listener.heard))
        return made

    def _watched(
        self,
        name: str,
        type_name: str,
        listener: Listener,
        qos: QoS,
        on_event: Callable[[TopicEvent], None] | None,
        expire: float | None,
    ) -> Subscription:
        """Subscribe, and show whether the topic is connected."""

        def take(sample: Sample) -> None:
            connection.hear(sample)
            listener(sample)

        made = self.kept(self.ros.subscription(name, type_name, take, qos, on_event))
        changed = partial(self.start, self.show_connection, made.topic)
        connection = self.kept(Connection(self.ros, self.clock, made, changed, expire))
        return made

    @internal_operation
    def show_connection(self, topic: str, connected: bool) -> None:
        """Show the property ``connected(Topic)``, or remove it."""
        if not connected:
            self.remove_property("connected", topic)
        else:
            self.define_property("connected", topic)

    def faults_of(self, topic: str) -> Faults:
        """Return the counter of bad messages of the robot's *topic*, which logs and signals them."""
        return self.faults_at(self.ros.resolve(self.robot_topic(topic)))

    def faults_at(self, topic: str) -> Faults:
        """As `faults_of`, by the absolute name of the topic."""

        def report(why: Structure, text: str) -> None:
            self.log(text)
            self.start(self.report_bad_message, topic, why)

        return Faults(topic, report)

    @internal_operation
    def report_bad_message(self, topic: str, why: object) -> None:
        """Signal ``bad_message(Topic, Why)``."""
        self.signal("bad_message", topic, why)

    def client(self, service: str, type_name: str) -> Client:
        """Return a client of the service, which is closed when the artifact is disposed."""
        return self.kept(self.ros.client(service, type_name))

    def action_client(self, name: str, type_name: str) -> ActionClient:
        """Return a client for the robot's action *name*, for use with `act`. Its goals are cancelled when the
        artifact or the process ends.

        Args:
            name: name below the robot's name, such as ``navigate_to_pose``.
            type_name: action type, such as ``nav2_msgs/action/NavigateToPose``.
        """
        client = self.kept(self.ros.action_client(self.robot_topic(name), type_name))
        self.at_dispose(guarded_by(self.ros).add_action(client.name, type_name))
        return client

    async def guarded(self, client: ActionClient) -> None:
        """Wait until the guard, if any, can cancel the goals of *client*; a step boundary only if it waits.

        After `GUARD_TIMEOUT` seconds it logs a warning and returns. It does not wait for a missing server.
        """
        covered = partial(guarded_by(self.ros).covered, client.name, 1)
        for _ in range(math.ceil(GUARD_TIMEOUT / MATCH_LOOK)):
            if covered() or not client.ready:
                return
            await self.sleep(MATCH_LOOK)
        self.log(
            f"warning: the guard has not found the server of action {client.name} after {GUARD_TIMEOUT:g} s; "
            "sending the goal anyway"
        )

    def service(self, name: str, type_name: str, handler: Callable[..., Any]) -> Service:
        """Offer the robot's service *name* until the artifact is disposed.

        Args:
            name: name below the robot's name, such as ``take_order``.
            type_name: service type, such as ``std_srvs/srv/Trigger``.
            handler: an `internal_operation` of this artifact with two parameters, the request and the
                `jacaros.artifacts.kit.services.Reply`; see `jacaros.artifacts.kit.services` for the effect of its
                failure. Any other function takes the request, returns the response, and runs outside of all
                operations.
        """
        offer = self._served_operation(handler)
        handle = handler if offer is None else offer.handler(type_name)
        return self.kept(self.ros.service(self.robot_topic(name), type_name, handle))

    def action_server(
        self, name: str, type_name: str, execute: Callable[..., Any], policy: ActionPolicy = DEFAULT_POLICY
    ) -> ActionServer:
        """Offer the robot's action *name* until the artifact is disposed.

        When a goal is cancelled or pre-empted by a newer one, ``CancelledError`` is raised in its operation; clean up
        in ``finally``.

        Args:
            name: name below the robot's name, such as ``deliver``.
            type_name: action type, such as ``nav2_msgs/action/NavigateToPose``.
            execute: an `internal_operation` with two parameters, the `jacaros.ros.action.ServerGoal` and the
                `jacaros.artifacts.kit.services.Reply`; or another function as `jacaros.ros.action.Execute`.
            policy: which goals are accepted, and whether a newer goal pre-empts an older one.
        """
        offer = self._served_operation(execute)
        code = execute if offer is None else offer.execute(type_name)
        return self.kept(self.ros.action_server(self.robot_topic(name), type_name, code, policy))

    def _served_operation(self, operation: Callable[..., Any]) -> ServedOperation | None:
        declared = self._steps.interface.own(operation, 2)
        if declared is not None:
            return ServedOperation(self.ros, self._steps, self.id, declared)
        if marks_of(getattr(operation, "__func__", operation)):
            raise InvalidArtifact(
                f"{operation.__qualname__} cannot serve requests: expected two parameters, request and reply"
            )
        return None

    def at_dispose(self, closing: Callable[[], None]) -> None:
        """Call *closing* when the artifact is disposed; the callbacks run in reverse order."""
        self.__dict__.setdefault("_closings", []).append(closing)

    def declared_parameter(self, name: str, declaration: Declaration) -> ParameterValue:
        """Declare a parameter of our node until the artifact is disposed, and return its value.

        Raises:
            CapabilityMissing: the middleware does not declare parameters (ROS 1, rosbridge).
            ParameterRefused: the parameter is already declared, or the default violates the declaration.
        """
        parameters = self.ros.parameters()
        value = parameters.declare(name, declaration)
        self.at_dispose(partial(parameters.withdraw, name))
        return value

    @property
    def ros_names(self) -> tuple[str, ...]:
        """Return the absolute names of the topics, services and actions in use."""
        owners = [getattr(closing, "__self__", None) for closing in self.__dict__.get("_closings", ())]
        names = [getattr(each, "topic", None) or getattr(each, "name", None) for each in owners]
        return tuple(name for name in names if isinstance(name, str) and name.startswith("/"))

    def kept(self, connection: C) -> C:
        """Close *connection* with the artifact, and return it."""
        self.at_dispose(connection.close)
        return connection
