"""External actions: what a mind wants done in its environment, and how it ended."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

from jacaros.terms.values import Functor, Term, functor
from jacaros.trace import Cause

NEEDS = functor(".needs", 3)
"""Functor of the act by which a plan or goal asks for resources: their names, the policy, the goal.  It ends when they
are granted; they are held until it is cancelled."""

# Not frozen: that would make creating each of them three times as slow. They are never changed.


@dataclass(slots=True)
class Act:
    """A request to the environment; the intention waits for its `Completion`.

    Attributes:
        id: number of the act, unique in its agent.
        functor: name and arity of the action.
        arguments: with all bindings applied; an unbound `Var` is an output.
        annotations: of the action, such as ``artifact_id(Id)``.
        intention: id of the intention, so that the environment can keep a current workspace for each.
        cause: why it is performed.
        place: plan, file and line of the step, while an observer watches.
        urgency: of the intention; decides between claims for resources.
        within: acts by which plans of the intention have requested resources, outermost first.
        yields: its resources may be taken away from it; False for an atomic plan.
    """

    id: int
    functor: Functor
    arguments: tuple[Term, ...]
    annotations: tuple[Term, ...]
    intention: int
    cause: Cause | None = None
    place: Mapping[str, Any] | None = None
    urgency: int = 0
    within: tuple[int, ...] = ()
    yields: bool = True


@dataclass(frozen=True, slots=True)
class Completion:
    """How an act ended.

    Attributes:
        success: False fails the step with ``error(action_failed)``.
        outputs: pairs of an output variable of the act and its value.
        annotations: on failure, terms for the failure event: ``error_msg("…")``, ``env_failure_reason(R)``.
    """

    success: bool
    outputs: tuple[tuple[Term, Term], ...] = ()
    annotations: tuple[Term, ...] = ()


@dataclass(slots=True)
class Percept:
    """One thing noticed in the environment.

    Attributes:
        kind: ``add`` and ``remove`` change a percept belief, ``signal`` is an event only.
        literal: an atom or structure, ground, without annotations.
        annotations: sorted; ``source(percept)`` among them.
        cause: the sensor message or property change behind it.
        kept: what the engine of the first mind that took it in keeps with it, for all that share it.
    """

    kind: str
    literal: Term
    annotations: tuple[Term, ...]
    cause: Cause | None = None
    kept: Any = field(default=None, compare=False, repr=False)
