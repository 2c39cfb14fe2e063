"""Views of agents for project code: events, options, intentions, messages and percepts.

Projects import the views as ``jacaros.Event``, ``Intention``, ``Percept`` and ``Plan``, without the suffix that
distinguishes them from the classes of the mind.
"""

from collections.abc import Callable
from typing import Any

from jacaros.asl.loader import parse_term
from jacaros.asl.lowering import fresh_names, lower
from jacaros.bdi.actions.agents import QUESTIONS
from jacaros.bdi.state.act import Percept
from jacaros.bdi.state.event import Event, event_literal
from jacaros.bdi.state.intention import ANNOTATIONS, GOAL, PLAN, Frame, Intention
from jacaros.bdi.state.literals import literal_of
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.body.values import to_value
from jacaros.env.values import Structure
from jacaros.extension.literal import Literal, term_of
from jacaros.extension.literal import literal_of as as_literal
from jacaros.terms.substitution import resolve
from jacaros.terms.text import text
from jacaros.terms.values import PLAIN, String, Term, functor_of, is_list, list_items, make_list

_ABOUT_PLANS = frozenset({"tellHow", "untellHow", "askHow", "tell-how", "untell-how", "ask-how"})
"""Performatives whose content may be the text of a plan, a string as in AgentSpeak."""


class PlanView:
    """A plan of an agent.

    Attributes:
        label: its label, such as ``p__3`` if none is written.
        annotations: those of the label, as Python values.
    """

    def __init__(self, plan: Plan) -> None:
        self.label = text(plan.label)
        self.annotations = tuple(to_value(resolve(annotation)) for annotation in plan.annotations)

    def annotation(self, functor: str, default: Any = None) -> Any:
        """Return the argument of an annotation: 3 for ``priority`` in ``@p[priority(3)]``; *default* without it.

        Several arguments are returned as a tuple; an annotation without arguments returns True.
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
        intention: number of the intention that raised it; None for an external event.
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
    """An applicable plan.

    Attributes:
        plan: the plan.
        bindings: values by variable name; unbound variables and those that the plan does not use again are missing.
    """

    def __init__(self, plan: Plan, frame: Frame) -> None:
        # Copy the values now: the search for the next option undoes the bindings.
        self.plan = PlanView(plan)
        self.bindings: dict[str, object] = {
            name: to_value(resolve(frame[slot]))
            for name, slot in plan.slots.items()
            if slot < len(frame) and frame[slot] is not None
        }

    def __repr__(self) -> str:
        return f"Option({self.plan.label!r}, {self.bindings!r})"


class IntentionView:
    """An intention of an agent.

    Attributes:
        id: its number.
    """

    def __init__(self, raw: Intention) -> None:
        self.id = raw.id
        self._raw = raw

    @property
    def goals(self) -> tuple[Literal, ...]:
        """Its goals and events, the first one first."""
        return tuple(
            as_literal(resolve(literal_of(frame[GOAL], frame[ANNOTATIONS]))) for frame in self._raw.frames
        )

    @property
    def plans(self) -> tuple[PlanView, ...]:
        """Its running plans, the first one first."""
        return tuple(PlanView(frame[PLAN]) for frame in self._raw.frames)

    def __repr__(self) -> str:
        return f"Intention({self.id}, {[str(goal) for goal in self.goals]})"


class Message:
    """A message from another agent.

    Attributes:
        performative: ``tell``, ``achieve``, ``askOne`` …
        sender, receiver: names of agents.
        id: its number; ``in_reply_to`` is that of the question that it answers, or None.
    """

    def __init__(self, raw: SpeechAct) -> None:
        self.performative, self.sender, self.receiver = raw.performative, raw.sender, raw.receiver
        self.id, self.in_reply_to = raw.id, raw.in_reply_to
        self.raw = raw

    @property
    def content(self) -> Any:
        """The content: a `Literal`, or another Python value."""
        return _value_of(resolve(self.raw.content))

    def __str__(self) -> str:
        return f"{self.performative} from {self.sender}: {text(resolve(self.raw.content))}"


class ReceivedMessage(Message):
    """A message received by an agent written in Python, which may reply.

    Attributes:
        answered: True after a call of `reply`.
    """

    def __init__(self, raw: SpeechAct, answer: Callable[[SpeechAct, str, Term], None]) -> None:
        super().__init__(raw)
        self._answer = answer
        self.answered = False

    @property
    def content(self) -> Any:
        """The content: a `Literal`, another Python value, or a list of them; variables are `Out` objects."""
        return heard(self.raw.content)

    @property
    def is_question(self) -> bool:
        """Whether the sender expects an answer."""
        return self.performative in QUESTIONS

    def reply(self, content: object, performative: str = "tell") -> None:
        """Reply to the message.

        Args:
            content: AgentSpeak as text, a `Literal`, or another value; None as reply to a question means that
                there is no answer. The answer to ``askAll`` is a list.
            performative: of the reply.

        Raises:
            AslError: the text is not AgentSpeak.
            UnknownAgent: the sender no longer exists.
        """
        self.answered = True
        if content is None:
            self._answer(self.raw, "untell", self.raw.content)
        else:
            self._answer(self.raw, performative, content_of(content, self.performative))


class PerceptView:
    """A change noticed in the environment.

    Attributes:
        kind: ``add`` or ``remove`` for a belief, ``signal`` for an event without one.
    """

    def __init__(self, raw: Percept) -> None:
        self.kind = raw.kind
        self.raw = raw

    @property
    def literal(self) -> Literal:
        """The perceived literal, with its annotations."""
        plain = as_literal(self.raw.literal)
        return plain.with_annotations(*(to_value(annotation) for annotation in self.raw.annotations))

    def __repr__(self) -> str:
        return f"Percept({self.kind!r}, {str(self.literal)!r})"


def content_of(value: object, performative: str = "tell") -> Term:
    """Convert a Python value to the content of a message; texts are parsed as AgentSpeak, except texts of plans.

    Raises:
        AslError: a text is not a term.
    """
    if isinstance(value, str) and performative in _ABOUT_PLANS:
        return String(value)
    if type(value) is str:
        return resolve(lower(parse_term(value), fresh_names()))
    if isinstance(value, (list, tuple)) and not hasattr(value, "_fields"):
        return make_list([content_of(item, performative) for item in value])
    return term_of(value)


def heard(content: Term) -> object:
    """Convert the content of a message to Python: a `Literal`, another value such as the text of a plan, or a list."""
    content = resolve(content)
    if is_list(content):
        return [heard(item) for item in list_items(content)]
    symbol = functor_of(content)
    return _value_of(content) if symbol is not None and symbol.kind == PLAIN else to_value(content)


def _value_of(term: Term) -> object:
    """Convert a term to a Python value; atoms and structures become `Literal` with their annotations."""
    try:
        return as_literal(term)
    except ValueError:
        return to_value(term)
