"""The artifact that talks to ROS: topics and services under the robot's name, closed when it is disposed."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, ClassVar, Protocol, TypeVar

from jacaros.artifacts.ros.listener import Listener
from jacaros.artifacts.ros.missing import MissingTopic
from jacaros.artifacts.ros.options import Reader, WrongOption, read_arguments, text
from jacaros.artifacts.ros.reading import Reading, ReadingPolicy, Values
from jacaros.env.artifact import Artifact, internal_operation
from jacaros.env.values import Atom
from jacaros.ros.backend import Backend, Client, Publisher, Sample, Subscription
from jacaros.ros.errors import CallTimedOut, RosError, ServiceError, ServiceUnavailable
from jacaros.ros.qos import DEFAULT_QOS, QoS
from jacaros.trace import Cause

FIRST_MESSAGE = 5.0
"""Seconds that an operation waits for the first message of a sensor."""


class Closable(Protocol):
    """What is closed when its artifact is disposed."""

    def close(self) -> None:
        """Give it up."""


C = TypeVar("C", bound=Closable)


class RosArtifact(Artifact):
    """An artifact whose topics and services close with it.

    Made as ``makeArtifact("Odom", "ArtOdometry", ["robot_0", rate(5)], Id)``: the robot's name first, both
    it and the options may be left out.  The name stands before topics (``/robot_0/odom``) and, where
    `robot_in_properties` says so, before properties (``robot_0_chatter``), as in the thesis; the option
    ``namespace("robot_0")`` stands before topics alone, so that an agent's program need not know its robot.

    A subclass overrides `open` (not ``init``) and declares its options.

    Attributes:
        known_options: options of the class with their readers; those of the parent classes count too.
        robot_in_properties: whether a robot's name is put before property names.
        robot: the robot's name, empty when the artifact was made without one.
        options: the options it was made with.
    """

    known_options: ClassVar[Mapping[str, Reader]] = {"namespace": text}
    robot_in_properties: ClassVar[bool] = False

    robot: str = ""
    options: Mapping[str, object] = {}

    def init(self, *arguments: object) -> None:
        """Read robot name and options, then `open`.

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

    def robot_property(self, name: str) -> str:
        """The name of a property, with the robot's name in front where the thesis has it so."""
        return f"{self.robot}_{name}" if self.robot and self.robot_in_properties else name

    def publisher(self, topic: str, type_name: str, qos: QoS = DEFAULT_QOS) -> Publisher:
        """Publish on the robot's *topic* until the artifact is disposed."""
        return self._kept(self.ros.publisher(self.robot_topic(topic), type_name, qos))

    def subscription(
        self, topic: str, type_name: str, callback: Callable[[Sample], None], qos: QoS = DEFAULT_QOS
    ) -> Subscription:
        """Have *callback* called for the messages of the robot's *topic* until the artifact is disposed.

        The callback runs on the loop but outside of any operation: it changes properties by `start`.  A topic
        that nobody publishes is told in the log after a few seconds; listening goes on.  So it does when the callback
        raises an exception, which is logged.
        """
        name = self.robot_topic(topic)
        listener = Listener(name, callback, partial(self._steps.setting.log_error, self.name))
        made = self._kept(self.ros.subscription(name, type_name, listener, qos))
        self._kept(MissingTopic(self.ros, self.clock, made, type_name, self.log))
        return made

    def client(self, service: str, type_name: str) -> Client:
        """Call the service until the artifact is disposed."""
        return self._kept(self.ros.client(service, type_name))

    def reading(self, name: str, policy: ReadingPolicy) -> Reading:
        """Let the property *name* follow a sensor by *policy*; ends with the artifact.

        The callback of the sensor gives its values to `Reading.take`; an operation that refreshes the
        property on request calls `refresh`.
        """

        def deliver(values: Values, cause: Cause | None) -> None:
            self.start(self.show_reading, name, values, cause=cause)

        return self._kept(Reading(policy, self.clock, deliver))

    @internal_operation
    def show_reading(self, name: str, values: object) -> None:
        """Give the property *name* new values, on behalf of a sensor."""
        assert isinstance(values, tuple)
        self.update_property(name, *values)

    async def newest(self, reading: Reading, missing: str) -> Values:
        """Give the newest values of a sensor to an operation; waits for its first message.

        A step boundary if it has to wait.

        Raises:
            OperationFailed: no message came in `FIRST_MESSAGE` seconds; *missing* names the reason, such as
                ``no_odometry(5)``.
        """
        if reading.newest is None:
            try:
                await self.step(reading.first(FIRST_MESSAGE))
            except TimeoutError:
                self.fail(f"no message came in {FIRST_MESSAGE:g} s", missing, FIRST_MESSAGE)
        assert reading.newest is not None
        return reading.newest

    async def refresh(self, name: str, reading: Reading, missing: str) -> None:
        """Give the property *name* the `newest` values, equal to the old ones or not."""
        await self.newest(reading, missing)
        self.update_property(name, *reading.passed())

    def at_dispose(self, closing: Callable[[], None]) -> None:
        """Have *closing* called when the artifact is disposed; the last given is called first."""
        self.__dict__.setdefault("_closings", []).append(closing)

    def _kept(self, connection: C) -> C:
        self.at_dispose(connection.close)
        return connection

    async def call(self, client: Client, timeout: float, **fields: object) -> Any:
        """Call a service from an operation and give its response; a step boundary.

        Raises:
            OperationFailed: ``service_unavailable(Name)``, ``service_timeout(Seconds)`` or
                ``service_failed(Name)``.
        """
        name = client.name.lstrip("/")
        try:
            return await self.step(client.call(fields, timeout))
        except ServiceUnavailable as error:
            self.fail(str(error), "service_unavailable", Atom(name))
        except CallTimedOut as error:
            self.fail(str(error), "service_timeout", timeout)
        except ServiceError as error:
            self.fail(str(error), "service_failed", Atom(name))
