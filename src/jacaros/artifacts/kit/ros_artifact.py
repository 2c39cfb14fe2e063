"""The parent class of artifacts that use ROS: topics, services and actions below the robot's name, closed on
disposal."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

from jacaros.artifacts.env.errors import InvalidArtifact
from jacaros.artifacts.kit.acting import (
    GoalFailed,
    GoalOptions,
    GoalRunner,
    Suspending,
    Switch,
    missing_number,
)
from jacaros.artifacts.kit.sensing_artifact import SensingArtifact
from jacaros.artifacts.kit.services import CallFailure, call
from jacaros.ros.action_client import ActionClient
from jacaros.ros.errors import MessageMismatch
from jacaros.ros.guarded import guarded_by
from jacaros.ros.services import Client


class RosArtifact(SensingArtifact):
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
    """

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
        under_way: Callable[[bool], None] | None = None,
        suspend: Suspending | None = None,
        pause: Switch | None = None,
        resume: Switch | None = None,
        aborted: Callable[[Any], tuple[object, ...]] | None = None,
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
                cancelled, and sent again on ``.resume``; ``pause``: *pause* and *resume* are called. All but
                ``go_on`` need ``@operation(pausable=True)``, and the time does not count. None: ``cancel`` in such an
                operation, else ``go_on``.
            pause, resume: pause the goal at its server and resume it, such as ``lambda: self.pauser.call({"data":
                True}, 2.0)``. A goal that cannot be paused is cancelled, and sent again on ``.resume``. *resume* is
                also called when a paused goal ends or is cancelled: other clients may need the server.
            aborted: computes Code and what follows Text in ``aborted(Code,Text)`` from the result of an aborted goal;
                None: the field ``error_code`` (0 if none exists), and nothing more.

        Raises:
            OperationFailed: ``rejected``, ``aborted(Code,Text)``, ``canceled``, ``timeout(Seconds)``,
                ``server_unavailable`` or ``server_lost``; ``wrong_value(Field)`` if the fields do not match the type
                or a number is NaN.
            InvalidArtifact: the operation is not pausable, or *pause* and *resume* are missing.
        """
        if suspend is None:
            suspend = "cancel" if self.current.pausable else "go_on"
        self._check_suspending(suspend, pause, resume)
        missing = missing_number(goal)
        if missing is not None:
            self.fail(
                f"field `{missing}` of the goal is not a number; nothing was sent", "wrong_value", missing
            )
        options = GoalOptions(
            timeout, self._feedback(on_feedback), under_way, suspend, pause, resume, aborted
        )
        await self.guarded(client)
        runner = GoalRunner(client, goal, options, self.clock, self.current, self.log)
        try:
            with guarded_by(self.ros).goal():
                return await self.step(runner.run())
        except GoalFailed as failed:
            self.fail(str(failed), failed.functor, *failed.arguments)
        except MessageMismatch as error:
            self.fail(str(error), "wrong_value", error.field)

    def _check_suspending(self, suspend: Suspending, pause: Switch | None, resume: Switch | None) -> None:
        name = self.current.request.operation
        if suspend not in ("go_on", "cancel", "pause"):
            raise InvalidArtifact(f"act(suspend={suspend!r}) in {name}: expected go_on, cancel or pause")
        if suspend != "go_on" and not self.current.pausable:
            raise InvalidArtifact(
                f"act(suspend={suspend!r}) in {name} needs a pausable operation: write @operation(pausable=True)"
            )
        if suspend == "pause" and (pause is None or resume is None):
            raise InvalidArtifact(
                f'act(suspend="pause") in {name} needs pause=... and resume=..., which call the server; an action '
                "itself can only be cancelled"
            )

    def _feedback(self, on_feedback: Callable[[Any], None] | None) -> Callable[[Any], None] | None:
        if on_feedback is None or self._steps.interface.own(on_feedback, 1) is None:
            return on_feedback
        return partial(self.start, on_feedback)
