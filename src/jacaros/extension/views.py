"""What agent classes choose among: events, options, intentions, messages and percepts, to be looked at only.

Projects import them as ``jacaros.Event``, ``Intention``, ``Percept`` and ``Plan``, without the ending that tells them from
the classes of the mind.
"""

from typing import Any

from jacaros.bdi.state.act import Percept
from jacaros.bdi.state.event import Event, event_literal
from jacaros.bdi.state.intention import ANNOTATIONS, GOAL, PLAN, Frame, Intention
from jacaros.bdi.state.literals import literal_of
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.body.values import to_value
from jacaros.env.values import Structure
from jacaros.extension.literal import Literal
from jacaros.extension.literal import literal_of as as_literal
from jacaros.terms.substitution import resolve
from jacaros.terms.text import text
from jacaros.terms.values import Term


class PlanView:
    """A plan of an agent.

    Attributes:
        label: its label, such as ``p__3`` when it has none.
        annotations: those of the label, as Python values.
    """

    def __init__(self, plan: Plan) -> None:
        self.label = text(plan.label)
        self.annotations = tuple(to_value(resolve(annotation)) for annotation in plan.annotations)

    def annotation(self, functor: str, default: Any = None) -> Any:
        """The argument of an annotation: 3 for ``priority`` in ``@p[priority(3)]``; *default* without it.

        An annotation of several arguments gives a tuple, one without arguments True.
        """
        for found in self.annotations:
            if isinstance(found, Structure) and found.functor == functor:
                return found.arguments[0] if len(found.arguments) == 1 else found.arguments
            if found == functor:
                return True
        return default

    def __repr__(self) -> str:
        return f"Plan({self.label!r})"


class EventView:
    """Something that happened and may need a plan.

    Attributes:
        trigger: ``+``, ``-``, ``+!``, ``-!``, ``+?`` …
        literal: the belief or goal.
        intention: number of the intention that raised it; None when it came from outside.
    """

    def __init__(self, raw: Event) -> None:
        goal, intention, _, _ = raw
        kind = goal[0]
        self.trigger: str = kind.operator + kind.kind
        self.intention = intention.id if intention is not None else None
        self._raw = raw

    @property
    def literal(self) -> Literal:
        """The belief or goal, with its annotations."""
        return as_literal(resolve(event_literal(self._raw)))

    def __str__(self) -> str:
        return f"{self.trigger}{self.literal}"


class Option:
    """A plan that is applicable.

    Attributes:
        plan: the plan.
        bindings: the values that its variables have by now, by name; those without value are missing, and those
            that the plan does not use any more.
    """

    def __init__(self, plan: Plan, frame: Frame) -> None:
        # The values are taken now: they are undone when the next option is looked for.
        self.plan = PlanView(plan)
        self.bindings: dict[str, object] = {
            name: to_value(resolve(frame[slot]))
            for name, slot in plan.slots.items()
            if slot < len(frame) and frame[slot] is not None
        }

    def __repr__(self) -> str:
        return f"Option({self.plan.label!r}, {self.bindings!r})"


class IntentionView:
    """One thing that an agent is doing.

    Attributes:
        id: its number.
    """

    def __init__(self, raw: Intention) -> None:
        self.id = raw.id
        self._raw = raw

    @property
    def goals(self) -> tuple[Literal, ...]:
        """What it is for: its goals and events, the first one first."""
        return tuple(
            as_literal(resolve(literal_of(frame[GOAL], frame[ANNOTATIONS]))) for frame in self._raw.frames
        )

    @property
    def plans(self) -> tuple[PlanView, ...]:
        """The plans at work, the first one first."""
        return tuple(PlanView(frame[PLAN]) for frame in self._raw.frames)

    def __repr__(self) -> str:
        return f"Intention({self.id}, {[str(goal) for goal in self.goals]})"


class Message:
    """A message of another agent.

    Attributes:
        performative: ``tell``, ``achieve``, ``askOne`` …
        sender, receiver: names of agents.
        id: its number; ``in_reply_to`` is that of the question that it answers, or None.
    """

    def __init__(self, raw: SpeechAct) -> None:
        self.performative, self.sender, self.receiver = raw.performative, raw.sender, raw.receiver
        self.id, self.in_reply_to = raw.id, raw.in_reply_to
        self.raw = raw
        self._content: Term = raw.content

    @property
    def content(self) -> Any:
        """What is said: a `Literal`, or another Python value."""
        return value_of(resolve(self._content))

    def __str__(self) -> str:
        return f"{self.performative} from {self.sender}: {text(resolve(self._content))}"


class PerceptView:
    """Something noticed in the environment.

    Attributes:
        kind: ``add`` or ``remove`` for a belief, ``signal`` for an event without one.
    """

    def __init__(self, raw: Percept) -> None:
        self.kind = raw.kind
        self.raw = raw

    @property
    def literal(self) -> Literal:
        """What is perceived, with its annotations."""
        plain = as_literal(self.raw.literal)
        return plain.with_annotations(*(to_value(annotation) for annotation in self.raw.annotations))

    def __repr__(self) -> str:
        return f"Percept({self.kind!r}, {str(self.literal)!r})"


def value_of(term: Term) -> object:
    """A term as a Python value; atoms and structures as `Literal` with their annotations."""
    try:
        return as_literal(term)
    except ValueError:
        return to_value(term)
