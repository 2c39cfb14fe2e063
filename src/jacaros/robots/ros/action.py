"""Actions of the middleware: long-running goals with feedback that can be cancelled, and how a server runs them.

Modelled on ROS 2's actions (design article "Actions") and on ROS 1's actionlib, whose states are mapped to the same
three outcomes. A driver passes on what clients send (`ServedGoals.judge`, `begin`, `cancel`) and receives what to send
them: feedback and the outcome. Everything here happens on the loop of the backend's clock.
"""

import asyncio
from collections.abc import Awaitable, Callable
from dataclasses import dataclass
from enum import StrEnum
from typing import Any, Protocol

from jacaros.robots.ros.errors import MessageMismatch
from jacaros.robots.ros.message import Schema, field_names
from jacaros.robots.ros.names import feedback_type, result_type
from jacaros.runtime.clock import Clock, Timer

SERVER_LOST_AFTER = 3.0
"""Seconds without any sign of the server after which an active goal fails with `ServerLost`."""
PREEMPTED = "preempted by a newer goal"
CLOSED = "the server was closed"
LOOKING = 0.01
"""Seconds within which a server with pre-emption handles new goals and requests to cancel, as in Nav2."""
TEXT_FIELDS = ("error_msg", "message")
"""Fields of action results that hold a text."""


class GoalStatus(StrEnum):
    """How a goal ended.

    ROS 2's numbers are 4, 5 and 6; on ROS 1 ``canceled`` stands for PREEMPTED and RECALLED, ``aborted`` for ABORTED.
    A rejected goal (ROS 2: not accepted; ROS 1: REJECTED) has no status: `ActionClient.send` raises `GoalRejected`.
    """

    SUCCEEDED = "succeeded"
    CANCELED = "canceled"
    ABORTED = "aborted"


@dataclass(frozen=True, slots=True)
class GoalOutcome:
    """The outcome of a goal.

    Attributes:
        status: how it ended.
        result: the result message; one with default values if the server sent none.
        text: the server's text (ROS 1's status text, a field ``error_msg`` or ``message``), or "".
    """

    status: GoalStatus
    result: Any
    text: str = ""


class Abort(Exception):
    """Raise it in the code of a goal to end the goal as aborted.

    Args:
        text: the reason; it is copied to the result's ``error_msg`` if that field exists and is empty.
        result: result message or mapping of its fields; None for the defaults.
    """

    def __init__(self, text: str = "", result: Any = None) -> None:
        super().__init__(text)
        self.text = text
        self.result = result


class ServerGoal:
    """A goal that a server runs.

    Attributes:
        goal_id: id of the goal in the graph.
        request: the goal message.
        cancel_requested: whether the client requested cancelling and was not refused.
    """

    def __init__(
        self,
        goal_id: str,
        request: Any,
        send: Callable[[Any], Any],
        report: Callable[["ServerGoal", GoalOutcome], None],
    ) -> None:
        self.goal_id = goal_id
        self.request = request
        self.cancel_requested = False
        self.task: asyncio.Task[Any] | None = None
        self.overtaken = self.stopped = self.over = False
        self._send = send
        self._report = report

    def feedback(self, message: Any = None, /, **fields: Any) -> None:
        """Send feedback to the client: a feedback message, a mapping, or keywords; ignored after the goal's end.

        Raises:
            MessageMismatch: it does not match the type definition.
        """
        if message is not None and fields:
            raise TypeError("expected a feedback message or its fields, found both")
        if not self.over:
            self._send(message if message is not None else fields)

    def end(self, outcome: GoalOutcome) -> None:
        """Send the outcome, unless it was sent."""
        if not self.over:
            self.over = True
            self._report(self, outcome)

    def stop(self) -> None:
        """Raise ``CancelledError`` in the code of the goal."""
        self.stopped = True
        if self.task is not None:
            self.task.cancel()


ExecuteCallback = Callable[[ServerGoal], Awaitable[Any]]
"""Runs one goal, as a task of its own.

It returns the result of a goal that succeeded (result message, mapping of its fields, None for the defaults). `Abort`
ends the goal as aborted, and so does any other exception, which is also logged. When a request to cancel was
accepted, or a newer goal pre-empts this one, ``CancelledError`` is raised in it; what it then raises or returns is
the outcome: canceled after a request, `ActionPolicy.overtaken` after pre-emption. Stop motion in its ``finally``.
"""

GoalCallback = Callable[[Any], str | None]
"""Takes a goal message; returns None to accept it, or the reason for rejecting it."""


@dataclass(frozen=True, slots=True)
class ActionPolicy:
    """How a server treats goals.

    Attributes:
        accept: decides whether to accept a goal; None accepts all.
        may_cancel: decides whether to accept a request to cancel; None always does.
        preempt: a new goal pre-empts the active one (whose text is ``preempted by a newer goal``), as in Nav2's
            ``SimpleActionServer``; False runs any number of goals in parallel.
        overtaken: status of a pre-empted goal: aborted as in Nav2, or cancelled as in actionlib's
            ``SimpleActionServer``.
    """

    accept: GoalCallback | None = None
    may_cancel: Callable[[ServerGoal], bool] | None = None
    preempt: bool = False
    overtaken: GoalStatus = GoalStatus.ABORTED


class ActionServer(Protocol):
    """Offers an action; each driver has one."""

    @property
    def name(self) -> str:
        """Absolute name of the action."""

    @property
    def abandoned(self) -> bool:
        """Whether no client is left, as far as the middleware shows: False over a bridge."""

    def close(self) -> None:
        """Stop offering the action; active goals are aborted with the text ``the server was closed``."""


class ServedGoals:
    """The goals of one action server.

    With pre-emption they behave as in Nav2's ``SimpleActionServer``: a new goal waits until the server checks, at
    most `LOOKING` seconds. Then the active goal ends as aborted, even if cancelling was requested in that time;
    without a new goal it ends as cancelled. A waiting goal is replaced by a newer one.

    Args:
        clock: measures `LOOKING`.
        factory: makes the messages.
        name: absolute name of the action.
        type_name: action type in full form.
        execute: the user's coroutine function.
        policy: how to treat goals.
        log: called with one line about failed code.
    """

    def __init__(
        self,
        clock: Clock,
        factory: Schema,
        name: str,
        type_name: str,
        execute: ExecuteCallback,
        policy: ActionPolicy,
        log: Callable[[str], None],
    ) -> None:
        self._clock = clock
        self._factory = factory
        self._name = name
        self._result_type = result_type(type_name)
        self._feedback_type = feedback_type(type_name)
        self._execute = execute
        self._policy = policy
        self._log = log
        self._goals: dict[str, ServerGoal] = {}
        self._current: ServerGoal | None = None
        self._waiting: ServerGoal | None = None
        self._look_timer: Timer | None = None
        self._closed = False

    def judge(self, request: Any) -> str | None:
        """Return None if a goal message is accepted, or the reason for rejecting it."""
        if self._closed:
            return CLOSED
        if self._policy.accept is None:
            return None
        try:
            return self._policy.accept(request)
        except Exception as problem:  # the server keeps running, and the client receives the reason
            reason = f"{type(problem).__name__}: {problem}"
            self._log(f"judging a goal of action {self._name} failed: {reason}")
            return reason

    def begin(
        self,
        goal_id: str,
        request: Any,
        feedback: Callable[[Any], None],
        ended: Callable[[GoalOutcome], None],
    ) -> ServerGoal:
        """Run an accepted goal as a task of its own.

        Call *feedback* with each feedback message, and *ended* once with the outcome.

        With pre-emption, the code of the newer goal begins when that of the older one has ended.
        """

        def send(given: Any) -> None:
            feedback(self._factory.checked(self._feedback_type, given))

        def end(goal: ServerGoal, outcome: GoalOutcome) -> None:
            self._goals.pop(goal.goal_id, None)
            ended(outcome)

        goal = ServerGoal(goal_id, request, send, end)
        self._goals[goal_id] = goal
        if self._policy.preempt:
            self._queue(goal)
        else:
            self._start(goal)
        return goal

    def cancel(self, goal_id: str) -> bool:
        """Handle a client's request to cancel; return whether it is accepted."""
        goal = self._goals.get(goal_id)
        if goal is None or goal.overtaken:
            return False
        if goal.cancel_requested:
            return True
        if not self._may_cancel(goal):
            return False
        goal.cancel_requested = True
        if self._policy.preempt:
            self._look_soon()
        else:
            goal.stop()
        return True

    def close(self) -> None:
        """Abort the active goals: send the outcome to their clients immediately, and cancel their code."""
        self._shut()
        for goal in list(self._goals.values()):
            goal.end(self._ended(GoalStatus.ABORTED, None, CLOSED))
            goal.stop()

    def abandon(self) -> None:
        """Stop the active goals without informing clients, as when a process is killed."""
        self._shut()
        for goal in list(self._goals.values()):
            goal.over = True
            goal.stop()
        self._goals.clear()

    def _shut(self) -> None:
        self._closed, self._waiting = True, None
        if self._look_timer is not None:
            self._look_timer.cancel()

    def _start(self, goal: ServerGoal) -> None:
        goal.task = asyncio.get_running_loop().create_task(self._carry_out(goal))
        goal.task.add_done_callback(lambda task: self._ran(goal, task))

    async def _carry_out(self, goal: ServerGoal) -> Any:
        return await self._execute(goal)

    def _ran(self, goal: ServerGoal, task: "asyncio.Task[Any]") -> None:
        goal.end(self._outcome(goal, task))
        if goal is self._current:
            self._current, waiting = None, self._waiting
            self._waiting = None
            if waiting is not None and not self._closed:
                self._queue(waiting)

    # Pre-emption: one goal is active, and at most one waits for it to end.

    def _queue(self, goal: ServerGoal) -> None:
        if self._current is not None:
            self._drop_waiting()
            self._waiting = goal
            self._look_soon()
            return
        self._current = goal
        self._start(goal)
        if goal.cancel_requested:
            self._look_soon()

    def _drop_waiting(self) -> None:
        """End the waiting goal before it has begun."""
        waiting, self._waiting = self._waiting, None
        if waiting is not None:
            waiting.overtaken = not waiting.cancel_requested
            waiting.end(self._cancelled(waiting, None))

    def _look_soon(self) -> None:
        if self._look_timer is None and not self._closed:
            self._look_timer = self._clock.call_later(LOOKING, self._look)

    def _look(self) -> None:
        self._look_timer = None
        current, waiting = self._current, self._waiting
        if current is None or current.stopped or self._closed:
            return
        if waiting is not None and waiting.cancel_requested:
            # As in Nav2, cancelling the waiting goal ends both.
            self._drop_waiting()
            current.overtaken = not current.cancel_requested
        else:
            current.overtaken = waiting is not None
        if current.overtaken or current.cancel_requested:
            current.stop()

    def _may_cancel(self, goal: ServerGoal) -> bool:
        if self._policy.may_cancel is None:
            return True
        try:
            return bool(self._policy.may_cancel(goal))
        except Exception as problem:
            self._log(
                f"judging a cancellation of action {self._name} failed: {type(problem).__name__}: {problem}"
            )
            return False

    def _outcome(self, goal: ServerGoal, task: asyncio.Task[Any]) -> GoalOutcome:
        """Return the outcome that corresponds to the end of a goal's code."""
        if task.cancelled():
            return self._cancelled(goal, None)
        problem = task.exception()
        if problem is None:
            return self._given(goal, task.result())
        if isinstance(problem, Abort):
            return self._aborted(problem)
        return self._failed(f"{type(problem).__name__}: {problem}")

    def _given(self, goal: ServerGoal, result: Any) -> GoalOutcome:
        try:
            message = self._factory.checked(self._result_type, result)
        except MessageMismatch as problem:
            return self._failed(str(problem))
        if goal.stopped:
            return self._cancelled(goal, message)
        return GoalOutcome(GoalStatus.SUCCEEDED, message, text_of(message))

    def _cancelled(self, goal: ServerGoal, result: Any) -> GoalOutcome:
        if goal.overtaken:
            return self._ended(self._policy.overtaken, result, PREEMPTED)
        if goal.cancel_requested:
            return self._ended(GoalStatus.CANCELED, result, "")
        return self._ended(GoalStatus.ABORTED, result, "the code of the goal was cancelled")

    def _aborted(self, problem: Abort) -> GoalOutcome:
        try:
            return self._ended(GoalStatus.ABORTED, problem.result, problem.text)
        except MessageMismatch as mismatch:
            return self._failed(f"{mismatch} (aborting: {problem.text})")

    def _failed(self, reason: str) -> GoalOutcome:
        self._log(f"the code of action {self._name} failed: {reason}")
        return self._ended(GoalStatus.ABORTED, None, reason)

    def _ended(self, status: GoalStatus, result: Any, text: str) -> GoalOutcome:
        message = self._factory.checked(self._result_type, result)
        if text:
            self._fill_in(message, text)
        return GoalOutcome(status, message, text or text_of(message))

    def _fill_in(self, result: Any, text: str) -> None:
        """Write *text* to the result if it has an empty field for it."""
        fields = self._factory.fields(self._result_type)
        for name in TEXT_FIELDS:
            field = fields.get(name)
            if field is not None and field.base == "string" and not field.array and not getattr(result, name):
                setattr(result, name, text)


def text_of(result: Any) -> str:
    """Return the text of a result message, or ""."""
    for name in TEXT_FIELDS:
        if name in (field_names(result) or ()):
            text = getattr(result, name)
            if isinstance(text, str) and text:
                return text
    return ""
