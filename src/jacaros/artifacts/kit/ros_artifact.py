"""The artifact that talks to ROS: topics, services and actions under the robot's name, closed when it is disposed."""

from collections.abc import Callable, Mapping
from functools import partial
from typing import Any

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
from jacaros.env.errors import InvalidArtifact
from jacaros.ros.action import ActionClient
from jacaros.ros.backend import Client
from jacaros.ros.errors import MessageMismatch


class RosArtifact(SensingArtifact):
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
        connected(Topic): somebody publishes the topic, as far as is known; one for each topic that the artifact
            listens to, with its absolute name as text.  Only with `watch_connection`.

    Signals:
        bad_message(Topic, Why): a message was wrong; told for the first, the tenth, the hundredth ... of a kind.  Why
            is ``not_finite(What)``, ``out_of_range(What)``, ``wrong_frame(Frame)``, ``out_of_order(Seconds)``,
            ``clock_jumped(Seconds)``, ``stamp_off(Seconds)`` or ``late(Seconds)``.
    """

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
        under_way: Callable[[bool], None] | None = None,
        suspend: Suspending | None = None,
        pause: Switch | None = None,
        resume: Switch | None = None,
        aborted: Callable[[Any], tuple[object, ...]] | None = None,
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
            under_way: told True when the goal is sent, and False when it is over, or cancelled because its intention is
                suspended or dropped; no feedback comes after that.  It stands outside of all operations.
            suspend: what happens while the intention is suspended: ``go_on``; ``cancel``, the goal is cancelled, and
                sent again at ``.resume``; ``pause``, by *pause* and *resume*.  All but ``go_on`` need
                ``@operation(pausable=True)``, and the time does not count.  None: ``cancel`` in such an operation,
                else ``go_on``.
            pause, resume: pause the goal at its server and let it go on, such as
                ``lambda: self.pauser.call({"data": True}, 2.0)``.  A goal that cannot be paused is cancelled, and sent
                again at ``.resume``.  When a paused goal has ended, or was cancelled, *resume* is called too: others may
                want the server.
            aborted: from the result of an aborted goal, gives Code and what follows Text in ``aborted(Code,Text)``;
                None: the field ``error_code`` (0 without one), and nothing.

        Raises:
            OperationFailed: ``rejected``, ``aborted(Code,Text)``, ``canceled``, ``timeout(Seconds)``,
                ``server_unavailable`` or ``server_lost``; ``wrong_value(Field)`` when the fields do not fit or one is not
                a number (NaN).
            InvalidArtifact: the operation is not pausable, or *pause* and *resume* are missing.
        """
        if suspend is None:
            suspend = "cancel" if self.current.pausable else "go_on"
        self._check_suspending(suspend, pause, resume)
        missing = missing_number(goal)
        if missing is not None:
            self.fail(f"the goal's {missing} is not a number; nothing was sent", "wrong_value", missing)
        options = GoalOptions(
            timeout, self._feedback(on_feedback), under_way, suspend, pause, resume, aborted
        )
        try:
            return await self.step(
                GoalRunner(client, goal, options, self.clock, self.current, self.log).run()
            )
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
