"""The part of an artifact that opens topics, services and actions under its robot's name, and closes them with it."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, ClassVar, Protocol, TypeVar

from jacaros.artifacts.kit.connection import MATCH_TIMEOUT, Connection, Matching, MissingTopic
from jacaros.artifacts.kit.faults import Faults, Listener
from jacaros.artifacts.kit.options import Reader, WrongOption, read_arguments, text, watching
from jacaros.artifacts.kit.services import ServedOperation
from jacaros.env.artifact import Artifact, internal_operation
from jacaros.env.errors import InvalidArtifact
from jacaros.env.operation import marks_of
from jacaros.env.values import Structure
from jacaros.ros.action import ActionClient, ActionPolicy, ActionServer
from jacaros.ros.backend import (
    DEFAULT_POLICY,
    DISCOVERY,
    Backend,
    Client,
    Publisher,
    Sample,
    Service,
    Subscription,
    TopicEvent,
)
from jacaros.ros.errors import RosError
from jacaros.ros.guarded import VELOCITIES, guarded_by
from jacaros.ros.names import message_type
from jacaros.ros.parameter import Declaration, ParameterValue
from jacaros.ros.qos import DEFAULT_QOS, QoS


class Closable(Protocol):
    """What is closed when its artifact is disposed."""

    def close(self) -> None:
        """Give it up."""


C = TypeVar("C", bound=Closable)


class ConnectedArtifact(Artifact):
    """An artifact whose topics and services close with it; see `jacaros.artifacts.kit.ros_artifact.RosArtifact`.

    Attributes:
        known_options: options of the class with their readers; those of the parent classes count too.
        robot_in_properties: whether a robot's name is put before property names.
        robot: the robot's name, empty when the artifact was made without one.
        options: the options it was made with.
    """

    known_options: ClassVar[Mapping[str, Reader]] = {"namespace": text, "watch_connection": watching}
    robot_in_properties: ClassVar[bool] = False

    robot: str = ""
    options: Mapping[str, object] = {}

    def init(self, *arguments: object) -> None:
        """Take the robot's name and options, such as ``"robot_1", rate(5)``; both may be left out.

        Raises:
            OperationFailed: an unknown or impossible option (the message names the known ones), or a name
                that ROS does not allow.
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
        """Define the properties and open the topics; for subclasses."""

    def dispose(self) -> None:
        """Close all topics and services."""
        closings: list[Callable[[], None]] = self.__dict__.pop("_closings", [])
        for closing in reversed(closings):
            closing()

    @classmethod
    def all_options(cls) -> dict[str, Reader]:
        """The options of this class and its parents."""
        found: dict[str, Reader] = {}
        for each in reversed(cls.__mro__):
            found.update(vars(each).get("known_options", {}))
        return found

    @property
    def ros(self) -> Backend:
        """The middleware, which the environment lends as the resource ``ros``."""
        backend = self.resources.get("ros")
        if backend is None:
            self.fail(f"{type(self).__name__} needs ROS, and this system runs without", "no_ros")
        return backend  # type: ignore[return-value]  # resources are untyped; the host puts a Backend here

    @property
    def robot_prefix(self) -> str:
        """What stands before the robot's topics, such as ``/robot_0``; empty for the only robot."""
        parts = (str(self.options.get("namespace", "")).strip("/"), self.robot.strip("/"))
        return "".join(f"/{part}" for part in parts if part)

    def robot_topic(self, name: str) -> str:
        """The robot's own topic called *name*; a slash in front makes no difference."""
        return f"{self.robot_prefix}/{name.lstrip('/')}"

    @property
    def frame_prefix(self) -> str:
        """What stands before the robot's frames: all that stands before its topics, the node's namespace included."""
        return self.ros.resolve(self.robot_topic("frame")).rpartition("/")[0].strip("/")

    def robot_property(self, name: str) -> str:
        """The name of a property, with the robot's name in front where the thesis has it so."""
        return f"{self.robot}_{name}" if self.robot and self.robot_in_properties else name

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Publisher:
        """Publish on the robot's *topic* until the artifact is disposed."""
        made = self.kept(self.ros.publisher(self.robot_topic(topic), type_name, qos))
        full = message_type(type_name)
        if full in VELOCITIES:
            self.at_dispose(guarded_by(self.ros).add_topic(made.topic, full))
        return made

    def matching_of(
        self,
        publisher: Publisher,
        timeout: float | None = None,
        unmatched: str | None = None,
        warn: Callable[[str, str], None] | None = None,
    ) -> Matching:
        """Prepare operations to wait for subscriptions of *publisher*; see `matched` for the simple way.

        Args:
            publisher: made by `publisher`.
            timeout: seconds; None: the option ``match_timeout``.
            unmatched: ``warn`` or ``fail``; None: the option ``unmatched``.
            warn: takes the warning and the help; None: they are logged, once for each time that the topic is without
                subscribers.
        """
        found = (
            timeout if timeout is not None else float(str(self.options.get("match_timeout", MATCH_TIMEOUT)))
        )
        fails = (unmatched or self.options.get("unmatched")) == "fail"

        def missed(topic: str, seconds: float, again: bool) -> None:
            waited = f" after {seconds:g} s" if seconds else ""
            if fails:
                self.fail(f"no subscriber on {topic}{waited}; nothing was published", "unmatched", topic)
            if again or not self.ros.connected:
                return  # a graph that cannot be reached is reported by its backend
            message = f"no subscriber on {topic}{waited}; publishing anyway"
            help = "start the node that subscribes to it; `jacaros ros list` shows the topics of the graph"
            if warn is not None:
                warn(message, help)
            else:
                self.log(f"warning: {message}\n  help: {help}")

        return Matching(publisher, found if DISCOVERY in self.ros.capabilities else 0.0, missed)

    async def matched(self, publisher: Publisher) -> None:
        """Wait until a subscription of *publisher* is matched, so that the next message arrives.

        It is a step boundary, but only while it waits: at most ``match_timeout`` seconds, the first time.  Without a
        subscriber it then logs a warning and returns.  While the intention is suspended it does not return.

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
        """Have *callback* called for the messages of the robot's *topic* until the artifact is disposed.

        The callback runs on the loop but outside of any operation: it changes properties by `start`.  A topic
        that nobody publishes is told in the log after a few seconds; listening goes on.  So it does when the callback
        raises an exception, which is logged.

        Args:
            topic: its name.
            type_name: of its messages.
            callback: takes each message.
            qos: what is asked for.
            on_event: told of trouble at the topic; without it trouble goes to the log.
        """
        name = self.robot_topic(topic)
        listener = Listener(name, callback, partial(self._steps.setting.log_error, self.name))
        watch = self.options.get("watch_connection", False)
        if watch is False:
            made = self.kept(self.ros.subscription(name, type_name, listener, qos, on_event))
        else:
            expire = None if watch is True else float(str(watch))
            made = self._watched(name, type_name, listener, qos, on_event, expire)
        self.kept(MissingTopic(self.ros, self.clock, made, type_name, self.log))
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
        """Listen, and show whether the topic is connected."""

        def take(sample: Sample) -> None:
            connection.hear(sample)
            listener(sample)

        made = self.kept(self.ros.subscription(name, type_name, take, qos, on_event))
        changed = partial(self.start, self.show_connection, made.topic)
        connection = self.kept(Connection(self.ros, self.clock, made, changed, expire))
        return made

    @internal_operation
    def show_connection(self, topic: str, connected: bool) -> None:
        """Have the property ``connected(Topic)``, or have it no more."""
        if not connected:
            self.remove_property("connected", topic)
        else:
            self.define_property("connected", topic)

    def faults_of(self, topic: str) -> Faults:
        """Count the bad messages of the robot's *topic*, and tell of them by log and signal."""
        return self.faults_at(self.ros.resolve(self.robot_topic(topic)))

    def faults_at(self, topic: str) -> Faults:
        """The same for a topic by its absolute name."""

        def report(why: Structure, text: str) -> None:
            self.log(text)
            self.start(self.report_bad_message, topic, why)

        return Faults(topic, report)

    @internal_operation
    def report_bad_message(self, topic: str, why: object) -> None:
        """Signal ``bad_message(Topic, Why)``."""
        self.signal("bad_message", topic, why)

    def client(self, service: str, type_name: str) -> Client:
        """Call the service until the artifact is disposed."""
        return self.kept(self.ros.client(service, type_name))

    def action_client(self, name: str, type_name: str) -> ActionClient:
        """Send goals to the robot's action *name*, by `act`; they are cancelled when the artifact or the process ends.

        Args:
            name: below the robot's name, such as ``navigate_to_pose``.
            type_name: such as ``nav2_msgs/action/NavigateToPose``.
        """
        client = self.kept(self.ros.action_client(self.robot_topic(name), type_name))
        self.at_dispose(guarded_by(self.ros).add_action(client.name, type_name))
        return client

    def service(self, name: str, type_name: str, handler: Callable[..., Any]) -> Service:
        """Offer the robot's service *name* until the artifact is disposed.

        Args:
            name: below the robot's name, such as ``take_order``.
            type_name: such as ``std_srvs/srv/Trigger``.
            handler: an `internal_operation` of this artifact with two parameters, the request and the
                `jacaros.artifacts.kit.services.Reply`; see `jacaros.artifacts.kit.services` for what its failure
                means.  Another function takes the request, gives the response, and stands outside of all operations.
        """
        offer = self._served_operation(handler)
        handle = handler if offer is None else offer.handler(type_name)
        return self.kept(self.ros.service(self.robot_topic(name), type_name, handle))

    def action_server(
        self, name: str, type_name: str, execute: Callable[..., Any], policy: ActionPolicy = DEFAULT_POLICY
    ) -> ActionServer:
        """Offer the robot's action *name* until the artifact is disposed.

        When a goal is cancelled, or a newer one takes over, ``CancelledError`` is thrown into its operation: ``finally``
        is the place for what has to be put right.

        Args:
            name: below the robot's name, such as ``deliver``.
            type_name: such as ``nav2_msgs/action/NavigateToPose``.
            execute: an `internal_operation` with two parameters, the `jacaros.ros.action.ServerGoal` and the
                `jacaros.artifacts.kit.services.Reply`; or another function as `jacaros.ros.action.Execute`.
            policy: which goals are accepted, and whether a newer one takes over.
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
                f"{operation.__qualname__} cannot serve requests: write it with two parameters, request and reply"
            )
        return None

    def at_dispose(self, closing: Callable[[], None]) -> None:
        """Have *closing* called when the artifact is disposed; the last given is called first."""
        self.__dict__.setdefault("_closings", []).append(closing)

    def declared_parameter(self, name: str, declaration: Declaration) -> ParameterValue:
        """Declare a parameter of our node until the artifact is disposed, and give its value.

        Raises:
            CapabilityMissing: parameters are not declared here (ROS 1, rosbridge).
            ParameterRefused: it is declared already, or the default breaks the declaration.
        """
        parameters = self.ros.parameters()
        value = parameters.declare(name, declaration)
        self.at_dispose(partial(parameters.withdraw, name))
        return value

    @property
    def ros_names(self) -> tuple[str, ...]:
        """The absolute names of the topics, services and actions that it uses now."""
        owners = [getattr(closing, "__self__", None) for closing in self.__dict__.get("_closings", ())]
        names = [getattr(each, "topic", None) or getattr(each, "name", None) for each in owners]
        return tuple(name for name in names if isinstance(name, str) and name.startswith("/"))

    def kept(self, connection: C) -> C:
        """Have *connection* closed with the artifact, and give it back."""
        self.at_dispose(connection.close)
        return connection
