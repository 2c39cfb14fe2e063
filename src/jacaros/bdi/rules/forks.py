"""Concurrency inside a plan: ``a |&| b`` (all branches) and ``a ||| b`` (the first one).

Each branch is an intention of its own with a copy of the stack, so its bindings stay local. The branch that finishes
last (``|&|``) or first (``|||``) continues with the rest of the plan.
"""

from collections.abc import Sequence
from dataclasses import dataclass

from jacaros.bdi.rules.searching import Loop, release
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.intention import FIRST_SLOT, GOAL, STEP, Frame, Intention, NextStep
from jacaros.bdi.state.plan import SUSPENDED
from jacaros.terms.substitution import HOLDERS, rename
from jacaros.terms.values import Var

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
        branch = agent.new_intention(agent.cause_now() or parent.cause)
        branch.frames = copied(parent.frames)
        branch.frames[-1][STEP] = first
        branch.handlers = list(parent.handlers)
        branch.on_failed, branch.on_end = parent.on_failed, parent.on_end
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
