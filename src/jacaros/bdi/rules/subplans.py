"""Plans inside plans: they handle events while their plan is pursued, and see its variables."""

from collections.abc import Iterable, Iterator, Sequence

from jacaros.bdi.state.belief_base import MANY_NAMES
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.engine import Select
from jacaros.bdi.state.intention import PLAN, Frame, Intention
from jacaros.bdi.state.literals import EventAnnotations
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.plan_library import concerns
from jacaros.bdi.state.supervision import is_supervision
from jacaros.bdi.state.triggers import Goal, Trigger


def select_in_scope(
    agent: Circumstance, intention: Intention, goal: Goal, annotations: EventAnnotations
) -> Frame | None:
    """Return the frame of the first applicable sub-plan: of the plan on top, then of the plans around it."""
    for frame in scopes(intention):
        found = _select(agent, frame, goal, annotations)
        if found is not None:
            return found
    return None


def scopes(intention: Intention) -> Iterable[Frame]:
    """Return the frames whose sub-plans the plan on top can use, the innermost first.

    A failed plan stays on top while its failure is handled.
    """
    frames = intention.frames
    return _scopes(intention, frames[-1]) if frames and frames[-1][PLAN].nested else ()


def _scopes(intention: Intention, frame: Frame | None) -> Iterator[Frame]:
    while frame is not None:
        if frame[PLAN].subplans:
            yield frame
        frame = _outer(intention, frame)


def _outer(intention: Intention, frame: Frame) -> Frame | None:
    """Return the frame of the plan that a frame's plan is a sub-plan of."""
    if is_supervision(frame):  # it stands between a goal and the plan that posted it
        place = next(place for place, each in enumerate(intention.frames) if each is frame)
        return intention.frames[place - 1] if place else None
    scope = frame[PLAN].scope
    if scope is None:
        return None
    for candidate in reversed(intention.frames):
        if candidate[PLAN] is scope:
            return candidate
    return intention.outer[1] if intention.outer is not None else None


def _select(agent: Circumstance, frame: Frame, goal: Goal, annotations: EventAnnotations) -> Frame | None:
    select = _select_function(agent, frame[PLAN], goal[0])
    if select is None:
        return None
    agent.outer_frame = frame
    return select(agent, goal, annotations)


def _select_function(agent: Circumstance, plan: Plan, kind: Trigger) -> Select | None:
    if kind not in plan.subselects:
        plans = [inner for inner in plan.subplans if concerns(inner, kind)]
        if len(plan.subselects) >= MANY_NAMES:
            plan.subselects.clear()
        plan.subselects[kind] = agent.engine.select(kind, plans, plan) if plans else None
    found: Select | None = plan.subselects[kind]
    return found


def has_inner(agent: Circumstance, frame: Frame, kind: Trigger) -> bool:
    """Return whether a frame's plan has a sub-plan for an event kind."""
    return _select_function(agent, frame[PLAN], kind) is not None


def react(
    agent: Circumstance, goal: Goal, annotations: EventAnnotations, plans: Sequence[Plan]
) -> list[tuple[Intention, Frame, Frame]]:
    """Return sub-plans that react to an external event: for each intention the applicable one nearest to the top.

    Args:
        agent: whose intentions react.
        goal, annotations: the event.
        plans: those with sub-plans for events of its kind.

    Returns:
        each with the intention, the frame of the outer plan, and the new frame.
    """
    found = []
    holders = {number: each for plan in plans for number, each in agent.holders.get(plan, {}).items()}
    for _, intention in sorted(holders.items()):
        for frame in reversed(intention.frames):
            inner = _select(agent, frame, goal, annotations)
            if inner is not None:
                found.append((intention, frame, inner))
                break
    return found
