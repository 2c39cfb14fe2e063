"""Goals posted from outside the mind, with a callback for their end."""

from collections.abc import Callable

from jacaros.asl import nodes
from jacaros.bdi.actions.internal_action import ActionError
from jacaros.bdi.explaining.failure_reason import FailureReason
from jacaros.bdi.rules.supervised_goals import begin_watched
from jacaros.bdi.state.belief_base import parts
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import GOAL, Frame, Intention
from jacaros.bdi.state.literals import own_annotations
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.triggers import trigger
from jacaros.terms.substitution import rename
from jacaros.terms.values import BY_SELF, Term, atom, functor

_WATCHED = trigger("+", "", functor("watched", 0, namespace="jacaros"))


class WatchedGoal:
    """An achievement goal in an intention of its own, with a callback for its end.

    The bottom frame of the stack is reached when the goal is achieved. It is copied with the stack when the plan forks,
    so the branch that continues reaches it.

    Args:
        agent: the agent that adopts the goal.
        goal: an atom or structure.
        on_end: called when the goal is achieved (with None) or has failed (with the reason, as far as it is known).

    Attributes:
        achieved: the goal was achieved.
        failed: it failed, and no plan handled the failure.
        reason: why it failed, None if that is not known.

    Raises:
        ActionError: *goal* is not a literal.
    """

    def __init__(self, agent: Circumstance, goal: Term, on_end: Callable[[], None] = lambda: None) -> None:
        symbol, arguments, annotations = parts(rename(goal))
        if symbol is None:
            raise ActionError("a goal must be a literal")
        self.agent = agent
        self.achieved = False
        self.failed = False
        self.reason: FailureReason | None = None
        self._on_end = on_end
        self._goal = (trigger("+", "!", symbol), *arguments)
        self._bottom = (_WATCHED, float(id(self)))
        intention = agent.new_intention()
        intention.on_failed = (_end_in_failure, (self,))
        frame: Frame = [self._reached, self._bottom, BY_SELF, agent.trail.serial, _bottom_plan()]
        intention.frames.append(frame)
        begin_watched(agent, intention, self._goal, own_annotations(annotations))
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

    def end_in_failure(self, reason: FailureReason | None) -> None:
        """Report that the goal failed and no plan handled the failure."""
        self.failed = True
        self.reason = reason
        self._on_end()


def _end_in_failure(agent: Circumstance, reason: FailureReason | None, goal: WatchedGoal) -> None:
    del agent
    goal.end_in_failure(reason)


def _bottom_plan() -> Plan:
    node = nodes.Plan(None, nodes.Trigger("+", "!", nodes.Literal("watched")), None, nodes.Body())
    return Plan(node, atom("watched"))
