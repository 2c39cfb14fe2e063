"""External sessions: exclusive access to an artifact for threads and tasks outside of its operations."""

import asyncio
import threading
from collections.abc import Callable, Iterable
from dataclasses import replace
from functools import partial
from types import TracebackType
from typing import Any

from jacaros.artifacts.env.errors import ArtifactId, InvalidArtifact
from jacaros.artifacts.env.execution import OperationExecution
from jacaros.artifacts.env.operation import EXTERNAL, OperationOutcome, OperationRequest
from jacaros.artifacts.env.ports import UnderWay
from jacaros.artifacts.kernel import faults
from jacaros.artifacts.kernel.declaration import NOTHING
from jacaros.artifacts.kernel.steps import Steps
from jacaros.runtime.clock import standing_still
from jacaros.runtime.trace import Cause

# Call the linked operations behind an out port, and wait for all of them.


Execute = Callable[[OperationRequest], UnderWay]


async def call_all(
    execute: Execute,
    targets: Iterable[ArtifactId],
    operation: str,
    arguments: tuple[object, ...],
    execution: OperationExecution,
) -> None:
    """Call *operation* of all *targets* on behalf of *execution*, and wait for all of them.

    Cancelling or pausing *execution* meanwhile cancels or pauses them.

    Raises:
        OperationFailed: one of them failed, with the message and reason of the first one in the given order.
    """
    listed = tuple(targets)
    outcomes: list[OperationOutcome | None] = [None] * len(listed)
    all_done: asyncio.Future[None] = asyncio.get_running_loop().create_future()

    def done(index: int, outcome: OperationOutcome) -> None:
        outcomes[index] = outcome
        if None not in outcomes and not all_done.done():
            all_done.set_result(None)

    agent, cause = execution.request.agent, execution.cause
    calls: list[UnderWay] = []
    for index, target in enumerate(listed):
        request = OperationRequest(target, operation, arguments, agent, cause, partial(done, index))
        request.urgency, request.on_preempted = execution.request.urgency, execution.request.on_preempted
        request.within, request.yields = execution.claims, execution.request.yields
        calls.append(execute(request))
        execution.linked = (*execution.linked, calls[-1])
        if execution.paused:
            calls[-1].pause()
    try:
        await all_done
    except asyncio.CancelledError:
        for call in calls:
            call.cancel()
        raise
    finally:
        execution.linked = tuple(each for each in execution.linked if each not in calls)
    for outcome in outcomes:
        if outcome is not None and not outcome.ok:
            raise outcome.failure


PATIENCE = 0.2
"""Seconds after which a waiting thread checks whether the event loop still exists."""


class ExternalSession:
    """A turn in an artifact for code outside of its operations. See `Artifact.external_session`."""

    def __init__(self, steps: Steps, cause: Cause | None) -> None:
        self._steps, self._cause = steps, cause
        self._execution: OperationExecution | None = None
        self._thread = 0
        self._entered, self._ended = threading.Event(), threading.Event()
        self._left: asyncio.Future[BaseException | None] | None = None
        self._refusal: OperationOutcome | None = None

    def _new_execution(self, function: Callable[..., Any], threaded: bool) -> OperationExecution:
        steps = self._steps
        request = OperationRequest(steps.id, EXTERNAL, (), None, self._cause, self._told)
        declared = replace(NOTHING, kind=EXTERNAL, function=function, threaded=threaded, coroutine=True)
        return OperationExecution(steps, request, declared, (), self._cause)

    # ---- a task of the loop

    async def __aenter__(self) -> None:
        if self._steps.inside():
            raise InvalidArtifact(f"artifact {self._steps.id.name}: this is within an operation already")
        if self._steps.disposed:
            raise faults.not_available(self._steps.id).failure
        self._execution = self._new_execution(self._hold, threaded=False)
        await self._steps.enter_task(self._execution)

    async def __aexit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        assert self._execution is not None
        self._steps.end(self._execution, error)

    # ---- another thread

    def __enter__(self) -> None:
        if not self._steps.setting.elsewhere():
            raise InvalidArtifact(
                f"artifact {self._steps.id.name}: `with` is for other threads; in a task, use `async with`; in a callback, "
                "use self.start(...)"
            )
        if self._steps.inside():
            raise InvalidArtifact(f"artifact {self._steps.id.name}: this is within an operation already")
        self._thread = threading.get_ident()
        self._wait(self._entered, self._steps.setting.call_on_loop(self._arrive))
        if self._refusal is not None:
            raise self._refusal.failure

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._wait(self._ended, self._steps.setting.call_on_loop(partial(self._leave, error)))

    def _wait(self, event: threading.Event, alive: bool) -> None:
        loop = self._steps.setting.loop
        while alive and not event.wait(PATIENCE):
            alive = loop is not None and not loop.is_closed()
        if not event.is_set():
            raise faults.not_available(self._steps.id).failure

    def _arrive(self) -> None:
        if self._steps.disposed:
            self._told(faults.not_available(self._steps.id))
        else:
            self._steps.turns.enter(self._new_execution(self._hold, threaded=True), None)

    async def _hold(self, execution: OperationExecution) -> BaseException | None:
        """Keep the turn until the thread leaves. Return the exception that ended it, or None."""
        loop = asyncio.get_running_loop()
        self._left = loop.create_future()
        execution.thread = self._thread
        try:
            with standing_still(loop):
                self._entered.set()
                return await self._left
        finally:
            execution.thread = None

    def _leave(self, error: BaseException | None) -> None:
        if self._left is not None and not self._left.done():
            self._left.set_result(error)

    def _told(self, outcome: OperationOutcome) -> None:
        """Handle the outcome: a refusal, if it had not begun."""
        if not self._entered.is_set():
            self._refusal = outcome
            self._entered.set()
        self._ended.set()
