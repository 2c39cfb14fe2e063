"""Goals whose annotations say how they are pursued: ``!g[within(Ms), retry(N, Ms), every(Ms)]``.

A deadline is one for all attempts.  With ``every``, the goal is pursued anew in each period, and deadline and attempts are
those of one period.
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
from jacaros.bdi.state.supervision import SUPERVISION, Pursuit
from jacaros.bdi.state.triggers import Goal
from jacaros.terms.text import text
from jacaros.terms.values import BY_SELF, Functor, Term, atom, bare, functor, structure

WITHIN, HARD_DEADLINE, EVERY = functor("within", 1), functor("hard_deadline", 1), functor("every", 1)
RETRY, RETRY_AFTER = functor("retry", 1), functor("retry", 2)
ACTING: frozenset[Functor] = frozenset({WITHIN, HARD_DEADLINE, EVERY, RETRY, RETRY_AFTER})
"""The annotations of goals that have an effect."""
_EXACT = 1e-5
"""Seconds by which a clock may be off."""


# --- beginning ---------------------------------------------------------------------------------------------


def pursuit_of(goal: Goal, annotations: tuple[Term, ...]) -> Pursuit | None:
    """How a goal is to be pursued; None when its annotations do not say.  What is not valid has no effect."""
    found: Pursuit | None = None
    for annotation in annotations:
        inner = bare(annotation)
        if inner.__class__ is tuple and inner[0] in ACTING and goal[0].kind == "!":
            numbers = inner[1:]
            if all(number.__class__ is float for number in numbers):
                found = found or Pursuit(goal[0])
                _take(found, inner[0], numbers)
    return found if found is not None and found.is_acting else None


def _take(pursuit: Pursuit, word: Functor, numbers: tuple[float, ...]) -> None:
    seconds = numbers[-1] / 1000
    if word is WITHIN or word is HARD_DEADLINE:
        if pursuit.within is None or seconds < pursuit.within:
            pursuit.within, pursuit.hard = seconds, word is HARD_DEADLINE
    elif word is EVERY:
        if seconds > 0:
            pursuit.period = seconds
    elif numbers[0] >= 1 and numbers[0].is_integer():
        pursuit.retries = int(numbers[0])
        pursuit.back_off = max(0.0, seconds) if word is RETRY_AFTER else 0.0


def posted(agent: Circumstance, goal: Goal, annotations: tuple[Term, ...]) -> Posted:
    """Post a goal of the running intention; what its annotations say is taken care of from now on."""
    pursuit = pursuit_of(goal, annotations)
    if pursuit is not None and agent.current is not None:
        goal = _begin(agent, agent.current, pursuit, goal, annotations)
    return Posted(goal, annotations)


def adopt(agent: Circumstance, event: Event) -> None:
    """Post the event of a new goal, which has an intention of its own."""
    goal, _, annotations, cause = event
    if annotations is not BY_SELF and isinstance(annotations, tuple):
        pursuit = pursuit_of(goal, annotations)
        if pursuit is not None:
            if len(agent.alive) >= agent.options.intention_limit:
                agent.budgets["intention_limit"].refuse(len(agent.alive))
                return
            intention = agent.new_intention(cause)
            goal = _begin(agent, intention, pursuit, goal, annotations)
            event = (goal, intention, annotations, None)
    meta_events.post_new_goal(agent, event)


def begin_watched(
    agent: Circumstance, intention: Intention, goal: Goal, annotations: tuple[Term, ...]
) -> None:
    """Post the goal of an intention that Python code has begun."""
    pursuit = pursuit_of(goal, annotations)
    if pursuit is not None:
        goal = _begin(agent, intention, pursuit, goal, annotations)
    agent.post((goal, intention, annotations, None))


def _begin(
    agent: Circumstance, intention: Intention, pursuit: Pursuit, goal: Goal, annotations: tuple[Term, ...]
) -> Goal:
    """Put the frame of a pursuit on the stack; return the goal to post."""
    pursuit.began = agent.architecture.now()
    frame = supervising(agent, pursuit, goal_ended, goal[1:])
    frame[ANNOTATIONS] = annotations
    intention.frames.append(frame)
    return _start(agent, pursuit, goal)


def _start(agent: Circumstance, pursuit: Pursuit, goal: Goal) -> Goal:
    """Begin the pursuit, or that of one period; return the goal to post: in each period with variables of its own."""
    pursuit.failed = 0
    if pursuit.within is not None:
        set_deadline(agent, pursuit, pursuit.within, deadline_terms(pursuit.within, pursuit.hard))
    return goal if pursuit.period is None else apart(goal)


# --- ends and periods --------------------------------------------------------------------------------------


def goal_ended(agent: Circumstance, frame: Frame) -> object:
    """The step of a pursuit's frame: the goal has been achieved, or a plan took care of its failure."""
    pursuit: Pursuit = frame[SUPERVISION]
    end(agent, pursuit)
    if pursuit.period is None:
        frame[STEP] = None
        return None
    goal: Goal = (pursuit.kind, *frame[SUPERVISION + 1 :])
    delay = _time_to_next(agent, pursuit, goal, frame[ANNOTATIONS])
    assert agent.current is not None
    reason = structure("every", pursuit.period * 1000)
    wait_for(agent, agent.current, (goal, frame[ANNOTATIONS]), delay, next_period, reason)
    return SUSPENDED


def _time_to_next(agent: Circumstance, pursuit: Pursuit, goal: Goal, annotations: tuple[Term, ...]) -> float:
    """Seconds to the beginning of the next period; those that are over already have been missed."""
    assert pursuit.period is not None
    now = agent.architecture.now()
    if now < pursuit.began + pursuit.number * pursuit.period - _EXACT:
        pursuit.began, pursuit.number = now, 0  # the clock was set back
    following = ceil((now - pursuit.began - _EXACT) / pursuit.period)
    _skip_to(agent, pursuit, max(following, pursuit.number + 1) - 1, goal, annotations)
    return max(0.0, pursuit.began + (pursuit.number + 1) * pursuit.period - now)


def next_period(agent: Circumstance, frame: Frame) -> Posted:
    """The step behind the pause between two periods."""
    intention = end_pause(agent)
    goal, annotations = frame[GOAL], frame[ANNOTATIONS]
    pursuit: Pursuit = intention.frames[-1][SUPERVISION]
    assert pursuit.period is not None
    passed = floor((agent.architecture.now() - pursuit.began + _EXACT) / pursuit.period)
    # The intention may have been suspended, or the mind stored, when the period began.
    _skip_to(agent, pursuit, passed - 1, goal, annotations)
    pursuit.number += 1
    return Posted(_start(agent, pursuit, goal), annotations)


def _skip_to(
    agent: Circumstance, pursuit: Pursuit, number: int, goal: Goal, annotations: tuple[Term, ...]
) -> None:
    """The periods behind the present one, up to one with a *number*, have been missed: tell plans, and warn."""
    missed = number - pursuit.number
    if missed <= 0:
        return
    pursuit.number = number
    before, pursuit.missed = pursuit.missed, pursuit.missed + missed
    meta_events.goal_state(
        agent, goal, annotations, "missed", atom("overrun"), structure("periods", float(missed))
    )
    if len(str(before)) < len(str(pursuit.missed)) or not before:  # the 1st, 10th, 100th ...
        count = "a period" if pursuit.missed == 1 else f"{pursuit.missed} periods"
        every = text(pursuit.period * 1000) if pursuit.period is not None else ""
        agent.architecture.log(
            "warning",
            f"the goal !{text(literal_of(goal, ()))} has missed {count} of {every} ms: it takes longer",
        )
