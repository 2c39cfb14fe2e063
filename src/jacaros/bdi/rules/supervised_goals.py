"""Goals with annotations that supervise them: ``!g[within(Ms), retry(N, Ms), every(Ms)]``.

One deadline applies to all attempts together. With ``every``, the goal is posted again in each period, and deadline and
attempts apply to each period.
"""

from math import ceil, floor

from jacaros.bdi.rules import meta_events
from jacaros.bdi.rules.deadlines import deadline_terms, set_deadline
from jacaros.bdi.rules.supervision import end, end_pause, supervising, wait_for
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.event import Event, Posted
from jacaros.bdi.state.intention import ANNOTATIONS, GOAL, STEP, Frame, Intention
from jacaros.bdi.state.literals import apart, literal_of
from jacaros.bdi.state.plan import SUSPENDED
from jacaros.bdi.state.supervision import SUPERVISION, GoalSupervision
from jacaros.bdi.state.triggers import Goal
from jacaros.excerpts import is_worth_a_line
from jacaros.terms.text import text
from jacaros.terms.values import BY_SELF, Functor, Term, atom, bare, functor, structure

WITHIN, HARD_DEADLINE, EVERY = functor("within", 1), functor("hard_deadline", 1), functor("every", 1)
RETRY, RETRY_AFTER = functor("retry", 1), functor("retry", 2)
ACTING: frozenset[Functor] = frozenset({WITHIN, HARD_DEADLINE, EVERY, RETRY, RETRY_AFTER})
"""The annotations of goals that have an effect."""
_EXACT = 1e-5
"""Tolerance for inaccurate clocks, in seconds."""


# --- beginning ---------------------------------------------------------------------------------------------


def supervision_of(goal: Goal, annotations: tuple[Term, ...]) -> GoalSupervision | None:
    """Return the supervision of a goal, or None if its annotations ask for none. Invalid annotations have no effect."""
    found: GoalSupervision | None = None
    for annotation in annotations:
        inner = bare(annotation)
        if inner.__class__ is tuple and inner[0] in ACTING and goal[0].kind == "!":
            numbers = inner[1:]
            if all(number.__class__ is float for number in numbers):
                found = found or GoalSupervision(goal[0])
                _take(found, inner[0], numbers)
    return found if found is not None and found.is_acting else None


def _take(supervision: GoalSupervision, word: Functor, numbers: tuple[float, ...]) -> None:
    seconds = numbers[-1] / 1000
    if word is WITHIN or word is HARD_DEADLINE:
        if supervision.within is None or seconds < supervision.within:
            supervision.within, supervision.hard = seconds, word is HARD_DEADLINE
    elif word is EVERY:
        if seconds > 0:
            supervision.period = seconds
    elif numbers[0] >= 1 and numbers[0].is_integer():
        supervision.retries = int(numbers[0])
        supervision.back_off = max(0.0, seconds) if word is RETRY_AFTER else 0.0


def posted(agent: Circumstance, goal: Goal, annotations: tuple[Term, ...]) -> Posted:
    """Post a goal of the running intention, supervised as its annotations say."""
    supervision = supervision_of(goal, annotations)
    if supervision is not None and agent.current is not None:
        goal = _begin(agent, agent.current, supervision, goal, annotations)
    return Posted(goal, annotations)


def adopt(agent: Circumstance, event: Event) -> None:
    """Post the event of a new goal, which has an intention of its own."""
    goal, _, annotations, cause = event
    if annotations is not BY_SELF and isinstance(annotations, tuple):
        supervision = supervision_of(goal, annotations)
        if supervision is not None:
            if len(agent.alive) >= agent.options.intention_limit:
                agent.budgets["intention_limit"].refuse(len(agent.alive))
                return
            intention = agent.new_intention(cause)
            goal = _begin(agent, intention, supervision, goal, annotations)
            event = (goal, intention, annotations, None)
    meta_events.post_new_goal(agent, event)


def begin_watched(
    agent: Circumstance, intention: Intention, goal: Goal, annotations: tuple[Term, ...]
) -> None:
    """Post the goal of an intention that Python code has started."""
    supervision = supervision_of(goal, annotations)
    if supervision is not None:
        goal = _begin(agent, intention, supervision, goal, annotations)
    agent.post((goal, intention, annotations, None))


def _begin(
    agent: Circumstance,
    intention: Intention,
    supervision: GoalSupervision,
    goal: Goal,
    annotations: tuple[Term, ...],
) -> Goal:
    """Put the frame of a supervision on the stack; return the goal to post."""
    supervision.began = agent.architecture.now()
    frame = supervising(agent, supervision, goal_ended, goal[1:])
    frame[ANNOTATIONS] = annotations
    intention.frames.append(frame)
    return _start(agent, supervision, goal)


def _start(agent: Circumstance, supervision: GoalSupervision, goal: Goal) -> Goal:
    """Start the supervision of the goal or of one period; return the goal to post, with new variables in each period."""
    supervision.failed = 0
    if supervision.within is not None:
        set_deadline(
            agent, supervision, supervision.within, deadline_terms(supervision.within, supervision.hard)
        )
    return goal if supervision.period is None else apart(goal)


# --- ends and periods --------------------------------------------------------------------------------------


def goal_ended(agent: Circumstance, frame: Frame) -> object:
    """The step of a supervision's frame: the goal was achieved, or a plan handled its failure."""
    supervision: GoalSupervision = frame[SUPERVISION]
    end(agent, supervision)
    if supervision.period is None:
        frame[STEP] = None
        return None
    goal: Goal = (supervision.kind, *frame[SUPERVISION + 1 :])
    delay = _time_to_next(agent, supervision, goal, frame[ANNOTATIONS])
    assert agent.current is not None
    reason = structure("every", supervision.period * 1000)
    wait_for(agent, agent.current, (goal, frame[ANNOTATIONS]), delay, next_period, reason)
    return SUSPENDED


def _time_to_next(
    agent: Circumstance, supervision: GoalSupervision, goal: Goal, annotations: tuple[Term, ...]
) -> float:
    """Return the seconds until the next period; periods that are already over have been missed."""
    assert supervision.period is not None
    now = agent.architecture.now()
    if now < supervision.began + supervision.number * supervision.period - _EXACT:
        supervision.began, supervision.number = now, 0  # the clock was set back
    following = ceil((now - supervision.began - _EXACT) / supervision.period)
    _skip_to(agent, supervision, max(following, supervision.number + 1) - 1, goal, annotations)
    return max(0.0, supervision.began + (supervision.number + 1) * supervision.period - now)


def next_period(agent: Circumstance, frame: Frame) -> Posted:
    """The step after the pause between two periods."""
    intention = end_pause(agent)
    goal, annotations = frame[GOAL], frame[ANNOTATIONS]
    supervision: GoalSupervision = intention.frames[-1][SUPERVISION]
    assert supervision.period is not None
    passed = floor((agent.architecture.now() - supervision.began + _EXACT) / supervision.period)
    # The intention may have been suspended, or the mind stored, when the period began.
    _skip_to(agent, supervision, passed - 1, goal, annotations)
    supervision.number += 1
    return Posted(_start(agent, supervision, goal), annotations)


def _skip_to(
    agent: Circumstance, supervision: GoalSupervision, number: int, goal: Goal, annotations: tuple[Term, ...]
) -> None:
    """Report that the periods up to *number* have been missed: raise events for plans, and warn."""
    missed = number - supervision.number
    if missed <= 0:
        return
    supervision.number = number
    supervision.missed += missed
    meta_events.goal_state(
        agent, goal, annotations, "missed", atom("overrun"), structure("periods", float(missed))
    )
    if is_worth_a_line(supervision.missed, missed):
        count = "a period" if supervision.missed == 1 else f"{supervision.missed} periods"
        every = text(supervision.period * 1000) if supervision.period is not None else ""
        agent.architecture.log(
            "warning",
            f"goal !{text(literal_of(goal, ()))} has missed {count} of {every} ms: it takes longer",
        )
