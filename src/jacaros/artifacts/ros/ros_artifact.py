"""The artifact that talks to ROS: topics, services and actions under the robot's name, closed when it is disposed."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any, ClassVar, Protocol, TypeVar

from jacaros.artifacts.ros.acting import Conduct, GoalFailed, Pursuit, Suspending, Switch, missing_number
from jacaros.artifacts.ros.calling import CallFailure, call
from jacaros.artifacts.ros.connection import Connection
from jacaros.artifacts.ros.faults import Faults
from jacaros.artifacts.ros.listener import Listener
from jacaros.artifacts.ros.missing import MissingTopic
from jacaros.artifacts.ros.offering import Offer
from jacaros.artifacts.ros.options import Reader, WrongOption, read_arguments, text, watching
from jacaros.artifacts.ros.reading import Outlet, Reading, ReadingPolicy, Values
from jacaros.env.artifact import Artifact, internal_operation
from jacaros.env.errors import InvalidArtifact
from jacaros.env.operation import marks_of
from jacaros.env.values import Structure
from jacaros.ros.action import ActionClient, ActionPolicy, ActionServer
from jacaros.ros.backend import (
    DEFAULT_POLICY,
    Backend,
    Client,
    Publisher,
    Sample,
    Service,
    Subscription,
    TopicEvent,
)
from jacaros.ros.errors import MessageMismatch, RosError
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

    Options:
        namespace(N): what stands before topics, as a robot's name does.
        watch_connection(true): show `connected`; with a number of seconds instead of true, a topic also counts as
            lost when no message came for so long.

    Properties:
        connected(Topic): somebody publishes the topic, as far as is known, and the graph can be reached; one for each
            topic that the artifact listens to, with its absolute name as text.  Only with `watch_connection`.

    Signals:
        bad_message(Topic, Why): a message was wrong; told for the first, the tenth, the hundredth ... of a kind.  Why
            is ``not_finite(What)``, ``wrong_frame(Frame)``, ``out_of_order(Seconds)``, ``clock_jumped(Seconds)`` or
            ``stamp_off(Seconds)``.

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
    _together: "list[tuple[str, Values, Callable[[], None]]] | None" = None

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
            made = self._kept(self.ros.subscription(name, type_name, listener, qos, on_event))
        else:
            expire = None if watch is True else float(str(watch))
            made = self._watched(name, type_name, listener, qos, on_event, expire)
        self._kept(MissingTopic(self.ros, self.clock, made, type_name, self.log))
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

        made = self._kept(self.ros.subscription(name, type_name, take, qos, on_event))
        changed = partial(self.start, self.show_connection, made.topic)
        connection = self._kept(Connection(self.ros, self.clock, made, changed, expire))
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
        return self._faults(self.ros.resolve(self.robot_topic(topic)))

    def _faults(self, topic: str) -> Faults:

        def tell(why: Structure, text: str) -> None:
            self.log(text)
            self.start(self.tell_bad_message, topic, why)

        return Faults(topic, tell)

    @internal_operation
    def tell_bad_message(self, topic: str, why: object) -> None:
        """Signal ``bad_message(Topic, Why)``."""
        self.signal("bad_message", topic, why)

    def client(self, service: str, type_name: str) -> Client:
        """Call the service until the artifact is disposed."""
        return self._kept(self.ros.client(service, type_name))

    def action_client(self, name: str, type_name: str) -> ActionClient:
        """Send goals to the robot's action *name*, by `act`; they are cancelled when the artifact or the process ends.

        Args:
            name: below the robot's name, such as ``navigate_to_pose``.
            type_name: such as ``nav2_msgs/action/NavigateToPose``.
        """
        client = self._kept(self.ros.action_client(self.robot_topic(name), type_name))
        self.at_dispose(self.ros.add_exit_hook(client.close))
        return client

    def service(self, name: str, type_name: str, handler: Callable[..., Any]) -> Service:
        """Offer the robot's service *name* until the artifact is disposed.

        Args:
            name: below the robot's name, such as ``take_order``.
            type_name: such as ``std_srvs/srv/Trigger``.
            handler: an `internal_operation` of this artifact with two parameters, the request and the
                `jacaros.artifacts.ros.offering.Reply`; see `jacaros.artifacts.ros.offering` for what its failure
                means.  Another function takes the request, gives the response, and stands outside of all operations.
        """
        offer = self._offer(handler)
        handle = handler if offer is None else offer.handler(type_name)
        return self._kept(self.ros.service(self.robot_topic(name), type_name, handle))

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
                `jacaros.artifacts.ros.offering.Reply`; or another function as `jacaros.ros.action.Execute`.
            policy: which goals are accepted, and whether a newer one takes over.
        """
        offer = self._offer(execute)
        code = execute if offer is None else offer.execute(type_name)
        return self._kept(self.ros.action_server(self.robot_topic(name), type_name, code, policy))

    def _offer(self, operation: Callable[..., Any]) -> Offer | None:
        declared = self._steps.interface.own(operation, 2)
        if declared is not None:
            return Offer(self.ros, self._steps, self.id, declared)
        if marks_of(getattr(operation, "__func__", operation)):
            raise InvalidArtifact(
                f"{operation.__qualname__} cannot serve requests: write it with two parameters, request and reply"
            )
        return None

    def reading(self, name: str, policy: ReadingPolicy, *initial: object) -> Reading:
        """Let the property *name* follow a sensor by *policy*; ends with the artifact.

        The callback of the sensor gives its values to `Reading.take`; an operation that refreshes the
        property on request calls `refresh`.  A property that is not there yet, or no more, is defined by the next
        values.

        Args:
            name: of the property.
            policy: when it is updated.
            initial: values before the first message, which are shown unless they would have to expire.
        """
        if initial and policy.expire is None:
            self.define_property(name, *initial)
        coming = 0
        faults: dict[str, Faults] = {}

        def deliver(values: Values, cause: Cause | None) -> None:
            nonlocal coming
            coming += 1
            if self._together is None:
                self.start(self.show_readings, [(name, values, arrived)], cause=cause)
            else:
                self._together.append((name, values, arrived))

        def arrived() -> None:
            nonlocal coming
            coming = 0

        def refuse(number: float, cause: Cause | None) -> None:
            topic = cause.what if cause is not None else name
            faults.setdefault(topic, self._faults(topic)).not_finite(name, number)

        def behind() -> bool:
            return coming > 0 or self.has_untaken(name)

        outlet = Outlet(partial(self.start, self.withdraw_reading, name), refuse, behind)
        return self._kept(Reading(policy, self.clock, deliver, outlet))

    def take_together(self, cause: Cause | None, *taken: tuple[Reading, Values]) -> None:
        """Give several readings the values of one message; what they pass on becomes known in one step."""
        shown = self._together = []
        try:
            for reading, values in taken:
                reading.take(values, cause)
        finally:
            self._together = None
        if shown:
            self.start(self.show_readings, shown, cause=cause)

    @internal_operation
    def show_readings(self, shown: object) -> None:
        """Give properties new values, on behalf of a sensor: name, values, and what is called when they are known."""
        assert isinstance(shown, list)
        for name, values, arrived in shown:
            arrived()
            self._show_values(name, values)

    @internal_operation
    def withdraw_reading(self, name: str) -> None:
        """Take the property *name* away: what it says has expired."""
        if self.has_property(name):
            self.remove_property(name)

    def _show_values(self, name: str, values: Values) -> None:
        if self.has_property(name):
            self.update_property(name, *values)
        else:
            self.define_property(name, *values)

    @internal_operation
    def show_elements(self, name: str, elements: object) -> None:
        """Have one property *name* for each of some tuples of values, and none of those before; see `view`.

        An element that was shown before gives no event.
        """
        assert isinstance(elements, list)
        wanted = dict.fromkeys(elements)
        shown = [each.values for each in self.find_properties(name)]
        for old in shown:
            if old not in wanted:
                self.remove_property(name, *old)
        for new in wanted:
            if new not in shown:
                self.define_property(name, *new)

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
        self._show_values(name, reading.passed())

    def at_dispose(self, closing: Callable[[], None]) -> None:
        """Have *closing* called when the artifact is disposed; the last given is called first."""
        self.__dict__.setdefault("_closings", []).append(closing)

    def _kept(self, connection: C) -> C:
        self.at_dispose(connection.close)
        return connection

    async def call(
        self, client: Client, timeout: float, /, *, must_succeed: bool = False, **fields: object
    ) -> Any:
        """Call a service from an operation and give its response; a step boundary.

        Args:
            client: of the service.
            timeout: seconds for waiting for the server and for the answer together.
            must_succeed: take ``success: false`` in the response (as of ``std_srvs/srv/Trigger``) for a failure.
            fields: of the request.

        Raises:
            OperationFailed: ``service_unavailable(Name)``, ``service_timeout(Seconds)``, ``service_failed(Name)``,
                ``refused(Text)``, or ``wrong_value(Field)`` when the fields do not fit.
        """
        try:
            return await self.step(call(client, timeout, fields, must_succeed))
        except CallFailure as failure:
            self.fail(str(failure), failure.functor, *failure.arguments)
        except MessageMismatch as error:
            self.fail(str(error), "wrong_value", error.field)

    async def act(
        self,
        client: ActionClient,
        goal: Mapping[str, Any],
        *,
        timeout: float | None = None,
        on_feedback: Callable[[Any], None] | None = None,
        suspend: Suspending = "go_on",
        pause: Switch | None = None,
        resume: Switch | None = None,
    ) -> Any:
        """Pursue a goal of an action from an operation and give its result; a step boundary.

        When the intention is dropped, the operation's time is up, or the artifact or the process ends, the goal is
        cancelled; nobody waits for that.

        Args:
            client: of the action, made by `action_client`.
            goal: fields of the goal.
            timeout: seconds for all of it; None: no limit.  A server that is not there, or does not say whether it
                accepts, is given up after 5 s anyway.
            on_feedback: takes each feedback message.  An `internal_operation` of this artifact may change properties;
                another function stands outside of all operations.
            suspend: what happens while the intention is suspended: ``go_on``; ``cancel``, the goal is cancelled, and
                sent again at ``.resume``; ``pause``, by *pause* and *resume*.  All but ``go_on`` need
                ``@operation(pausable=True)``, and the time does not count.
            pause, resume: pause the goal at its server and let it go on, such as
                ``lambda: self.pauser.call({"data": True}, 2.0)``.  A goal that cannot be paused is cancelled, and sent
                again at ``.resume``.

        Raises:
            OperationFailed: ``rejected``, ``aborted(Code,Text)``, ``canceled``, ``timeout(Seconds)`` or
                ``server_lost``; ``wrong_value(Field)`` when the fields do not fit or one is not a number (NaN).
            InvalidArtifact: the operation is not pausable, or *pause* and *resume* are missing.
        """
        self._check_suspending(suspend, pause, resume)
        missing = missing_number(goal)
        if missing is not None:
            self.fail(f"the goal's {missing} is not a number; nothing was sent", "wrong_value", missing)
        conduct = Conduct(timeout, self._feedback(on_feedback), suspend, pause, resume)
        try:
            return await self.step(Pursuit(client, goal, conduct, self.clock, self.current, self.log).run())
        except GoalFailed as failed:
            self.fail(str(failed), failed.functor, *failed.arguments)
        except MessageMismatch as error:
            self.fail(str(error), "wrong_value", error.field)

    def _check_suspending(self, suspend: Suspending, pause: Switch | None, resume: Switch | None) -> None:
        name = self.current.request.operation
        if suspend not in ("go_on", "cancel", "pause"):
            raise InvalidArtifact(f"act(suspend={suspend!r}) in {name}: it is go_on, cancel or pause")
        if suspend != "go_on" and not self.current.pausable:
            raise InvalidArtifact(
                f"act(suspend={suspend!r}) in {name} needs to be told of pauses: write @operation(pausable=True)"
            )
        if suspend == "pause" and (pause is None or resume is None):
            raise InvalidArtifact(
                f'act(suspend="pause") in {name} needs pause=... and resume=..., which ask the server for it; an action '
                "itself can only be cancelled"
            )

    def _feedback(self, on_feedback: Callable[[Any], None] | None) -> Callable[[Any], None] | None:
        if on_feedback is None or self._steps.interface.own(on_feedback, 1) is None:
            return on_feedback
        return partial(self.start, on_feedback)
