"""Call the linked operations behind an out port, and wait for all of them."""

import asyncio
from collections.abc import Callable, Iterable
from functools import partial

from jacaros.env.execution import OperationExecution
from jacaros.env.ids import ArtifactId
from jacaros.env.operation import OperationOutcome, OperationRequest
from jacaros.env.ports import UnderWay

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
