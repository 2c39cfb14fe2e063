"""A plan as the mind keeps it: its syntax, and what the compiler made of it."""

from collections.abc import Callable, Iterable
from typing import Any

from jacaros.asl import nodes
from jacaros.asl.lowering import lower_value
from jacaros.bdi.fast.generated.body_compiler import StepInfo
from jacaros.bdi.state.triggers import Trigger
from jacaros.terms.order import annotation_set
from jacaros.terms.values import (
    SOURCE,
    Annotated,
    String,
    Term,
    annotations_of,
    atom,
    bare,
    functor,
    functor_of,
)

ATOMIC_LABEL = atom("atomic")
URL = functor("url", 1)
URGENCY = functor("urgency", 1)


class Plan:
    """A plan of the library.

    Attributes:
        node: the syntax.
        label: term of the label, without annotations.
        annotations: those of the label, without its sources.
        atomic: whether the label says ``atomic``.
        urgency: the number of ``urgency(N)`` in the label, 0 without.
        slots: index in the frame by variable name.
        size: number of slots of a body that is run on its own.
        first: the first step function, None for an empty body; set when the plan is compiled.
        steps: what is known of each step function, by its name.
        scope: the plan that this one is a sub-plan of, or None.
        fault: why it cannot be compiled, once that has been seen.
        searched: its context is too large to be compiled, and searched as a term.
        replaceable: nothing is left to do once its last formula has called a goal: it has neither goal condition nor
            sub-plans.
        goal_condition: tells of a frame whether its goal is achieved though the body has not ended; or None.
        subplans: plans for what happens while this one is pursued.
        subselects: their select functions by event kind, made at the first event.
    """

    __slots__ = (
        "annotations",
        "atomic",
        "fault",
        "first",
        "goal_condition",
        "label",
        "node",
        "replaceable",
        "scope",
        "searched",
        "size",
        "slots",
        "steps",
        "subplans",
        "subselects",
        "urgency",
    )

    def __init__(self, node: nodes.Plan, label: Term) -> None:
        self.node = node
        self.label = bare(label)
        self.annotations = tuple(a for a in annotations_of(label) if not _is_source(a))
        self.atomic = ATOMIC_LABEL in self.annotations
        self.urgency = _urgency(self.annotations) if self.annotations else 0
        self.replaceable = node.goal_condition is None and not node.subplans
        self.slots: dict[str, int] = {}
        self.size = 0
        self.first: Callable[[Any, list[Any]], Any] | None = None
        self.steps: dict[str, StepInfo] = {}
        self.scope: Plan | None = None
        self.searched = False
        self.fault: str | None = None
        self.goal_condition: Callable[[Any, list[Any]], bool] | None = None
        self.subplans: list[Plan] = []
        self.subselects: dict[Trigger, Any] = {}

    def __repr__(self) -> str:
        return f"Plan({self.label!r})"

    @property
    def file(self) -> str:
        """Name of the file the plan stands in."""
        span = self.node.span
        return span.file.name if span is not None else "<run time>"

    def annotated_label(self, sources: Iterable[Term]) -> Term:
        """The label as programs see it: its own annotations, a ``source`` for each source, and the ``url`` of the file."""
        span = self.node.span
        place = () if span is None else ((URL, String(f"file:{span.file.name}")),)
        told_by = tuple((SOURCE, source) for source in sources)
        return Annotated(self.label, annotation_set((*self.annotations, *told_by, *place)))

    def has_variable_trigger(self) -> bool:
        """Whether the plan is a candidate for all literals: its trigger is a variable, or the namespace of it is."""
        return self.trigger_functor() is None

    def trigger_functor(self) -> Term:
        """Functor of the trigger; None when it is a variable or its namespace is."""
        literal = self.node.trigger.literal
        if isinstance(literal, nodes.Variable) or isinstance(literal.namespace, nodes.Variable):
            return None
        return functor(literal.functor, len(literal.arguments), literal.negated, literal.namespace)


def _urgency(annotations: tuple[Term, ...]) -> int:
    """The greatest whole number from 0 on in an annotation ``urgency(N)``; the checker tells of what is none."""
    found = [
        a[1] for a in annotations if a.__class__ is tuple and a[0] is URGENCY and a[1].__class__ is float
    ]
    return int(max((number for number in found if number > 0 and number.is_integer()), default=0))


def _is_source(annotation: Term) -> bool:
    return functor_of(annotation) is SOURCE


def with_subplans(plan: Plan, number: int) -> Plan:
    """Give a plan its sub-plans, and those theirs."""
    for node in plan.node.subplans:
        inner = Plan(node, label_of(node, number))
        inner.scope = plan
        plan.subplans.append(with_subplans(inner, number))
    return plan


def label_of(node: nodes.Plan, number: int) -> Term:
    """The label of a plan; plans without one are given ``p__N``."""
    if node.label is None or isinstance(node.label, nodes.Variable):
        return atom(f"p__{number}")
    return lower_value(node.label)
