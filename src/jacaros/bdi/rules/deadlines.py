"""Goals that have to be achieved in time: ``!g[hard_deadline(Ms)]``."""

from jacaros.bdi.explaining.failure_reason import nowhere
from jacaros.bdi.rules import goals
from jacaros.bdi.rules.failure import error_terms
from jacaros.bdi.rules.waits import set_alarm
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import Intention
from jacaros.bdi.state.literals import literal_of
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.substitution import rename
from jacaros.terms.values import Term, bare, functor

HARD_DEADLINE = functor("hard_deadline", 1)


def watch(agent: Circumstance, goal: Goal, annotations: tuple[Term, ...], separate: bool) -> None:
    """Fail a goal that is still pursued when its deadline has come; goals without one are let be."""
    for annotation in annotations:
        inner = bare(annotation)
        if inner.__class__ is tuple and inner[0] is HARD_DEADLINE and inner[1].__class__ is float:
            _set(agent, rename(literal_of(goal, ())), inner[1] / 1000.0, None if separate else agent.current)


def _set(agent: Circumstance, goal: Term, delay: float, intention: Intention | None) -> None:
    height = len(intention.frames) - 1 if intention is not None else 0
    set_alarm(agent, delay, _pass, goal, intention, height)


def _pass(agent: Circumstance, goal: Term, intention: Intention | None, height: int) -> None:
    agent.do_soon(_fail, goal, intention, height)
    agent.architecture.ready()


def _fail(agent: Circumstance, goal: Term, intention: Intention | None, height: int) -> None:
    if intention is None or _pursues(agent, intention, goal, height):
        goals.fail_goal(
            agent, goal, nowhere(*error_terms("deadline_reached", "the goal was not achieved in time"))
        )


def _pursues(agent: Circumstance, intention: Intention, goal: Term, height: int) -> bool:
    """Whether an intention still has the goal where it was posted, or above."""
    if intention.dropped:
        return False
    index = goals.frame_of(agent, intention, goal, height)
    return index is not None or intention in goals.intentions_for(agent, goal)
