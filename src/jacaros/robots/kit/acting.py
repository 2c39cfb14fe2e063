"""An action goal as one step of a plan: sent, followed, suspended, cancelled.

A goal that does not succeed ends with one of six reasons, which a plan receives as ``env_failure_reason(R)``:

====================  ==============================================================================================
R                     meaning
====================  ==============================================================================================
rejected              the server rejected the goal; the robot has done nothing
aborted(Code,Text)    the server aborted the goal: the result's ``error_code`` (0 if it has none) and its error text
canceled              another client cancelled the goal
timeout(S)            the goal took longer than S seconds, and was cancelled
server_unavailable    no server offered the action within 5 s; the robot has done nothing
server_lost           the server disappeared during the goal; it is unknown whether the robot is still moving
====================  ==============================================================================================
"""

import asyncio
import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeVar

from jacaros.artifacts.env.artifact import Artifact
from jacaros.robots.ros.action import GoalOutcome, GoalStatus
from jacaros.robots.ros.action_client import ENDING, ActionClient, GoalHandle
from jacaros.robots.ros.errors import CallTimedOut, GoalRejected, ServerLost, ServerUnavailable, ServiceError
from jacaros.runtime.clock import Clock

T = TypeVar("T")

Suspending = Literal["go_on", "cancel"]
"""Effect of suspending the intention on its goal: the goal continues; or it is cancelled, and sent again on
``.resume``."""

ACCEPTANCE = 5.0
"""Seconds to wait for the server to appear and to accept a goal."""

GRACE = 1.0
"""Seconds to wait for the result of a goal after its server has refused to cancel it: it may just have ended."""

CODES = ("error_code", "error_code.val")
"""Result fields that hold an error code: of Nav2 and others, and of MoveIt."""

TEXTS = ("error_msg", "error_string", "message")
"""Result fields that hold an error text."""


@dataclass(frozen=True, slots=True)
class GoalOptions:
    """How a goal runs.

    Attributes:
        timeout: seconds that the goal may take in total; None: no limit. Time during which it is cancelled because its
            intention is suspended does not count.
        on_feedback: called on the loop with each feedback message while the goal is active.
        under_way: called with True when a goal is sent, and with False when it ends or its operation no longer needs
            it.
        suspend: effect of suspending the intention on the goal.
    """

    timeout: float | None = None
    on_feedback: Callable[[Any], None] | None = None
    under_way: Callable[[bool], None] | None = None
    suspend: Suspending = "go_on"


class GoalRunner:
    """Run one goal, from the request of an operation to the result.

    Args:
        client: client of the action.
        goal: fields of the goal.
        options: how the goal runs.
        artifact: the artifact of the operation, which reports pauses.
    """

    def __init__(
        self, client: ActionClient, goal: Mapping[str, Any], options: GoalOptions, artifact: Artifact
    ) -> None:
        self._client, self._goal, self._options = client, goal, options
        self._clock, self._execution = artifact.clock, artifact.current
        self._log, self._fail = artifact.log, artifact.fail
        self._used = self._limit = 0.0
        self._heeded = False
        self._wake: asyncio.Future[None] | None = None

    async def run(self) -> Any:
        """Run the goal to its end and return the result message.

        Cancelling this coroutine cancels the goal without waiting for the server.

        Raises:
            OperationFailed: with one of the reasons listed at the top of this file.
        """
        forget = None if self._options.suspend == "go_on" else self._execution.on_pause(self._on_pause)
        try:
            while True:
                if forget is not None:
                    await self._execution.resumed()
                outcome = await self._once()
                if outcome is not None:
                    return self._result(outcome)
        except GoalRejected as error:
            self._fail(str(error), "rejected")
        except CallTimedOut as error:
            self._fail(str(error), "timeout", _figure(self._limit))
        except ServerUnavailable as error:
            self._fail(str(error), "server_unavailable")
        except ServiceError as error:
            self._fail(str(error), "server_lost")
        finally:
            if forget is not None:
                forget()

    def _on_pause(self) -> None:
        if self._wake is not None and not self._wake.done():
            self._wake.set_result(None)

    @property
    def _paused(self) -> bool:
        return self._options.suspend != "go_on" and self._execution.paused

    def _heed(self, under_way: bool) -> None:
        """Switch feedback on or off. A goal that is being cancelled may send feedback for a while; it is ignored."""
        if under_way != self._heeded:
            self._heeded = under_way
            if self._options.under_way is not None:
                self._options.under_way(under_way)

    def _hear(self, feedback: Any) -> None:
        if self._heeded and self._options.on_feedback is not None:
            self._options.on_feedback(feedback)

    async def _once(self) -> GoalOutcome | None:
        """Send the goal and follow it. Return None if it was cancelled because the intention was suspended."""
        self._heed(True)
        try:
            handle = await self._send()
            return None if handle is None else await self._follow_to_the_end(handle)
        finally:
            self._heed(False)

    async def _follow_to_the_end(self, handle: GoalHandle) -> GoalOutcome | None:
        ending = asyncio.ensure_future(handle.outcome())
        try:
            return await self._follow(handle, ending)
        except BaseException:
            handle.abandon()
            raise
        finally:
            _forget(ending)

    async def _send(self) -> GoalHandle | None:
        """Send the goal. Return None, and cancel it, if the intention is suspended before the server accepts it."""
        options = self._options
        began, share, self._limit = self._clock.elapsed, ACCEPTANCE, ACCEPTANCE
        if options.timeout is not None and options.timeout - self._used < ACCEPTANCE:
            share, self._limit = options.timeout - self._used, options.timeout
        sending = asyncio.ensure_future(self._client.send(self._goal, self._hear, share))
        try:
            while not sending.done():
                if options.suspend == "cancel":
                    await self._first_of(sending, None)
                    if self._paused and not sending.done():
                        sending.cancel()  # also cancels the goal if the server accepts it later
                        return None
                else:
                    await any_of(self._clock, (sending,), None)
            self._used += self._clock.elapsed - began
            return sending.result()
        except asyncio.CancelledError:
            if sending.done() and not sending.cancelled() and sending.exception() is None:
                sending.result().abandon()
            raise
        finally:
            _forget(sending)

    async def _follow(self, handle: GoalHandle, ending: "asyncio.Future[GoalOutcome]") -> GoalOutcome | None:
        timeout = self._options.timeout
        while not ending.done():
            if self._paused:
                if await self._is_cancelled(handle, ending):
                    return None
                continue
            began = self._clock.elapsed
            await self._first_of(ending, None if timeout is None else timeout - self._used)
            self._used += self._clock.elapsed - began
            if timeout is not None and self._used >= timeout - 1e-6 and not ending.done():
                text = f"action {self._client.name} did not end within {timeout:g} s"
                self._fail(text, "timeout", _figure(timeout))
        return ending.result()

    async def _is_cancelled(self, handle: GoalHandle, ending: "asyncio.Future[GoalOutcome]") -> bool:
        """Cancel the goal of a suspended intention. Return False if it succeeds meanwhile or continues.

        Once cancelling was requested, the goal counts as cancelled however it ends, unless it succeeds: a server that
        accepts the next goal before it handles the request reports this one as aborted.
        """
        self._heed(False)
        try:
            agreed = await handle.cancel(ENDING)
        except CallTimedOut as error:
            self._log(f"{error}; the goal may continue although its intention is suspended")
            agreed = False
        if agreed:
            await any_of(self._clock, (ending,), ENDING)
            if not ending.done():
                raise ServerLost(f"action {self._client.name} agreed to cancel a goal but did not end it")
        else:
            # The server also refuses if the goal has just ended; then the result is about to arrive.
            await self._resumed_or(ending, GRACE)
        if ending.done():
            return ending.result().status is not GoalStatus.SUCCEEDED
        self._heed(True)
        if self._paused:
            self._log(f"the goal of action {self._client.name} continues although its intention is suspended")
            await self._resumed_or(ending, None)
        return False

    async def _resumed_or(self, ending: "asyncio.Future[GoalOutcome]", seconds: float | None) -> None:
        """Wait for the end of the pause or of the goal, at most *seconds*."""
        resumed = asyncio.ensure_future(self._execution.resumed())
        try:
            await any_of(self._clock, (ending, resumed), seconds)
        finally:
            _forget(resumed)

    async def _first_of(self, future: "asyncio.Future[Any]", seconds: float | None) -> None:
        """Wait for *future* or for a pause to begin, at most *seconds*."""
        self._wake = asyncio.get_running_loop().create_future()
        if self._paused:
            self._wake.set_result(None)
        await any_of(self._clock, (future, self._wake), seconds)
        self._wake = None

    def _result(self, outcome: GoalOutcome) -> Any:
        name = self._client.name
        if outcome.status is GoalStatus.CANCELED:
            self._fail(outcome.text or f"another client cancelled the goal of action {name}", "canceled")
        if outcome.status is not GoalStatus.SUCCEEDED:
            code, text = error_code(outcome.result), outcome.text or error_text(outcome.result)
            number, told = f" with code {code}" if code else "", f": {text}" if text else ""
            self._fail(f"action {name} was aborted{number}{told}", "aborted", code, text)
        return outcome.result


def error_code(result: Any) -> int:
    """Return the error code of a result, 0 if it has none."""
    for path in CODES:
        value: Any = result
        for name in path.split("."):
            value = getattr(value, name, None)
        if isinstance(value, int) and not isinstance(value, bool):
            return value
    return 0


def error_text(result: Any) -> str:
    """Return the error text of a result, empty if it has none."""
    for name in TEXTS:
        value = getattr(result, name, "")
        if isinstance(value, str) and value:
            return value
    return ""


def missing_number(fields: object, path: str = "") -> str | None:
    """Return the path of the first NaN in the fields of a goal or request, None if none exists."""
    if isinstance(fields, float) and math.isnan(fields):
        return path
    if isinstance(fields, Mapping):
        pairs = [(f"{path}.{name}" if path else str(name), each) for name, each in fields.items()]
    elif isinstance(fields, list | tuple):
        pairs = [(f"{path}[{index}]", each) for index, each in enumerate(fields)]
    else:
        return None
    return next((found for where, each in pairs if (found := missing_number(each, where)) is not None), None)


async def any_of(clock: Clock, futures: tuple["asyncio.Future[Any]", ...], seconds: float | None) -> None:
    """Wait until one of *futures* is done, at most *seconds* on the clock; None: no limit."""
    over: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    def wake(done: object = None) -> None:
        if not over.done():
            over.set_result(None)

    timer = None if seconds is None else clock.call_later(max(0.0, seconds), wake)
    for future in futures:
        future.add_done_callback(wake)
    try:
        await over
    finally:
        if timer is not None:
            timer.cancel()
        for future in futures:
            future.remove_done_callback(wake)


def _forget(future: "asyncio.Future[T]") -> None:
    """Cancel a future, or ignore its outcome if it is done."""
    if future.done():
        if not future.cancelled():
            future.exception()
    else:
        future.cancel()


def _figure(seconds: float) -> float | int:
    """Write whole seconds as programs do: 5, not 5.0."""
    return int(seconds) if seconds == int(seconds) else seconds
