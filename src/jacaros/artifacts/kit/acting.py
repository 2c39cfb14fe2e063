"""One goal of an action as one step of a plan: sent, followed, suspended, given up.

What ends it early is one of six reasons; a plan gets them as ``env_failure_reason(R)``:

====================  ==============================================================================================
R                     what happened
====================  ==============================================================================================
rejected              the server refused the goal; the robot has done nothing
aborted(Code,Text)    the server gave up: the result's ``error_code`` (0 without one), and what the server says of it;
                      `GoalOptions.aborted` may give another code, and more arguments
canceled              somebody else cancelled the goal
timeout(S)            S seconds were too few; the goal is cancelled
server_unavailable    no server offered the action within 5 s; the robot has done nothing
server_lost           the server went away during the goal: whether the robot goes on is not known
====================  ==============================================================================================
"""

import asyncio
import math
from collections.abc import Awaitable, Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, TypeVar

from jacaros.clock import Clock
from jacaros.env.execution import OperationExecution
from jacaros.ros.action import ActionClient, GoalHandle, GoalStatus, Outcome
from jacaros.ros.errors import CallTimedOut, GoalRejected, ServerLost, ServerUnavailable, ServiceError
from jacaros.ros.pending_goal import ENDING

T = TypeVar("T")

Suspending = Literal["go_on", "cancel", "pause"]
"""What becomes of a goal while its intention is suspended: it goes on; it is cancelled, and sent again at ``.resume``; or
it is paused."""

Switch = Callable[[], Awaitable[object] | None]
"""Pauses a goal or lets it go on, such as by calling a service; it stands outside of all operations."""

ACCEPTANCE = 5.0
"""Seconds that a server has for being there and for accepting a goal."""

GRACE = 1.0
"""Seconds in which the end of a goal may come that is why the server would not cancel it."""

CODES = ("error_code", "error_code.val")
"""Fields of results that say why a goal was aborted: of Nav2 and others, and of MoveIt."""

TEXTS = ("error_msg", "error_string", "message")
"""Fields of results that say it in words."""


class GoalFailed(Exception):
    """A goal did not succeed.

    Attributes:
        functor, arguments: the failure reason, such as ``aborted(203,"no path")``.
    """

    def __init__(self, message: str, functor: str, *arguments: object) -> None:
        super().__init__(message)
        self.functor, self.arguments = functor, arguments


@dataclass(frozen=True, slots=True)
class GoalOptions:
    """How a goal is followed.

    Attributes:
        timeout: seconds that the goal may take in all; None: no limit.  Time in which it is cancelled or paused because
            of a suspended intention does not count.
        on_feedback: takes each feedback message while the goal is under way, on the loop.
        under_way: told True when a goal is sent, and False when it is over or nobody wants it any more.
        suspend: what a suspended intention means for the goal.
        pause, resume: pause the goal at its server, and let it go on; for ``suspend="pause"``.
        aborted: gives Code, and what follows Text in ``aborted(Code,Text)``, from the result of an aborted goal.
    """

    timeout: float | None = None
    on_feedback: Callable[[Any], None] | None = None
    under_way: Callable[[bool], None] | None = None
    suspend: Suspending = "go_on"
    pause: Switch | None = None
    resume: Switch | None = None
    aborted: "Callable[[Any], tuple[object, ...]] | None" = None


class GoalRunner:
    """The life of one goal, from the request of an operation to the result.

    Args:
        client: of the action.
        goal: fields of the goal.
        options: how it is followed.
        clock: measures the times.
        execution: the operation; it tells of pauses.
        log: takes a line about trouble that harms nobody.
    """

    def __init__(
        self,
        client: ActionClient,
        goal: Mapping[str, Any],
        options: GoalOptions,
        clock: Clock,
        execution: OperationExecution,
        log: Callable[[str], None],
    ) -> None:
        self._client, self._goal, self._options = client, goal, options
        self._clock, self._execution, self._log = clock, execution, log
        self._used = self._limit = 0.0
        self._heeded = self._held = False
        self._wake: asyncio.Future[None] | None = None

    async def run(self) -> Any:
        """Pursue the goal to its end and give the result message.

        Cancelling this cancels the goal, and waits for nobody.

        Raises:
            GoalFailed: with one of the reasons of this file.
        """
        forget = None if self._options.suspend == "go_on" else self._execution.on_pause(self._on_pause)
        try:
            while True:
                if forget is not None:
                    await self._execution.resumed()
                    await self._release()
                outcome = await self._once()
                if outcome is not None:
                    return self._result(outcome)
        except GoalRejected as error:
            raise GoalFailed(str(error), "rejected") from None
        except CallTimedOut as error:
            raise GoalFailed(str(error), "timeout", _figure(self._limit)) from None
        except ServerUnavailable as error:
            raise GoalFailed(str(error), "server_unavailable") from None
        except ServiceError as error:
            raise GoalFailed(str(error), "server_lost") from None
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
        """Hear the feedback, or no more: a goal that is being cancelled may go on with it for a while."""
        if under_way != self._heeded:
            self._heeded = under_way
            if self._options.under_way is not None:
                self._options.under_way(under_way)

    def _hear(self, feedback: Any) -> None:
        if self._heeded and self._options.on_feedback is not None:
            self._options.on_feedback(feedback)

    async def _once(self) -> Outcome | None:
        """Send the goal and follow it; None when it was cancelled because the intention was suspended."""
        self._heed(True)
        try:
            handle = await self._send()
            return None if handle is None else await self._follow_to_the_end(handle)
        finally:
            self._heed(False)

    async def _follow_to_the_end(self, handle: GoalHandle) -> Outcome | None:
        ending = asyncio.ensure_future(handle.outcome())
        try:
            outcome = await self._follow(handle, ending)
            await self._release()
            return outcome
        except BaseException:
            handle.abandon(self._release)
            raise
        finally:
            _forget(ending)

    async def _send(self) -> GoalHandle | None:
        """Send the goal; None when the intention was suspended before the server accepted it, which cancels it."""
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
                        sending.cancel()  # which cancels the goal, should the server accept it
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

    async def _follow(self, handle: GoalHandle, ending: "asyncio.Future[Outcome]") -> Outcome | None:
        timeout = self._options.timeout
        while not ending.done():
            if self._paused:
                if self._options.suspend == "pause" and await self._is_held():
                    await self._rest(ending)
                elif await self._is_cancelled(handle, ending):
                    return None
                continue
            began = self._clock.elapsed
            await self._first_of(ending, None if timeout is None else timeout - self._used)
            self._used += self._clock.elapsed - began
            if timeout is not None and self._used >= timeout - 1e-6 and not ending.done():
                text = f"action {self._client.name} did not end within {timeout:g} s"
                raise GoalFailed(text, "timeout", _figure(timeout))
        return ending.result()

    async def _rest(self, ending: "asyncio.Future[Outcome]") -> None:
        """Wait for the end of the pause, or of the goal."""
        await self._resumed_or(ending, None)
        if not ending.done() and not await self._release():
            raise GoalFailed(f"the goal of {self._client.name} could not be resumed", "canceled")

    async def _is_cancelled(self, handle: GoalHandle, ending: "asyncio.Future[Outcome]") -> bool:
        """Cancel the goal for a suspended intention; False when it succeeds meanwhile, or goes on.

        A goal that was asked to be cancelled counts as cancelled however it ends, unless it succeeded: a server that
        takes the next goal before it has dealt with the request ends this one as aborted.
        """
        self._heed(False)
        try:
            agreed = await handle.cancel(ENDING)
        except CallTimedOut as error:
            self._log(f"{error}; it may go on although its intention is suspended")
            agreed = False
        if agreed:
            await any_of(self._clock, (ending,), ENDING)
            if not ending.done():
                raise ServerLost(f"action {self._client.name} agreed to cancel a goal but did not end it")
        else:
            # A server also refuses because the goal has just ended, and that may be on its way.
            await self._resumed_or(ending, GRACE)
        if ending.done():
            return ending.result().status is not GoalStatus.SUCCEEDED
        self._heed(True)
        if self._paused:
            self._log(f"the goal of {self._client.name} goes on although its intention is suspended")
            await self._resumed_or(ending, None)
        return False

    async def _resumed_or(self, ending: "asyncio.Future[Outcome]", seconds: float | None) -> None:
        """Wait for the end of the pause, or of the goal, at most *seconds*."""
        resumed = asyncio.ensure_future(self._execution.resumed())
        try:
            await any_of(self._clock, (ending, resumed), seconds)
        finally:
            _forget(resumed)

    async def _is_held(self) -> bool:
        """Pause the goal at its server; False when that failed."""
        self._held = True
        problem = await self._switch(self._options.pause, "paused")
        # A server that was asked and did not answer may have paused.
        self._held = problem is None or isinstance(problem, CallTimedOut)
        return problem is None

    async def _release(self) -> bool:
        """Let the server go on that was paused: with the goal, or with those of others after it; False when it does not."""
        if self._held:
            self._held = await self._switch(self._options.resume, "resumed") is not None
        return not self._held

    async def _switch(self, switch: Switch | None, what: str) -> Exception | None:
        """Pause the server, or let it go on; gives what went wrong."""
        assert switch is not None
        try:
            waiting = switch()
            if waiting is not None:
                await waiting
        except Exception as error:  # whatever a user's code raises: the robot must not drive on because of it
            self._log(f"the goal of {self._client.name} could not be {what}: {type(error).__name__}: {error}")
            return error
        return None

    async def _first_of(self, future: "asyncio.Future[Any]", seconds: float | None) -> None:
        """Wait for *future*, for a pause to begin, or for so many seconds."""
        self._wake = asyncio.get_running_loop().create_future()
        if self._paused:
            self._wake.set_result(None)
        await any_of(self._clock, (future, self._wake), seconds)
        self._wake = None

    def _result(self, outcome: Outcome) -> Any:
        if outcome.status is GoalStatus.SUCCEEDED:
            return outcome.result
        if outcome.status is GoalStatus.CANCELED:
            text = outcome.text or f"the goal of {self._client.name} was cancelled by somebody else"
            raise GoalFailed(text, "canceled")
        explain = self._options.aborted
        code, *more = (error_code(outcome.result),) if explain is None else explain(outcome.result)
        text = outcome.text or error_text(outcome.result)
        told = f": {text}" if text else ""
        number = f" with code {code}" if code else ""
        raise GoalFailed(
            f"action {self._client.name} was aborted{number}{told}", "aborted", code, text, *more
        )


def error_code(result: Any) -> int:
    """The number by which a result says what went wrong; 0 without one."""
    for path in CODES:
        value: Any = result
        for name in path.split("."):
            value = getattr(value, name, None)
        if isinstance(value, int) and not isinstance(value, bool):
            return value
    return 0


def error_text(result: Any) -> str:
    """The words by which a result says what went wrong; empty without any."""
    for name in TEXTS:
        value = getattr(result, name, "")
        if isinstance(value, str) and value:
            return value
    return ""


def missing_number(fields: object, path: str = "") -> str | None:
    """Path of the first field of a goal or request that is NaN; None when there is none."""
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
    """Wait until one of *futures* is done, at most *seconds* of the clock; None waits for ever."""
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
    """Give up what is still waited for; what was raised meanwhile is nobody's business."""
    if future.done():
        if not future.cancelled():
            future.exception()
    else:
        future.cancel()


def _figure(seconds: float) -> float | int:
    """Seconds as programs write them: 5 and not 5.0."""
    return int(seconds) if seconds == int(seconds) else seconds
