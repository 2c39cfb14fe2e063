"""An action server that does what a test tells it, at the moment that the test says, behind the port of action clients."""

import asyncio
from collections.abc import Awaitable, Callable, Coroutine
from contextlib import suppress
from types import SimpleNamespace
from typing import Any

from robot_lab import Lab

from jacaros.robots.ros.action import GoalOutcome, GoalStatus
from jacaros.robots.ros.errors import (
    CallTimedOut,
    GoalRejected,
    MessageMismatch,
    ServerLost,
    ServerUnavailable,
)
from jacaros.robots.ros.waiting import within


class FakeServer:
    """Stands behind all action clients of a laboratory's backend.

    Attributes:
        offered: whether clients find it.
        accepting: seconds that it takes to accept a goal.
        refusal: text with which it refuses goals; None: it accepts them.
        agrees: whether it agrees to cancel.
        ending: seconds from agreeing to the end of the goal; None: it never ends.
        cancelled_as: how a goal ends that it agreed to cancel.
        goals: the goals that it accepted, in their order.
        events: what happened: (seconds, text).
    """

    def __init__(self, lab: Lab) -> None:
        self.lab = lab
        self.offered = True
        self.accepting = 0.0
        self.refusal: str | None = None
        self.agrees = True
        self.ending: float | None = 0.1
        self.cancelled_as = GoalStatus.CANCELED
        self.goals: list[FakeGoal] = []
        self.events: list[tuple[float, str]] = []
        self.clients: list[FakeClient] = []
        self.tasks: list[asyncio.Future[None]] = []
        lab.backend.action_client = self._client  # type: ignore[method-assign]

    def _client(self, name: str, type_name: str) -> Any:
        self.clients.append(FakeClient(self, self.lab.backend.resolve(name)))
        return self.clients[-1]

    @property
    def told(self) -> list[str]:
        """What happened, without the times."""
        return [text for _, text in self.events]

    def note(self, text: str) -> None:
        self.events.append((round(self.lab.clock.elapsed, 3), text))

    def keep(self, work: Coroutine[Any, Any, None]) -> None:
        """Run *work* beside the test."""
        self.tasks.append(asyncio.ensure_future(work))

    def leave(self) -> None:
        """Go away in the middle of all goals."""
        self.offered = False
        for goal in self.goals:
            goal.lose()


class FakeGoal:
    """A goal, to both sides.

    Attributes:
        fields: what was sent.
        feedback: tells the client something.
    """

    def __init__(self, server: FakeServer, fields: Any, on_feedback: Callable[[Any], None] | None) -> None:
        self.server, self.fields, self._on_feedback = server, fields, on_feedback
        self.goal_id = str(len(server.goals))
        self._end: asyncio.Future[GoalOutcome] = asyncio.get_running_loop().create_future()

    @property
    def over(self) -> bool:
        return self._end.done()

    def feedback(self, **fields: Any) -> None:
        if self._on_feedback is not None and not self.over:
            self._on_feedback(SimpleNamespace(**fields))

    def end(self, status: GoalStatus = GoalStatus.SUCCEEDED, text: str = "", **result: Any) -> None:
        if not self.over:
            self.server.note(f"{status} {self.goal_id}")
            self._end.set_result(GoalOutcome(status, SimpleNamespace(**result), text))

    def lose(self) -> None:
        if not self.over:
            self._end.set_exception(ServerLost("the action server has gone"))
            self._end.exception()

    async def outcome(self, timeout: float | None = None) -> GoalOutcome:
        try:
            return await within(self.server.lab.clock, asyncio.shield(self._end), timeout)
        except TimeoutError:
            raise CallTimedOut("the goal is still under way") from None

    async def cancel(self, timeout: float | None = None) -> bool:
        self.server.note(f"cancel {self.goal_id}")
        await self.server.lab.sleep(0.01)
        if not self.server.agrees or self.over:
            return False
        if self.server.ending is not None:
            self.server.lab.clock.call_later(self.server.ending, lambda: self.end(self.server.cancelled_as))
        return True

    def abandon(self, afterwards: Callable[[], Awaitable[object]] | None = None) -> None:
        if not self.over:
            self.server.keep(self._see_off(afterwards))

    async def _see_off(self, afterwards: Callable[[], Awaitable[object]] | None) -> None:
        with suppress(CallTimedOut, ServerLost):
            await self.cancel()
            await self.outcome(5.0)
            if afterwards is not None:
                await afterwards()


class FakeClient:
    """The client's end of a `FakeServer`."""

    def __init__(self, server: FakeServer, name: str) -> None:
        self.server, self.name = server, name

    @property
    def ready(self) -> bool:
        return self.server.offered

    async def send(
        self, goal: Any = None, on_feedback: Callable[[Any], None] | None = None, timeout: float | None = None
    ) -> FakeGoal:
        if "typo" in goal:
            raise MessageMismatch("there is no field typo", "test/action/Goal", "typo")
        server, clock = self.server, self.server.lab.clock
        deadline = clock.now() + (timeout or 1e9)
        while not server.offered:
            await clock.sleep(0.1)
            if clock.now() >= deadline:
                raise ServerUnavailable(f"no server offered the action {self.name} within {timeout:g} s")
        accepting = asyncio.ensure_future(self._accepted(goal, on_feedback))
        try:
            await asyncio.wait(
                [accepting, asyncio.ensure_future(clock.sleep(deadline - clock.now()))],
                return_when=asyncio.FIRST_COMPLETED,
            )
        except asyncio.CancelledError:
            accepting.add_done_callback(self._cancel_late)
            raise
        if not accepting.done():
            accepting.add_done_callback(self._cancel_late)
            raise CallTimedOut(f"the action {self.name} did not accept within {timeout:g} s")
        return accepting.result()

    async def _accepted(self, goal: Any, on_feedback: Callable[[Any], None] | None) -> FakeGoal:
        server = self.server
        await server.lab.sleep(server.accepting)
        if server.refusal is not None:
            raise GoalRejected(server.refusal)
        made = FakeGoal(server, goal, on_feedback)
        server.goals.append(made)
        server.note(f"accepted {made.goal_id}")
        return made

    def _cancel_late(self, accepting: "asyncio.Future[FakeGoal]") -> None:
        if not accepting.cancelled() and accepting.exception() is None:
            asyncio.ensure_future(accepting.result().cancel())  # noqa: RUF006 - the loop of a test is short-lived

    def close(self) -> None:
        self.server.note("closed")
        for goal in self.server.goals:
            goal.end(GoalStatus.CANCELED)
