"""A goal that a caller outside has given to an agent."""

import asyncio
from collections.abc import Callable, Sequence
from typing import Any, Final

from jacaros.agents.language.offers import Offer
from jacaros.agents.mind.actions.offered import REFUSED
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import goals
from jacaros.agents.mind.rules.failure_reason import FailureReason
from jacaros.agents.mind.rules.goals import WatchedGoal
from jacaros.agents.mind.state.intention import Intention
from jacaros.agents.mind.state.pending import SUPERVISION, is_supervision
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Annotated, String, Term, atom, bare, structure
from jacaros.runtime.mas.agents.host import AgentHost
from jacaros.runtime.trace import Cause
from jacaros.serving.arguments import Data, literal_of, named, reasons_of
from jacaros.serving.callers import Caller

PENDING, WAITING, RUNNING, CANCELLING = "pending", "waiting", "running", "cancelling"
ACHIEVED, FAILED, REFUSED_STATE, CANCELLED = "achieved", "failed", "refused", "cancelled"
OVER: Final = frozenset({ACHIEVED, FAILED, REFUSED_STATE, CANCELLED})
"""Final states of a goal. It is ``pending`` until its plan first acts or waits, or executes ``.accept``, and ``running``
from then on. It is ``waiting`` for its turn while the agent pursues as many as it offers.
"""
BY_FAIL: Final = "fail"
"""Message of failures by the step ``.fail(R)``."""
CLEAN_UP = 5.0
"""Seconds that a cancelled goal waits for the clean-up of its operations."""


class RequestedGoal:
    """A goal that a caller has given.

    Args:
        id: its name for callers, hard to guess.
        host: the agent.
        offer: what the agent offers.
        arguments: its arguments; results are variables.
        caller: who has given it.
        changed: called with the goal whenever something about it has changed.

    Attributes:
        state: see `OVER`.
        progress: from 0 to 1 if the agent says so, otherwise None.
        note: what the agent says about its progress.
        message: why it was refused or has failed, in words.
        reasons: why, as terms.
        results: the results, by name; without those that the plan has left open.
        watcher: called after each change; for doors that need no data of it.
        began: when it was given, in seconds of the run's clock since the Unix epoch.
        ended: when it ended, or None.
    """

    def __init__(
        self,
        id: str,
        host: AgentHost,
        offer: Offer,
        arguments: Sequence[Term],
        caller: Caller,
        changed: "Callable[[RequestedGoal], None]",
    ) -> None:
        self.id, self.offer, self.caller = id, offer, caller
        self._host, self._changed = host, changed
        self._goal = literal_of(offer, arguments)
        self.written = text(self._goal)
        self.inputs = {name: value for name, value in named(offer, arguments).items() if value is not None}
        self.state = PENDING
        self.progress: float | None = None
        self.note, self.message = "", ""
        self.reasons: tuple[Term, ...] = ()
        self.results: dict[str, Data] = {}
        self.watcher: Callable[[], None] | None = None
        self.began = host.now()
        self.ended: float | None = None
        self._watched: WatchedGoal | None = None
        self._cleaning: asyncio.Task[None] | None = None
        loop = asyncio.get_running_loop()
        self._decision: asyncio.Future[None] = loop.create_future()
        self._end: asyncio.Future[None] = loop.create_future()

    # ---- what callers see

    @property
    def agent(self) -> str:
        """Name of the agent."""
        return self._host.name

    @property
    def over(self) -> bool:
        """Whether it has ended."""
        return self.state in OVER

    def doing(self) -> str:
        """Return the innermost goal that the agent pursues for it now, as text; empty if none."""
        for intention in self._some_intention():
            for literal in goals.goal_literals(intention):
                return text(resolve(bare(literal)))
        return ""

    def data(self) -> dict[str, Any]:
        """Return everything about it as JSON data."""
        return {
            "id": self.id,
            "agent": self.agent,
            "goal": self.offer.name,
            "arguments": self.inputs,
            "written": self.written,
            "caller": str(self.caller),
            "state": self.state,
            "progress": self.progress,
            "note": self.note,
            "doing": self.doing(),
            "results": self.results,
            "message": self.message,
            "reasons": reasons_of(self.reasons),
            "began": self.began,
            "ended": self.ended,
        }

    async def wait(self) -> None:
        """Wait for its end."""
        await asyncio.shield(self._end)

    async def decided(self) -> None:
        """Wait until it is no longer pending."""
        await asyncio.shield(self._decision)

    def then(self, call: Callable[[], object], over: bool) -> None:
        """Call a function when it has ended, or is no longer pending: cheaper than a task that waits."""
        (self._end if over else self._decision).add_done_callback(lambda _: call())

    # ---- its life

    def post(self, cause: Cause | None) -> None:
        """Give it to the agent.

        Args:
            cause: the request that led to it.
        """
        mind = self._host.mind
        assert mind is not None
        source = structure("source", String(str(self.caller)))
        goal = Annotated(self._goal, (source,))
        self._enter(PENDING)

        def adopt(_: object = None) -> None:
            if not self.over:  # it was cancelled in the same step
                self._watched = WatchedGoal(mind, goal, self._news, self._dropped, cause, self.accept)

        if mind.running:
            mind.do_soon(adopt)
        else:
            adopt()

    def intentions(self) -> list[Intention]:
        """Return the intentions that pursue it."""
        return self._watched.intentions() if self._watched is not None and not self.over else []

    def _some_intention(self) -> list[Intention]:
        """Return the intention that began to pursue it while that lives: a search takes long if there are many."""
        watched = self._watched
        if watched is not None and watched.first.id in watched.agent.alive:
            return [watched.first]
        return self.intentions()

    def accept(self) -> None:
        """The agent accepts it."""
        if self.state == PENDING:
            self._enter(RUNNING)

    def tell(self, fraction: float, note: str) -> None:
        """The agent says how far it is."""
        if not self.over:
            self.accept()
            self.progress, self.note = fraction, note
            self._changed(self)

    @property
    def identity(self) -> object:
        """What the bottom frame of its intentions serves; None before the agent has it."""
        return None if self._watched is None else self._watched.identity

    def queue(self) -> None:
        """Let it wait for its turn."""
        self._enter(WAITING)

    def refuse(self, reason: Term, message: str) -> None:
        """End it before the agent knows of it."""
        self.reasons, self.message = ((REFUSED, reason),), message
        self._finish(REFUSED_STATE)

    def cancel(self) -> None:
        """Drop its intention, and wait for the clean-up of its operations and plans."""
        if self.over or self.state == CANCELLING:
            return
        if self._watched is None or not self.intentions():
            self._finish(CANCELLED)
            return
        mind = self._host.mind
        assert mind is not None
        self._enter(CANCELLING)
        dropped = self.intentions()
        operations = [task for each in dropped for task in self._operations(each)]
        clean_ups = [goal for each in dropped for goal in _clean_ups(each)]
        for each in dropped:
            goals.drop_intention(mind, each)
        mind.architecture.ready()
        self._cleaning = asyncio.create_task(self._clean(mind, operations, clean_ups))

    def agent_ended(self) -> None:
        """The agent has ended."""
        self.message = f"agent {self.agent} has ended"
        self.reasons = (atom("agent_ended"),)
        self._finish(CANCELLED if self.state == CANCELLING else FAILED)

    def _operations(self, intention: Intention) -> list["asyncio.Task[None]"]:
        waiting, body = intention.waiting, self._host.body
        act = None if waiting is None else waiting.act
        task = None if act is None or body is None else body.task_of(act)
        return [] if task is None else [task]

    async def _clean(
        self, mind: Mind, operations: "Sequence[asyncio.Task[None]]", after: Sequence[Term]
    ) -> None:
        if operations:
            await asyncio.wait(operations, timeout=CLEAN_UP)
        for goal in after:
            ended: asyncio.Future[None] = asyncio.get_running_loop().create_future()

            def end(ended: "asyncio.Future[None]" = ended) -> None:
                if not ended.done():
                    ended.set_result(None)

            WatchedGoal(mind, goal, end, end)
            await ended
        self._finish(CANCELLED)

    def _news(self) -> None:
        watched = self._watched
        assert watched is not None
        if self.state == CANCELLING:
            return
        if watched.achieved:
            given = named(self.offer, [resolve(each) for each in watched.arguments])
            outputs = [each.name for each in self.offer.parameters if each.output]
            self.results = {name: given[name] for name in outputs if given[name] is not None}
            self.accept()
            self._finish(ACHIEVED)
            return
        reason = watched.reason
        if reason is not None:
            self.message, self.reasons = _words(reason), reason.terms
        self._finish(REFUSED_STATE if self.state == PENDING else FAILED)

    def _dropped(self) -> None:
        if self.state != CANCELLING and not self.over:
            self.message, self.reasons = "the agent dropped the goal", (atom("dropped"),)
            self._finish(FAILED)

    def _enter(self, state: str) -> None:
        if self.state != state:
            self.state = state
            if state != PENDING and not self._decision.done():
                self._decision.set_result(None)
            self._changed(self)

    def _finish(self, state: str) -> None:
        if self.over:
            return
        self.ended = self._host.now()
        self._enter(state)
        if not self._end.done():
            self._end.set_result(None)


def _clean_ups(intention: Intention) -> list[Term]:
    """Return the clean-up goals of the plans on a stack, the innermost first."""
    found = [frame[SUPERVISION].cleanup for frame in reversed(intention.frames) if is_supervision(frame)]
    return [resolve(each) for each in found if each is not None]


def _words(reason: FailureReason) -> str:
    message = reason.message()
    if message in ("", BY_FAIL):  # the step `.fail(R)` says no more than R
        message = ", ".join(reasons_of(reason.others())) or message or ", ".join(reasons_of(reason.terms))
    return message or "it failed"
