"""The parent class of artifacts that use ROS: topics, services and actions below the robot's name, closed on
disposal."""

import math
from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, ClassVar, TypeVar

from jacaros.artifacts.env.artifact import Artifact, Out, internal_operation
from jacaros.artifacts.env.errors import InvalidArtifact
from jacaros.artifacts.env.operation import marks_of
from jacaros.artifacts.env.values import Atom, Structure
from jacaros.robots.kit.acting import GoalOptions, GoalRunner, Suspending, missing_number
from jacaros.robots.kit.connection import (
    GUARD_TIMEOUT,
    MATCH_LOOK,
    MATCH_TIMEOUT,
    Matching,
    MissingTopic,
    OtherPublishers,
    PublisherConnection,
)
from jacaros.robots.kit.options import ReadOption, WrongOption, read_arguments, text, watching
from jacaros.robots.kit.reading import BadMessages, MessageCallback, Reading
from jacaros.robots.kit.services import ServedOperation, failure_reason, refusal, succeeded
from jacaros.robots.ros.action import ActionPolicy, ActionServer
from jacaros.robots.ros.action_client import ActionClient
from jacaros.robots.ros.backend import DEFAULT_POLICY, Backend, Sample
from jacaros.robots.ros.errors import MessageMismatch, RosError, ServiceError
from jacaros.robots.ros.guarded import VELOCITIES, guarded_by
from jacaros.robots.ros.names import message_type
from jacaros.robots.ros.node import Capability, Closable, Publisher, Subscription, TopicEvent
from jacaros.robots.ros.parameter import DeclaredParameter, ParameterValue
from jacaros.robots.ros.qos import DEFAULT_QOS, QoS
from jacaros.robots.ros.services import Client, Service
from jacaros.robots.streams import ReadingPolicy, Values
from jacaros.runtime.trace import Cause

C = TypeVar("C", bound=Closable)
T = TypeVar("T")

FIRST_MESSAGE = 5.0
"""Seconds that an operation waits for the first message of a sensor."""


class RosArtifact(Artifact):
    """An artifact whose topics and services are closed when it is disposed.

    Make it with ``makeArtifact("Odom", "ArtOdometry", ["robot_0", rate(5)], Id)``: the robot's name first; both it
    and the options are optional. The name is the prefix of topics (``/robot_0/odom``) and, where
    `robot_in_properties` is true, of properties (``robot_0_chatter``), as in the thesis. The option
    ``namespace("robot_0")`` is the prefix of topics only, so that the agent's program need not know its robot.

    Subclasses override `open` (not ``init``) and declare their options.

    Options:
        namespace(N): prefix of topics, as a robot's name is.
        watch_connection(true): show `connected`; with a number of seconds instead of true, a topic also counts as
            lost after that time without a message.

    Properties:
        connected(Topic): a node publishes the topic, as far as is known; one for each topic that the artifact
            subscribes to, with its absolute name as text. Only with `watch_connection`.

        other_publisher(Topic, Node): another node publishes on the topic of velocities that this artifact publishes
            on, so the robot follows both; one for each node. The run's own guard does not count.

    Signals:
        bad_message(Topic, Why): a message was bad; sent on the first, 10th, 100th, … occurrence of a kind. Why is
            ``not_finite(What)``, ``out_of_range(What)``, ``wrong_frame(Frame)``, ``out_of_order(Seconds)``,
            ``clock_jumped(Seconds)``, ``stamp_off(Seconds)`` or ``late(Seconds)``.

    Attributes:
        known_options: options of the class with their readers, in addition to those of its parent classes.
        robot_in_properties: whether the robot's name is put before property names.
        robot: the robot's name, empty if the artifact was made without one.
        options: the options that the artifact was made with.
    """

    known_options: ClassVar[Mapping[str, ReadOption]] = {"namespace": text, "watch_connection": watching}
    robot_in_properties: ClassVar[bool] = False

    _show_values: Callable[[str, Values], None]

    robot: str = ""
    options: Mapping[str, object] = {}

    def init(self, *arguments: object) -> None:
        """Read the robot's name and the options, such as ``"robot_1", rate(5)``; both are optional.

        Raises:
            OperationFailed: an option is unknown (the message lists the known ones) or invalid, or ROS does not allow
                the name.
        """
        kind, properties = type(self).__name__, self._steps.publication.properties
        self._show_values = partial(properties.update, annotations=None, or_define=True)
        try:
            self.robot, self.options = read_arguments(arguments, self.all_options(), kind)
            self.open()
        except WrongOption as wrong:
            self.fail(str(wrong), "wrong_option", kind)
        except RosError as error:
            self.fail(str(error), "ros_error", kind)

    def open(self) -> None:
        """Define the properties and open the topics. Subclasses override it."""

    def dispose(self) -> None:
        """Close all topics and services."""
        closings: list[Callable[[], None]] = self.__dict__.pop("_closings", [])
        for closing in reversed(closings):
            closing()

    @classmethod
    def all_options(cls) -> dict[str, ReadOption]:
        """Return the options of this class and its parents."""
        found: dict[str, ReadOption] = {}
        for each in reversed(cls.__mro__):
            found.update(vars(each).get("known_options", {}))
        return found

    def option(self, name: str, usual: T) -> T:
        """Return an option that the artifact was made with, as its reader returned it; *usual* without it."""
        return self.options.get(name, usual)  # type: ignore[return-value]  # readers return what is declared

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
        parts = (self.option("namespace", "").strip("/"), self.robot.strip("/"))
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
        warn: Callable[[str, str], None] | None = None,
    ) -> Matching:
        """Prepare operations to wait for subscribers of *publisher*; see `matched` for the simple way.

        Args:
            publisher: made by `publisher`.
            warn: called with the warning and the help; None: they are logged, once each time the topic loses its last
                subscriber.
        """
        timeout, fails = self.option("match_timeout", MATCH_TIMEOUT), self.option("unmatched", "") == "fail"
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
            timeout if Capability.DISCOVERY in self.ros.capabilities else 0.0,
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

        def watched(sample: Sample) -> None:
            connection.hear()
            callback(sample)

        watch: bool | float = self.option("watch_connection", False)
        name, complain = self.robot_topic(topic), partial(self._steps.setting.log_error, self.name)
        listener = MessageCallback(self.ros.resolve(name), callback if watch is False else watched, complain)
        made = self.kept(self.ros.subscription(name, type_name, listener, qos, on_event))
        if watch is not False:
            changed = partial(self.start, self.show_connection, made.topic)
            expire = None if watch is True else watch
            connection = self.kept(PublisherConnection(self.ros, self.clock, made, changed, expire))
        self.kept(MissingTopic(self.ros, self.clock, made, type_name, self.log, lambda: listener.heard))
        return made

    @internal_operation
    def show_connection(self, topic: str, connected: bool) -> None:
        """Show the property ``connected(Topic)``, or remove it."""
        if not connected:
            self.remove_property("connected", topic)
        else:
            self.define_property("connected", topic)

    def faults_of(self, topic: str) -> BadMessages:
        """Return the counter of bad messages of the robot's *topic*, which logs and signals them."""
        return self.faults_at(self.ros.resolve(self.robot_topic(topic)))

    def faults_at(self, topic: str) -> BadMessages:
        """As `faults_of`, by the absolute name of the topic."""

        def report(why: Structure, text: str) -> None:
            self.log(text)
            self.start(self.report_bad_message, topic, why)

        return BadMessages(topic, report)

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
                `jacaros.robots.kit.services.Reply`; see `jacaros.robots.kit.services` for the effect of its
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
            execute: an `internal_operation` with two parameters, the `jacaros.robots.ros.action.ServerGoal` and the
                `jacaros.robots.kit.services.Reply`; or another function as `jacaros.robots.ros.action.ExecuteCallback`.
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

    def declared_parameter(self, name: str, declaration: DeclaredParameter) -> ParameterValue:
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

    # ---- readings of sensors

    def reading(self, name: str, policy: ReadingPolicy, *initial: object, topic: str = "") -> Reading:
        """Update the property *name* from a sensor according to *policy*, until the artifact is disposed.

        The callback of the sensor passes its values to `Reading.take`; an operation that updates the property on
        request calls `refresh`. If the property does not exist, the next values define it.

        Args:
            name: name of the property.
            policy: when the property is updated.
            initial: values before the first message; not shown if the policy makes values expire.
            topic: topic of the robot under which messages with NaN or infinite numbers are reported; default: *name*.
        """
        if initial and policy.expire is None:
            self.define_property(name, *initial)
        faults = self.faults_of(topic) if topic else self.faults_at(name)

        def deliver(values: Values, cause: Cause | None) -> None:
            if not self._steps.tell(self._show_values, ((name, values),), cause):
                self._show_later([(name, values)], cause)

        behind = partial(self._steps.publication.has_untaken, name)
        withdraw, refuse = partial(self.start, self.withdraw_reading, name), partial(faults.not_finite, name)
        return self.kept(Reading(policy, self.clock, deliver, name, withdraw, refuse, behind))

    def take_together(self, cause: Cause | None, *taken: tuple[Reading, Values]) -> None:
        """Pass the values of one message, whose numbers are known to be finite, to several readings; all updates are
        published in one step."""
        shown: list[tuple[str, Values]] = []
        for reading, values in taken:
            if reading.offer(values, cause):
                shown.append((reading.name, values))
        if shown and not self._steps.tell(self._show_values, shown, cause):
            self._show_later(shown, cause)

    def _show_later(self, shown: list[tuple[str, Values]], cause: Cause | None) -> None:
        """Update properties as soon as the artifact is free."""
        self._steps.publication.coming.update(name for name, _ in shown)
        self.start(self.show_readings, shown, cause=cause)

    @internal_operation
    def show_readings(self, shown: object) -> None:
        """Update properties from a sensor: pairs of name and values."""
        assert isinstance(shown, list)
        self._steps.publication.coming.difference_update(name for name, _ in shown)
        for name, values in shown:
            self._show_values(name, values)

    @internal_operation
    def withdraw_reading(self, name: str) -> None:
        """Remove the property *name*: its values have expired."""
        if self.has_property(name):
            self.remove_property(name)

    @internal_operation
    def show_elements(self, name: str, elements: object, arity: int | None = None) -> None:
        """Show one property *name* for each tuple of values, and remove the others.

        An element that was already shown causes no event.

        Args:
            name: name of the properties.
            elements: their values, as a list of tuples.
            arity: number of values of the properties that are replaced; None: any.
        """
        assert isinstance(elements, list)
        wanted = dict.fromkeys(elements)
        found = [each.values for each in self.find_properties(name)]
        shown = dict.fromkeys(each for each in found if arity in (None, len(each)))
        for old in shown:
            if old not in wanted:
                self.remove_property(name, *old)
        for new in wanted:
            if new not in shown:
                self.define_property(name, *new)

    async def newest(self, reading: Reading, missing: str) -> Values:
        """Return the newest values of a sensor to an operation; wait for its first message if necessary.

        A step boundary only if it waits.

        Raises:
            OperationFailed: no message arrived within `FIRST_MESSAGE` seconds; *missing* names the reason, such as
                ``no_odometry(5)``.
        """
        if reading.newest is None:
            try:
                await self.step(reading.first(FIRST_MESSAGE))
            except TimeoutError:
                self.fail(f"no message arrived within {FIRST_MESSAGE:g} s", missing, FIRST_MESSAGE)
        assert reading.newest is not None
        return reading.newest

    async def give_newest(self, reading: Reading, missing: str, *outs: Out) -> None:
        """Give the `newest` values to the caller of an operation."""
        for out, value in zip(outs, await self.newest(reading, missing), strict=True):
            out.set(value)

    async def refresh(self, name: str, reading: Reading, missing: str) -> None:
        """Update the property *name* to the `newest` values, even if they are equal."""
        await self.newest(reading, missing)
        self._show_values(name, reading.passed())

    # ---- calls and goals

    async def call(
        self, client: Client, timeout: float, /, *, must_succeed: bool = False, **fields: object
    ) -> Any:
        """Call a service from an operation and return its response; a step boundary.

        Args:
            client: client of the service.
            timeout: seconds to wait for the server and for the response, in total.
            must_succeed: treat ``success: false`` in the response (as of ``std_srvs/srv/Trigger``) as a failure.
            fields: fields of the request.

        Raises:
            OperationFailed: ``service_unavailable(Name)``, ``service_timeout(Seconds)``, ``server_lost``,
                ``service_failed(Name)``, ``refused(Text)``, or ``wrong_value(Field)`` if the fields do not match the type.
        """
        try:
            response = await self.step(client.call(fields, timeout))
        except ServiceError as error:
            self.fail(str(error), *failure_reason(error, Atom(client.name.lstrip("/")), timeout))
        except MessageMismatch as error:
            self.fail(str(error), "wrong_value", error.field)
        if must_succeed and not succeeded(client, response):
            message, text = refusal(client.name, response)
            self.fail(message, "refused", text)
        return response

    async def act(
        self,
        client: ActionClient,
        goal: Mapping[str, Any],
        *,
        timeout: float | None = None,
        on_feedback: Callable[[Any], None] | None = None,
        under_way: Callable[[bool], None] | None = None,
        suspend: Suspending | None = None,
    ) -> Any:
        """Run an action goal from an operation and return its result; a step boundary.

        When the intention is dropped, the operation times out, or the artifact or the process ends, the goal is
        cancelled without waiting for the server.

        Args:
            client: client of the action, made by `action_client`.
            goal: fields of the goal.
            timeout: seconds for everything; None: no limit. A server that does not appear, or does not accept or
                reject the goal, is given 5 s in any case.
            on_feedback: called with each feedback message. An `internal_operation` of this artifact can change
                properties; another function runs outside of all operations.
            under_way: called with True when the goal is sent, and with False when it ends, or is cancelled because
                its intention is suspended or dropped; no feedback follows. Runs outside of all operations.
            suspend: effect of suspending the intention: ``go_on``: the goal continues; ``cancel``: the goal is
                cancelled, and sent again on ``.resume``, which needs ``@operation(pausable=True)``, and the time does
                not count. None: ``cancel`` in such an operation, else ``go_on``.

        Raises:
            OperationFailed: ``rejected``, ``aborted(Code,Text)``, ``canceled``, ``timeout(Seconds)``,
                ``server_unavailable`` or ``server_lost``; ``wrong_value(Field)`` if the fields do not match the type
                or a number is NaN.
            InvalidArtifact: the operation is not pausable.
        """
        if suspend is None:
            suspend = "cancel" if self.current.pausable else "go_on"
        self._check_suspending(suspend)
        missing = missing_number(goal)
        if missing is not None:
            told = f"field `{missing}` of the goal is not a number; nothing was sent"
            self.fail(told, "wrong_value", missing)
        options = GoalOptions(timeout, self._feedback(on_feedback), under_way, suspend)
        await self.guarded(client)
        runner = GoalRunner(client, goal, options, self)
        try:
            with guarded_by(self.ros).goal():
                return await self.step(runner.run())
        except MessageMismatch as error:
            self.fail(str(error), "wrong_value", error.field)

    def _check_suspending(self, suspend: Suspending) -> None:
        name = self.current.request.operation
        if suspend not in ("go_on", "cancel"):
            raise InvalidArtifact(f"act(suspend={suspend!r}) in {name}: expected go_on or cancel")
        if suspend != "go_on" and not self.current.pausable:
            raise InvalidArtifact(
                f"act(suspend={suspend!r}) in {name} needs a pausable operation: write @operation(pausable=True)"
            )

    def _feedback(self, on_feedback: Callable[[Any], None] | None) -> Callable[[Any], None] | None:
        if on_feedback is None or self._steps.interface.own(on_feedback, 1) is None:
            return on_feedback
        return partial(self.start, on_feedback)
