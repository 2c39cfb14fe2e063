"""Concurrency inside a plan (``a |&| b``, ``a ||| b``), and plans inside plans.

Each branch is an intention of its own with a copy of the stack, so its bindings stay local. The branch that finishes
last (``|&|``) or first (``|||``) continues with the rest of the plan.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass

from jacaros.agents.mind.rules.searching import Loop, release
from jacaros.agents.mind.state.belief_base import MANY_NAMES
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.intention import FIRST_SLOT, GOAL, PLAN, STEP, Frame, Intention, NextStep
from jacaros.agents.mind.state.pending import is_supervision
from jacaros.agents.mind.state.plan import SUSPENDED, Plan, Select
from jacaros.agents.mind.state.plan_library import concerns
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, Trigger
from jacaros.agents.terms.substitution import HOLDERS, rename
from jacaros.agents.terms.values import Var

_HOLDERS = HOLDERS | {Var}


@dataclass(slots=True, eq=False)
class Fork:
    """A running fork.

    Attributes:
        joins_all: True for ``|&|``.
        depth: index of the forking plan's frame on every branch's stack.
        next_step: where the plan continues.
        open: numbers of the branches that have neither finished nor failed.
    """

    joins_all: bool
    depth: int
    next_step: NextStep
    open: set[int]


def fork(
    agent: Circumstance, operator: str, frame: Frame, firsts: Sequence[NextStep], next_step: NextStep
) -> object:
    """Begin the branches; the intention that forks is replaced by theirs."""
    parent = agent.current
    assert parent is not None
    if len(agent.alive) + len(firsts) > agent.options.intention_limit:
        agent.budgets["intention_limit"].refuse(len(agent.alive))
    point = Fork(operator == "and", len(parent.frames) - 1, next_step, set(range(len(firsts))))
    del frame
    for number, first in enumerate(firsts):
        branch = Intention(agent, agent.cause_now() or parent.cause)
        branch.frames = copied(parent.frames)
        branch.frames[-1][STEP] = first
        branch.handlers = list(parent.handlers)
        branch.on_failed, branch.on_end, branch.on_wait = parent.on_failed, parent.on_end, parent.on_wait
        branch.forks = (*parent.forks, (point, number))
        agent.note_plans(branch)
        agent.make_ready(branch)
        if agent.atomic is parent:
            agent.atomic = branch
    parent.frames.clear()  # its goals are pursued in the branches
    agent.finish(parent)
    return SUSPENDED


def copied(frames: list[Frame], names: dict[Var, Var] | None = None) -> list[Frame]:
    """The stack with frames and free variables of its own.

    Args:
        frames: the stack.
        names: the names of variables in the copy, if the loops on the stack have given back theirs.
    """
    known: dict[Var, Var] = {} if names is None else names
    copies = []
    for frame in frames:
        copy = list(frame)
        goal = frame[GOAL]
        if len(goal) > 1:
            copy[GOAL] = (goal[0], *(rename(a, known) if a.__class__ in _HOLDERS else a for a in goal[1:]))
        for slot in range(FIRST_SLOT, len(copy)):
            value = copy[slot]
            if value.__class__ in _HOLDERS:
                copy[slot] = rename(value, known)
            elif value.__class__ is Loop:
                if names is None and (value.free or value.round):
                    return _copied_with_loops(frames)
                copy[slot] = value.copy(known)
        copies.append(copy)
    return copies


def _copied_with_loops(frames: list[Frame]) -> list[Frame]:
    """The same where loops give variables back: these remain variables, although they have values."""
    names: dict[Var, Var] = {}
    loops = [value for frame in frames for value in frame if value.__class__ is Loop]
    bound = [(each, each.ref) for loop in loops for each in (*loop.free, *loop.round) if each.ref is not None]
    release(variable for variable, _ in bound)
    copies = copied(frames, names)
    values = [rename(value, names) for _, value in bound]
    for (variable, value), own in zip(bound, values, strict=True):
        variable.ref = value
        if variable in names:
            names[variable].ref, names[variable].at = own, variable.at
    return copies


def join_branch(agent: Circumstance, frame: Frame) -> object:
    """The step after the last one of a branch: the branch has ended."""
    intention = agent.current
    assert intention is not None
    point, number = intention.forks[-1]
    point.open.discard(number)
    if point.joins_all and point.open:
        agent.finish(intention)
        return SUSPENDED
    _drop_branches(agent, point, intention)
    intention.forks = intention.forks[:-1]
    frame[STEP] = point.next_step
    return None


def branch_failed(agent: Circumstance, intention: Intention) -> bool:
    """Handle a branch that failed without a handler; return True if that is a failure of the plan that forked."""
    point, number = intention.forks[-1]
    point.open.discard(number)
    if not point.joins_all and point.open:
        return False
    _drop_branches(agent, point, intention)
    intention.forks = intention.forks[:-1]
    return True


def leave(agent: Circumstance, intention: Intention, index: int) -> None:
    """The stack of a branch is cut at *index*: forks at this frame and above are over, with their other branches."""
    while intention.forks and intention.forks[-1][0].depth >= index:
        _drop_branches(agent, intention.forks[-1][0], intention)
        intention.forks = intention.forks[:-1]


def _drop_branches(agent: Circumstance, point: Fork, survivor: Intention) -> None:
    """The other branches of a fork are over, with all that they forked themselves."""
    if not point.open:
        return
    point.open.clear()
    for other in list(agent.alive.values()):
        if other is not survivor and any(fork_point is point for fork_point, _ in other.forks):
            agent.finish(other)


# Plans inside plans: they handle events while their plan is pursued, and see its variables.


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
