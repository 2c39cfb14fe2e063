"""Goals and conditions that code outside the mind watches, with a callback for their end.  No stored mind holds them."""

from collections.abc import Callable

from jacaros.bdi.actions.internal_action import ActionError
from jacaros.bdi.explaining.failure_reason import FailureReason
from jacaros.bdi.rules.deadlines import supervised
from jacaros.bdi.rules.pending import cancel, watch
from jacaros.bdi.state.belief_base import parts
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import GOAL, Frame, Intention
from jacaros.bdi.state.literals import own_annotations
from jacaros.bdi.state.plan import hidden_plan
from jacaros.bdi.state.triggers import trigger
from jacaros.terms.substitution import rename
from jacaros.terms.values import BY_SELF, Term, atom, functor

_WATCHED = trigger("+", "", functor("watched", 0, namespace="jacaros"))
_BOTTOM = hidden_plan(atom("watched"))


def _nothing() -> None:
    """Do nothing."""


class WatchedGoal:
    """An achievement goal in an intention of its own, with a callback for its end.

    The bottom frame of the stack is reached when the goal is achieved. It is copied with the stack when the plan forks,
    so the branch that continues reaches it.

    Args:
        agent: the agent that adopts the goal.
        goal: an atom or structure.
        on_end: called when the goal is achieved or has failed.
        on_dropped: called when it is over without having been achieved or having failed.

    Attributes:
        achieved: the goal was achieved.
        failed: it failed, and no plan handled the failure.
        reason: why it failed, None if that is not known.

    Raises:
        ActionError: *goal* is not a literal.
    """

    def __init__(
        self,
        agent: Circumstance,
        goal: Term,
        on_end: Callable[[], None] = _nothing,
        on_dropped: Callable[[], None] = _nothing,
    ) -> None:
        symbol, arguments, annotations = parts(rename(goal))
        if symbol is None:
            raise ActionError("a goal must be a literal")
        self.agent = agent
        self.achieved = False
        self.failed = False
        self.reason: FailureReason | None = None
        self._on_end, self._on_dropped = on_end, on_dropped
        posted = (trigger("+", "!", symbol), *arguments)
        self._bottom = (_WATCHED, float(id(self)))
        intention = agent.new_intention()
        intention.on_failed, intention.on_end = (self._intention_failed, ()), (self._intention_ended, ())
        frame: Frame = [self._reached, self._bottom, BY_SELF, agent.trail.serial, _BOTTOM]
        intention.frames.append(frame)
        given = own_annotations(annotations)
        agent.post((supervised(agent, intention, posted, given), intention, given, None))
        agent.architecture.ready()

    @property
    def ended(self) -> bool:
        """Whether the goal was achieved or has failed."""
        return self.achieved or self.failed

    def intentions(self) -> list[Intention]:
        """The intentions that pursue the goal: one, none when it has ended or was dropped, several after a fork."""
        return [
            intention
            for intention in self.agent.alive.values()
            if intention.frames and intention.frames[0][GOAL] == self._bottom
        ]

    def _reached(self, agent: Circumstance, frame: Frame) -> None:
        del agent
        frame[0] = None
        self.achieved = True
        self._on_end()

    def _intention_failed(self, _: Circumstance, reason: FailureReason | None) -> None:
        self.failed = True
        self.reason = reason
        self._on_end()

    def _intention_ended(self, _: Circumstance) -> None:
        if not (self.ended or self.intentions()):
            self._on_dropped()


class WatchedCondition:
    """A condition of an agent, with a callback for when it holds or cannot be evaluated (then with the exception)."""

    def __init__(
        self, agent: Circumstance, condition: Term, on_end: Callable[[Exception | None], None]
    ) -> None:
        self._agent, self._on_end = agent, on_end
        self._watch = watch(agent, condition, self._ended)
        agent.architecture.ready()

    def _ended(self, _: Circumstance, fault: Exception | None) -> None:
        self._on_end(fault)

    def forget(self) -> None:
        """End the watch; no effect if it has ended."""
        cancel(self._agent, self._watch)
