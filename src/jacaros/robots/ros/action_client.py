"""Action clients independent of the middleware: active goals, their waiting callers, and servers that disappear.

`ActionClient` is complete; a backend provides a `GoalWire` that sends, and passes on what it receives.
Everything here happens on the loop.
"""

import asyncio
import hashlib
import secrets
from collections.abc import Callable, Coroutine, Iterable
from contextlib import suppress
from typing import Any, Literal, Protocol, TypeVar

from jacaros.robots.ros.action import SERVER_LOST_AFTER, GoalOutcome
from jacaros.robots.ros.errors import (
    CallFailed,
    CallTimedOut,
    GoalRejected,
    ServerLost,
    ServerUnavailable,
    ServiceError,
)
from jacaros.robots.ros.message import Schema
from jacaros.robots.ros.names import goal_type
from jacaros.robots.ros.waiting import RETRY, Deadline, WaitLog, settle, within
from jacaros.runtime.clock import Clock, Timer

T = TypeVar("T")

ENDING = 5.0
"""Seconds that a server has to end a goal after a request to cancel."""


class GoalWire(Protocol):
    """The part of an action client that depends on the middleware.

    No method waits. Answers are passed to the `ActionClient`: `accepted` or `rejected` for each goal sent, then
    `feedback` and `ended`; `cancel_answered` for each `cancel_goal`; `server_present` whenever that changes.
    """

    @property
    def offered(self) -> bool:
        """Whether a server offers the action, as far as is known."""

    def new_id(self) -> str:
        """Return the id of a new goal."""

    def send_goal(self, goal_id: str, goal: Any) -> None:
        """Send a goal message.

        Raises:
            CallFailed: the server cannot accept it; the text says why.
        """

    def cancel_goal(self, goal_id: str) -> None:
        """Ask the server to cancel a goal, whether accepted or not."""

    def adopt_goal(self, goal_id: str) -> None:
        """Follow an accepted goal of an earlier run of this node as if it had been sent here."""

    def forget_goal(self, goal_id: str) -> None:
        """Stop reporting a goal: it has ended for this client."""

    def close(self) -> None:
        """Leave; messages sent just before must still reach the server."""


class GoalHandle:
    """A goal that its server has accepted, seen by the client.

    Attributes:
        goal_id: id of the goal in the graph.
    """

    def __init__(
        self, sender: "ActionClient", goal_id: str, on_feedback: Callable[[Any], None] | None
    ) -> None:
        self.goal_id = goal_id
        self.on_feedback = on_feedback
        self.acceptance: asyncio.Future[None] = asyncio.get_running_loop().create_future()
        self.accepted = False
        self.abandoned = False
        self.end: GoalOutcome | ServiceError | None = None
        self.leaves_by: float | None = None
        """Time of `Clock.elapsed` until which a goal that is being cancelled delays newer goals."""
        self._sender = sender
        self._waiting: list[asyncio.Future[None]] = []
        self._asking: list[asyncio.Future[bool]] = []
        self._followers: list[asyncio.Future[None]] = []

    async def outcome(self, timeout: float | None = None) -> GoalOutcome:
        """Wait for the goal to end; any number of callers may wait, also after the end.

        Raises:
            CallTimedOut: the goal is still active after *timeout* seconds of the clock; it is not cancelled.
            ServerLost: the server disappeared, so the outcome will never be known (`SERVER_LOST_AFTER`).
        """
        if self.end is None:
            try:
                await self._wait(self._waiting, timeout)
            except TimeoutError:
                raise CallTimedOut(
                    f"goal {self.goal_id} of action {self._sender.name} is still active after {timeout:g} s"
                ) from None
        return self._ended()

    async def cancel(self, timeout: float | None = None) -> bool:
        """Ask the server to cancel the goal. Return True if it agreed, False if it refused or the goal had ended.

        The goal has ended only when `outcome` returns.

        Raises:
            CallTimedOut: the server did not answer in time.
            ServerLost: the server disappeared.
        """
        if self.end is not None:
            self._ended()
            return False
        try:
            return await self._wait(self._asking, timeout, lambda: self._sender.ask_to_cancel(self))
        except TimeoutError:
            raise CallTimedOut(
                f"the server of action {self._sender.name} did not answer within {timeout:g} s "
                f"whether it cancels goal {self.goal_id}"
            ) from None

    def abandon(self) -> None:
        """Cancel the goal and return immediately.

        Its client owns the goal until it has ended, and logs a warning if that takes more than 5 s.
        """
        self._sender.abandon(self)

    async def gone(self) -> bool:
        """Wait until a goal that is being cancelled has ended or continues. Return False if that takes too long."""
        if self.leaves_by is None:
            return True
        left = self.leaves_by - self._sender.clock.elapsed
        try:
            await self._wait(self._followers, left)
        except TimeoutError:
            return False
        return True

    async def _wait(
        self,
        waiters: list[asyncio.Future[T]],
        timeout: float | None,
        ask: Callable[[], None] = lambda: None,
    ) -> T:
        """Wait with the other *waiters* for the event that settles them; call *ask* to bring it about."""
        waiter: asyncio.Future[T] = asyncio.get_running_loop().create_future()
        waiters.append(waiter)
        try:
            ask()
            return await within(self._sender.clock, waiter, timeout)
        finally:
            waiters.remove(waiter)

    def _ended(self) -> GoalOutcome:
        """Return the outcome, or raise why it will never be known."""
        if isinstance(self.end, GoalOutcome):
            return self.end
        assert self.end is not None
        raise self.end.with_traceback(None)

    def cancel_answered(self, agreed: bool) -> None:
        """Note whether the server has agreed to cancel."""
        for answer in self._asking:
            settle(answer, agreed, None)

    def no_longer_leaves(self) -> None:
        """Let newer goals continue: the goal has ended, or its server does not cancel it."""
        self.leaves_by = None
        for follower in self._followers:
            settle(follower, None, None)

    def finish(self, end: GoalOutcome | ServiceError) -> None:
        """Note the goal's outcome and settle everything that waits for it."""
        if self.end is not None:
            return
        self.end = end
        self._sender.has_left(self)
        problem = None if isinstance(end, GoalOutcome) else end
        settle(self.acceptance, None, problem)
        for waiter in self._waiting:
            settle(waiter, None, problem)
        for answer in self._asking:
            # The server's answer was lost or overtaken; the outcome implies it.
            settle(answer, isinstance(end, GoalOutcome) and end.status == "canceled", problem)


OrphanPolicy = Literal["cancel", "keep"]
"""What to do with orphans: cancel them, or leave them."""


class Orphans:
    """Goals of earlier runs of one node, whose process was killed: their action servers still pursue them.

    Goal ids identify their owner: they begin with the name of the node (ROS 1) or with a hash of it (ROS 2), followed
    by the run. So goals of other nodes are never taken for orphans.

    Args:
        node_name: absolute name of the node.
        policy: what to do with them.
        log: called with a warning.
    """

    def __init__(self, node_name: str, policy: OrphanPolicy, log: Callable[[str], None]) -> None:
        self._policy: OrphanPolicy = policy
        self._log = log
        run = secrets.token_hex(4)
        self._families = (f"{node_name}-", hashlib.sha256(node_name.encode()).hexdigest()[:12])
        self._named, self._hashed = (f"{family}{run}" for family in self._families)
        self._known: set[str] = set()

    def named_id(self, number: int, now: float) -> str:
        """Return an id in actionlib's form: node (and run), number, time."""
        return f"{self._named}-{number}-{now:.9f}"

    def hashed_id(self) -> str:
        """Return an id of 16 bytes, as 32 hexadecimal digits."""
        return self._hashed + secrets.token_hex(6)

    def newly_found(self, goal_id: str) -> bool:
        """Return whether an active goal is an orphan that has not been seen before."""
        if (
            not goal_id.startswith(self._families)
            or goal_id.startswith((self._named, self._hashed))
            or goal_id in self._known
        ):
            return False
        self._known.add(goal_id)
        return True

    def may_cancel(self, action: str) -> bool:
        """Return whether to cancel an orphan of *action*, and log it."""
        cancels = self._policy == "cancel"
        consequence = "cancelling it" if cancels else "the robot may be moving"
        self._log(
            f"warning: action {action} is still executing a goal of an earlier run of this node; {consequence}"
        )
        return cancels


LeavingGoals = dict[str, dict[GoalHandle, None]]
"""Goals of one node that are being cancelled, by action."""


class ActionClient:
    """Sends goals to an action server, whatever the middleware.

    Args:
        clock: measures the time-outs.
        log: called with one line about waiting, or about a failed callback.
        factory: makes the goal messages.
        name: absolute name of the action.
        type_name: action type in full form.
        leaving: by action, the goals of all clients of the node that are being cancelled; None: of this client only.
        orphans: decides about goals of earlier runs; None: they are left alone.
    """

    wire: GoalWire
    """Set by the creator, before the first goal."""

    def __init__(
        self,
        clock: Clock,
        log: Callable[[str], None],
        factory: Schema,
        name: str,
        type_name: str,
        leaving: LeavingGoals | None = None,
        orphans: Orphans | None = None,
    ) -> None:
        self.clock = clock
        self.name = name
        self.type_name = type_name
        self._log = log
        self._factory = factory
        self._goal_type = goal_type(type_name)
        self._goals: dict[str, GoalHandle] = {}
        self._leaving: LeavingGoals = {} if leaving is None else leaving
        self._orphans = orphans
        self._heard_of_goals = False
        self._abandoning: set[asyncio.Task[None]] = set()
        self._arrivals: list[asyncio.Future[None]] = []
        self._losing: Timer | None = None
        self._waiting = WaitLog(clock, log, f"action {name} ({type_name})")
        self._closed = False

    @property
    def closed(self) -> bool:
        """Whether it was closed, or its process has ended."""
        return self._closed

    @property
    def ready(self) -> bool:
        """Whether a server offers the action, as far as is known."""
        return not self._closed and self.wire.offered

    @property
    def busy(self) -> bool:
        """Whether a goal is active or a caller waits for the server; a wire that polls does so while this is True."""
        return bool(self._goals or self._arrivals)

    def wants(self, goal_id: str) -> bool:
        """Whether a caller still waits for a goal; an abandoned goal must not be sent again."""
        pending = self._goals.get(goal_id)
        return pending is not None and not pending.abandoned

    def goal(self, **fields: Any) -> Any:
        """Make a goal message; see `Backend.message`."""
        return self._factory.make(self._goal_type, fields)

    async def send(
        self, goal: Any = None, on_feedback: Callable[[Any], None] | None = None, timeout: float | None = None
    ) -> GoalHandle:
        """Send a goal and wait until the server has accepted it.

        Goals of this node that are being cancelled come first: the goal is sent when they have ended, at most 5 s
        after each request. That time does not count towards *timeout*.

        Args:
            goal: a goal message, a mapping of its fields, or None for the defaults.
            on_feedback: called on the loop with each feedback message of this goal, until its end.
            timeout: seconds to wait for the server and for its acceptance, in total; None: no limit.

        Raises:
            MessageMismatch: the goal does not match the type definition.
            GoalRejected: the server rejected it.
            ServerUnavailable: no server offered the action in time.
            CallTimedOut: the server neither accepted nor rejected the goal in time; if it accepts later, the goal is
                cancelled.

        Cancelling this coroutine cancels the goal if the server accepts it.
        """
        message = self._factory.checked(self._goal_type, goal)
        deadline = Deadline(self.clock, timeout)
        while True:
            await self._server(deadline)
            deadline.postpone(await self._predecessors())
            try:
                return await self._attempt(message, on_feedback, deadline)
            except ServerUnavailable:  # it was seen, but has gone, or has not been discovered everywhere
                if deadline.comes_within(RETRY):
                    raise self._nobody(deadline) from None
            await self.clock.sleep(RETRY)

    def close(self) -> None:
        """Close the client: its goals are cancelled if the server can be reached, and waiting callers fail."""
        if self._closed:
            return
        self._closed = True
        for goal_id in list(self._goals):
            # Even if the server seems to be gone: it may only be silent, and the robot still moving.
            with suppress(ServiceError):  # no server can be reached
                self.wire.cancel_goal(goal_id)
        problem = CallFailed(f"the client of action {self.name} was closed")
        for goal_id in list(self._goals):
            self._finish(goal_id, problem)
        for arrival in list(self._arrivals):
            settle(arrival, None, problem)
        self.wire.close()

    def ask_to_cancel(self, pending: GoalHandle) -> None:
        """Send a request to cancel; the answer arrives with `cancel_answered`.

        Raises:
            ServiceError: the server cannot be reached.
        """
        self._leaves(pending)
        self.wire.cancel_goal(pending.goal_id)

    def abandon(self, pending: GoalHandle) -> None:
        """Cancel a goal that is no longer needed: now if it was accepted, else as soon as it is.

        It remains a goal of this client until it has ended: newer goals of the action wait for that.
        """
        if pending.end is not None:
            return
        pending.abandoned = True
        self._leaves(pending)
        if pending.accepted:
            with suppress(ServiceError):  # the server cannot be reached, so the goal will soon be lost
                self.wire.cancel_goal(pending.goal_id)
        self._keep(self._see_off(pending))

    def _keep(self, work: Coroutine[Any, Any, None]) -> None:
        task = asyncio.get_running_loop().create_task(work)
        self._abandoning.add(task)
        task.add_done_callback(self._abandoning.discard)

    def goals_under_way(self, goal_ids: Iterable[str]) -> None:
        """Look for orphans among the active goals of the server: only once, and only goals from before we joined."""
        if self._heard_of_goals or self._orphans is None or self._closed:
            return
        self._heard_of_goals = True
        for goal_id in goal_ids:
            found = goal_id not in self._goals and self._orphans.newly_found(goal_id)
            if found and self._orphans.may_cancel(self.name):
                pending = self._goals[goal_id] = GoalHandle(self, goal_id, None)
                pending.accepted = True
                self.wire.adopt_goal(goal_id)
                self.abandon(pending)

    def has_left(self, pending: GoalHandle) -> None:
        """Let newer goals continue: a goal has ended, or its server refuses to cancel it."""
        self._leaving.get(self.name, {}).pop(pending, None)
        pending.no_longer_leaves()

    # Events from the wire:

    def accepted(self, goal_id: str) -> None:
        """Note that the server has accepted a goal."""
        self._sign()
        pending = self._goals.get(goal_id)
        if pending is None or pending.accepted:
            return
        pending.accepted = True
        if pending.abandoned:
            self.wire.cancel_goal(goal_id)
        else:
            settle(pending.acceptance, None, None)

    def rejected(self, goal_id: str, text: str = "") -> None:
        """Note that the server has rejected a goal."""
        self._sign()
        because = f": {text}" if text else ""
        self._finish(goal_id, GoalRejected(f"the server of action {self.name} rejected the goal{because}"))

    def feedback(self, goal_id: str, message: Any) -> None:
        """Pass on feedback of a goal."""
        self._sign()
        pending = self._goals.get(goal_id)
        if pending is None or pending.abandoned or pending.on_feedback is None:
            return
        try:
            pending.on_feedback(message)
        except Exception as problem:  # one failing callback must not block the events of other goals
            self._log(
                f"the feedback callback of action {self.name} failed: {type(problem).__name__}: {problem}"
            )

    def ended(self, goal_id: str, outcome: GoalOutcome) -> None:
        """Note the outcome of a goal."""
        self._sign()
        self._finish(goal_id, outcome)

    def cancel_answered(self, goal_id: str, agreed: bool) -> None:
        """Pass on the answer to a request to cancel."""
        self._sign()
        pending = self._goals.get(goal_id)
        if pending is not None:
            if not agreed:
                self.has_left(pending)
            pending.cancel_answered(agreed)

    def fail(self, goal_id: str, problem: ServiceError) -> None:
        """End a goal whose outcome can no longer arrive, because the connection to the server broke."""
        self._finish(goal_id, problem)

    def server_present(self, present: bool, same: bool = True) -> None:
        """Note that a server has come or gone.

        Args:
            present: whether there is a server now.
            same: the present server may know the goals; False: it is another one, which does not.
        """
        if present:
            if not same:
                self._lose("was replaced by another")
            self._sign()
            for arrival in list(self._arrivals):
                settle(arrival, None, None)
        elif self._losing is None and self._goals:
            self._losing = self._expect_loss()

    # Internal:

    async def _attempt(
        self, message: Any, on_feedback: Callable[[Any], None] | None, deadline: Deadline
    ) -> GoalHandle:
        """Send a goal once; raise `ServerUnavailable` if there turns out to be no server."""
        self._require_open()  # it may have been closed while another goal ended
        pending = GoalHandle(self, self.wire.new_id(), on_feedback)
        self._goals[pending.goal_id] = pending
        try:
            self.wire.send_goal(pending.goal_id, message)
            await within(self.clock, pending.acceptance, deadline.left)
        except TimeoutError:
            self.abandon(pending)
            raise CallTimedOut(
                f"the server of action {self.name} neither accepted nor rejected the goal within "
                f"{deadline.timeout:g} s"
            ) from None
        except asyncio.CancelledError:
            self.abandon(pending)
            raise
        except ServiceError:
            self._forget(pending.goal_id)
            raise
        return pending

    def _require_open(self) -> None:
        if self._closed:
            raise CallFailed(f"the client of action {self.name} was closed")

    def _nobody(self, deadline: Deadline) -> ServerUnavailable:
        return ServerUnavailable(f"no server offered {self._waiting.what} within {deadline.timeout:g} s")

    async def _server(self, deadline: Deadline) -> None:
        """Wait for the server."""
        self._require_open()
        if self.wire.offered:
            self._waiting.found()
            return
        with self._waiting.during():
            while not self.wire.offered:
                arrival: asyncio.Future[None] = asyncio.get_running_loop().create_future()
                self._arrivals.append(arrival)
                try:
                    await within(self.clock, arrival, deadline.left)
                except TimeoutError:
                    raise self._nobody(deadline) from None
                finally:
                    self._arrivals.remove(arrival)

    def _leaves(self, pending: GoalHandle) -> None:
        if pending.end is None and pending.leaves_by is None:
            pending.leaves_by = self.clock.elapsed + ENDING
            self._leaving.setdefault(self.name, {})[pending] = None

    async def _predecessors(self) -> float:
        """Wait until cancelled goals of the action have ended, each at most `ENDING` seconds; return the seconds
        waited.

        A server that accepts a newer goal before it handles the request may end the older one in any way, and one
        that runs a single goal rejects the newer one.
        """
        began = self.clock.elapsed
        for pending in list(self._leaving.get(self.name, ())):
            if not await pending.gone():
                self.has_left(pending)
                self._log(
                    f"warning: action {self.name}: a cancelled goal has not ended within {ENDING:g} s; "
                    "sending the next goal anyway"
                )
        return self.clock.elapsed - began

    async def _see_off(self, pending: GoalHandle) -> None:
        try:
            await pending.outcome(ENDING)
        except CallTimedOut:
            if pending.accepted:
                self._log(
                    f"warning: action {self.name}: an abandoned goal has not ended {ENDING:g} s after it was cancelled; "
                    "the robot may still be moving"
                )
        except ServiceError:
            pass  # lost with its server, rejected, or its client was closed: no caller is waiting

    def _finish(self, goal_id: str, end: GoalOutcome | ServiceError) -> None:
        pending = self._goals.get(goal_id)
        if pending is not None:
            self._forget(goal_id)
            pending.finish(end)

    def _forget(self, goal_id: str) -> None:
        if self._goals.pop(goal_id, None) is not None:
            self.wire.forget_goal(goal_id)
        if not self._goals:
            self._sign()

    def _sign(self) -> None:
        """Note a sign of life. If the server was already seen to go, the message may be older, and the time-out
        starts again."""
        if self._losing is not None:
            self._losing.cancel()
            self._losing = self._expect_loss() if self._goals and not self.wire.offered else None

    def _expect_loss(self) -> Timer:
        return self.clock.call_later(SERVER_LOST_AFTER, lambda: self._lose("went away"))

    def _lose(self, how: str) -> None:
        if self._losing is not None:
            self._losing.cancel()
            self._losing = None
        for goal_id in list(self._goals):
            text = f"the server of action {self.name} {how} during goal {goal_id}; it is unknown whether the goal continues"
            self._finish(goal_id, ServerLost(text))
