"""Whatever comes in whatever order, every goal has one end and every caller gets it.

Two state machines: one drives a server's goals, one a client's; what the other side would do is drawn at random.
"""

import asyncio
from typing import Any

import hypothesis.strategies as st
import pytest
from hypothesis import settings
from hypothesis.stateful import Bundle, RuleBasedStateMachine, consumes, invariant, rule

from jacaros.robots.ros.action import (
    CLOSED,
    PREEMPTED,
    SERVER_LOST_AFTER,
    Abort,
    ActionPolicy,
    GoalOutcome,
    GoalStatus,
    ServedGoals,
)
from jacaros.robots.ros.action_client import ENDING, ActionClient, GoalHandle
from jacaros.robots.ros.errors import CallTimedOut, ServerUnavailable, ServiceError
from jacaros.robots.ros.typestore import DefinitionSchema
from jacaros.runtime.clock import VirtualClock, new_event_loop

COUNT = "jacaros_interfaces/action/Count"
FACTORY = DefinitionSchema()


class Loop:
    """A loop on a virtual clock that is turned by hand."""

    def __init__(self) -> None:
        self.clock = VirtualClock()
        self.loop = new_event_loop(self.clock)

    def turn(self, seconds: float = 0.0) -> None:
        self.loop.run_until_complete(self.clock.sleep(seconds))

    def do(self, work: Any, *arguments: Any) -> Any:
        """Call *work* on the loop."""

        async def call() -> Any:
            return work(*arguments)

        return self.loop.run_until_complete(call())

    def close(self) -> None:
        for task in asyncio.all_tasks(self.loop):
            task.cancel()
        self.turn()
        self.loop.close()


class _Listener:
    """Takes the news of one goal of the server."""

    def __init__(self) -> None:
        self.ends: list[GoalOutcome] = []
        self.feedback_after_end = False
        self.ended = self.ends.append

    def feedback(self, message: Any) -> None:
        self.feedback_after_end |= bool(self.ends)


class Life(RuleBasedStateMachine):
    """A loop that is closed when all goals have ended."""

    def __init__(self) -> None:
        super().__init__()
        self.run = Loop()

    def teardown(self) -> None:
        try:
            self._end()
        finally:
            self.run.close()

    def _end(self) -> None:
        raise NotImplementedError


class ServerLife(Life):
    """A server's goals; a future controls the code of each."""

    goals = Bundle("goals")

    def __init__(self) -> None:
        super().__init__()
        self.preempting = False
        self.closed = False
        self.agree = True
        self.orders: dict[str, asyncio.Future[str]] = {}
        self.listeners: dict[str, _Listener] = {}
        self.running: set[str] = set()
        self.cancelled: set[str] = set()
        self.served = self._made(preempt=False)

    def _made(self, preempt: bool) -> ServedGoals:
        policy = ActionPolicy(None, lambda goal: self.agree, preempt)
        return ServedGoals(
            self.run.clock, FACTORY, "/count", COUNT, self._carry_out, policy, lambda text: None
        )

    async def _carry_out(self, goal: Any) -> Any:
        name = goal.goal_id
        if self.preempting:
            assert not self.running, "two goals drive at the same time"
        self.running.add(name)
        try:
            goal.feedback(current=1)
            try:
                order = await self.orders[name]
            except asyncio.CancelledError:
                if goal.request.target == 1:  # takes a moment to stop, and has something to say
                    await self.run.clock.sleep(0.5)
                    goal.feedback(current=2)
                    return {"last": 7}
                raise
            if order == "abort":
                raise Abort("enough")
            if order == "fail":
                raise ValueError("broken")
            return {"last": 3} if order == "finish" else {"nonsense": 1}
        finally:
            self.running.discard(name)

    @rule(preempting=st.booleans())
    def choose(self, preempting: bool) -> None:
        if not self.listeners:
            self.preempting, self.closed = preempting, False
            self.served = self._made(preempting)

    @rule(target=goals, slow=st.booleans())
    def begin(self, slow: bool) -> str:
        name = f"goal{len(self.listeners)}"
        listener = self.listeners[name] = _Listener()
        self.orders[name] = self.run.loop.create_future()
        request = FACTORY.make(f"{COUNT}_Goal", {"target": int(slow)})
        refusal = self.run.do(self.served.judge, request)
        assert refusal == (CLOSED if self.closed else None)
        if refusal is None:
            self.run.do(self.served.begin, name, request, listener.feedback, listener.ended)
        else:
            listener.ends.append(GoalOutcome(GoalStatus.ABORTED, None))
        return name

    @rule(agree=st.booleans())
    def judge_cancellations(self, agree: bool) -> None:
        self.agree = agree

    @rule(name=goals)
    def cancel(self, name: str) -> None:
        over = bool(self.listeners[name].ends)
        agreed = self.run.do(self.served.cancel, name)
        assert not (agreed and over)
        if agreed:
            self.cancelled.add(name)

    @rule(name=goals, order=st.sampled_from(["finish", "abort", "fail", "answer nonsense"]))
    def order(self, name: str, order: str) -> None:
        if not self.orders[name].done():
            self.run.do(self.orders[name].set_result, order)

    @rule()
    def close(self) -> None:
        self.closed = True
        self.run.do(self.served.close)

    @rule(seconds=st.sampled_from([0.0, 0.1, 1.0]))
    def turn(self, seconds: float) -> None:
        self.run.turn(seconds)

    @invariant()
    def one_end_at_most(self) -> None:
        for name, listener in self.listeners.items():
            assert len(listener.ends) <= 1, name
            assert not listener.feedback_after_end, name
            if listener.ends and name in self.cancelled and not self.preempting:
                assert listener.ends[0].status is not GoalStatus.SUCCEEDED, name
                assert listener.ends[0].text != PREEMPTED, name
        if self.preempting:
            assert len(self.running) <= 1

    def _end(self) -> None:
        for order in self.orders.values():
            if not order.done():
                self.run.do(order.set_result, "finish")
        self.run.turn(60.0)
        for name, listener in self.listeners.items():
            assert len(listener.ends) == 1, f"{name} has no end"
        assert not self.running


class _Wire:
    """A server that answers when and how a test wants."""

    def __init__(self) -> None:
        self.offered = True
        self.sent: list[str] = []
        self.cancels: list[str] = []

    def new_id(self) -> str:
        return f"goal{len(self.sent)}"

    def send_goal(self, goal_id: str, goal: Any) -> None:
        self.sent.append(goal_id)

    def cancel_goal(self, goal_id: str) -> None:
        self.cancels.append(goal_id)

    def forget_goal(self, goal_id: str) -> None: ...

    def close(self) -> None: ...


class ClientLife(Life):
    """A client's goals against a server that is allowed to say anything at any time, and twice."""

    sends = Bundle("sends")

    def __init__(self) -> None:
        super().__init__()
        self.wire = _Wire()
        self.sender = ActionClient(self.run.clock, lambda text: None, FACTORY, "/count", COUNT)
        self.sender.wire = self.wire
        self.tasks: list[asyncio.Task[GoalHandle]] = []
        self.waits: list[tuple[GoalHandle, asyncio.Task[Any]]] = []
        self.asks: list[asyncio.Task[bool]] = []
        self.given_up: set[int] = set()
        self.closed = False

    @rule(target=sends, timeout=st.sampled_from([None, 0.5]))
    def send(self, timeout: float | None) -> int:
        self.tasks.append(self.run.loop.create_task(self.sender.send({"target": 1}, timeout=timeout)))
        self.run.turn()
        return len(self.tasks) - 1

    @rule(number=consumes(sends))
    def give_up(self, number: int) -> None:
        if not self.tasks[number].done():
            self.given_up.add(number)
            self.tasks[number].cancel()

    @rule(number=sends, timeout=st.sampled_from([None, 0.5]))
    def wait(self, number: int, timeout: float | None) -> None:
        pending = self._accepted(number)
        if pending is not None:
            self.waits.append((pending, self.run.loop.create_task(pending.outcome(timeout))))

    @rule(number=sends, timeout=st.sampled_from([None, 0.5]))
    def ask(self, number: int, timeout: float | None) -> None:
        pending = self._accepted(number)
        if pending is not None:
            self.asks.append(self.run.loop.create_task(pending.cancel(timeout)))

    @rule(
        number=st.integers(0, 3),
        news=st.sampled_from(["accepted", "rejected", "feedback", "ended", "agreed", "refused"]),
    )
    def tell(self, number: int, news: str) -> None:
        name = f"goal{number}"
        if news in ("accepted", "rejected"):
            self.run.do(getattr(self.sender, news), name)
        elif news == "feedback":
            self.run.do(self.sender.feedback, name, FACTORY.make(f"{COUNT}_Feedback"))
        elif news == "ended":
            self.run.do(self.sender.ended, name, GoalOutcome(GoalStatus.SUCCEEDED, None, str(number)))
        else:
            self.run.do(self.sender.cancel_answered, name, news == "agreed")

    @rule(present=st.booleans(), same=st.booleans())
    def server(self, present: bool, same: bool) -> None:
        self.wire.offered = present
        self.run.do(self.sender.server_present, present, same)

    @rule()
    def close(self) -> None:
        self.closed = True
        self.run.do(self.sender.close)

    @rule(seconds=st.sampled_from([0.0, 0.3, 1.0, SERVER_LOST_AFTER + 0.1]))
    def turn(self, seconds: float) -> None:
        self.run.turn(seconds)

    @invariant()
    def all_who_wait_for_a_goal_get_the_same(self) -> None:
        for pending, task in self.waits:
            if task.done() and not task.cancelled() and not isinstance(task.exception(), CallTimedOut):
                assert pending.end is not None
                assert (task.exception() or task.result()) is pending.end

    @invariant()
    def a_closed_client_is_not_busy(self) -> None:
        assert not (self.closed and self.sender.busy)

    def _end(self) -> None:
        self.wire.offered = True
        self.run.do(self.sender.server_present, True)  # callers that wait for it continue
        self.run.turn(ENDING + 1.0)  # and callers that wait for the end of a cancelled goal
        self.wire.offered = False
        self.run.do(self.sender.server_present, False)
        self.run.turn(SERVER_LOST_AFTER + 1.0)
        given_up = [self.tasks[number] for number in self.given_up]
        for task in [*self.tasks, *self.asks, *[task for _, task in self.waits]]:
            assert task.done(), "a caller waits for ever"
            if task.cancelled():
                assert task in given_up
            else:
                problem = task.exception()
                assert problem is None or isinstance(problem, ServiceError), problem
        assert not self.sender.busy

    def _accepted(self, number: int) -> GoalHandle | None:
        task = self.tasks[number]
        ok = task.done() and not task.cancelled() and task.exception() is None
        return task.result() if ok else None


def test_a_closed_client_does_not_send_a_goal_that_waited_for_another_to_end() -> None:
    life = ClientLife()
    life.give_up(life.send(None))
    life.send(None)
    life.close()
    life.turn(0.0)
    assert life.wire.sent == ["goal0"]
    life.a_closed_client_is_not_busy()
    life.teardown()


def lose_goals(life: ClientLife, count: int) -> None:
    """Let goals find no server as long as the client sends any, at most so many."""
    for number in range(count):
        if number < len(life.wire.sent):
            life.run.do(life.sender.fail, f"goal{number}", ServerUnavailable("no server"))
            life.turn(0.1)


def test_a_goal_without_a_server_is_sent_again_as_long_as_there_is_time() -> None:
    life = ClientLife()
    life.send(2.0)
    lose_goals(life, 3)
    life.tell(3, "accepted")
    life.turn(0.0)
    assert life.tasks[0].result().goal_id == "goal3"
    assert life.run.clock.elapsed < 1.0
    life.teardown()


def test_the_timeout_of_a_goal_reports_that_no_server_offers_the_action() -> None:
    life = ClientLife()
    life.send(2.0)
    lose_goals(life, 30)
    assert 1.8 <= life.run.clock.elapsed <= 2.1
    assert not life.sender.busy
    with pytest.raises(ServerUnavailable, match=r"no server offered action /count \(.*Count\) within 2 s"):
        life.tasks[0].result()
    life.teardown()


TestServerLife = ServerLife.TestCase
TestServerLife.settings = settings(max_examples=40, stateful_step_count=20)
TestClientLife = ClientLife.TestCase
TestClientLife.settings = settings(max_examples=40, stateful_step_count=25)
