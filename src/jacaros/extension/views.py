"""Views of agents for project code: options, plans and messages.

Projects import `PlanView` as ``jacaros.Plan``; the suffix distinguishes it from the class of the mind.
"""

from collections.abc import Callable
from typing import Any

from jacaros.asl.loader import parse_term
from jacaros.asl.lowering import fresh_names, lower
from jacaros.bdi.actions.agents import QUESTIONS
from jacaros.bdi.state.intention import Frame
from jacaros.bdi.state.plan import Plan
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.body.values import to_value
from jacaros.env.values import Structure
from jacaros.extension.literal import literal_of, term_of
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


def overridden(face: object, base: type, name: str) -> Callable[..., object] | None:
    """Return the method of an object whose class overrides that of *base*, or None."""
    if getattr(type(face), name) is getattr(base, name):
        return None
    method: Callable[..., object] = getattr(face, name)
    return method


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
        return literal_of(term)
    except ValueError:
        return to_value(term)
