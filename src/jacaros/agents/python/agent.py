"""Agents as Python code sees them, and the base class for your own."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from random import Random
from typing import Any

from jacaros.agents.body.values import UNKEPT, Outputs, symbol_name, to_term, to_value
from jacaros.agents.language.loader import parse_formula, parse_literal, parse_term
from jacaros.agents.language.lowering import Variables, fresh_names, lower
from jacaros.agents.mind.actions.agents import QUESTIONS
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.state.act import SpeechAct
from jacaros.agents.mind.state.intention import Frame
from jacaros.agents.mind.state.plan import Plan
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import rename, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import undo
from jacaros.agents.terms.values import (
    PLAIN,
    Annotated,
    String,
    Term,
    annotations_of,
    arguments_of,
    functor,
    functor_of,
    is_list,
    list_items,
    make_list,
)
from jacaros.artifacts.env.values import Atom, Structure

# Beliefs and goals as Python code sees them.


@dataclass(frozen=True, slots=True)
class Literal:
    """A literal such as ``~ns::position(3, kitchen)[source(bob)]``.

    Attributes:
        functor: the name.
        arguments: Python values, see the table in ``docs/reference/python_extension.md``.
        annotations: Python values; structures such as ``source(bob)`` are `Structure` objects.
        negated: whether it begins with ``~``.
        namespace: its namespace; None for the default one.
    """

    __record__ = False

    functor: str
    arguments: tuple[object, ...] = ()
    annotations: tuple[object, ...] = ()
    negated: bool = False
    namespace: str | None = None

    @property
    def sources(self) -> tuple[str, ...]:
        """Its sources: ``self``, ``percept`` and names of agents."""
        return tuple(
            str(annotation.arguments[0])
            for annotation in self.annotations
            if isinstance(annotation, Structure) and annotation.functor == "source" and annotation.arguments
        )

    def __str__(self) -> str:
        return text(term_of(self))


def literal_of(term: Term, outputs: Outputs | None = None) -> Literal:
    """Convert a term to a literal for Python code; *outputs* collects its unbound variables.

    Raises:
        ValueError: the term is not a literal.
    """
    symbol = functor_of(term)
    if symbol is None:
        raise ValueError(f"not a literal: {text(term)}")
    plain = functor(symbol.name, 0)
    return Literal(
        symbol_name(plain),
        tuple(to_value(resolve(argument), outputs) for argument in arguments_of(term)),
        tuple(to_value(resolve(annotation), outputs) for annotation in annotations_of(term)),
        symbol.negated,
        symbol.namespace,
    )


def term_of(value: object) -> Term:
    """Convert a Python value to a term; a `Literal` keeps its annotations."""
    if not isinstance(value, Literal):
        return to_term(value, UNKEPT)
    name = f"~{value.functor}" if value.negated else value.functor
    if value.namespace is not None:
        name = f"{value.namespace}::{name}"
    plain = term_of(Structure(name, value.arguments) if value.arguments else Atom(name))
    if not value.annotations:
        return plain
    return Annotated(plain, annotation_set(tuple(map(term_of, value.annotations))))


def literal_term(value: object) -> Term:
    """Convert a literal from Python code to a term: a `Literal`, `Structure`, `Atom`, or a text.

    Raises:
        AslError: the text is not a literal.
        ValueError: the value has another type.
    """
    if isinstance(value, (Literal, Structure, Atom)):
        return term_of(value)
    if isinstance(value, str):
        return resolve(lower(parse_literal(value), fresh_names()))
    raise ValueError(f"not a literal: {value!r}; give a text such as 'position(3, kitchen)', or a Literal")


# Views of agents for project code: options, plans and messages.
#
# Projects import `PlanView` as ``jacaros.Plan``; the suffix distinguishes it from the class of the mind.


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
        """The content: a `Literal`, another Python value, or a list of them; variables are `Out` objects."""
        return heard(self.raw.content)

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
    return literal_of(content) if symbol is not None and symbol.kind == PLAIN else to_value(content)


class Agent:
    """An agent. Internal actions receive one; subclasses change how an agent works.

    A subclass is named in the project file: ``agents: bob agentClass my.Careful;`` in a ``.mas2j`` file, ``agent bob {
    ag-class: my.Careful }`` in a ``.jcm`` file. It overrides any of `init`, `select_option`, `soc_acc` and `kill_acc`.
    Methods that are not overridden have no cost. An exception in a method is logged, and the default is used instead.
    """

    _mind: Mind

    # --- what may be overridden ----------------------------------------------------------------------------

    def init(self, *arguments: Any) -> None:
        """Called before the agent starts, with the arguments of ``agentClass my.Careful(1, fast)``."""

    def select_option(self, options: Sequence[Option]) -> Option | None:
        """Choose one of the applicable plans of an event, in program order.

        Return None to use no plan. Not called for sub-plans.
        """
        return options[0]

    def soc_acc(self, message: Message) -> bool:
        """Return whether to accept a message; others are ignored. Not called for answers to the agent's own questions."""
        return True

    def kill_acc(self, killer: str) -> bool:
        """Return whether the agent named *killer* may end this one with ``.kill_agent``."""
        return True

    # --- what an agent provides ----------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """The agent's name."""
        return self._mind.name

    @property
    def random(self) -> Random:
        """The agent's random number generator, seeded by the run."""
        return self._mind.architecture.random

    def now(self) -> float:
        """Return the time of the run's clock, in seconds since the Unix epoch."""
        return self._mind.architecture.now()

    def print(self, *values: object) -> None:
        """Print a line, as ``.print`` does."""
        shown = (value if isinstance(value, str) else text(term_of(value)) for value in values)
        self._mind.architecture.print("".join(str(value) for value in shown))

    def log(self, message: str, level: str = "info") -> None:
        """Log a message; *level* is ``debug``, ``info``, ``warning`` or ``error``."""
        self._mind.architecture.log(level, message)

    def beliefs(self, functor: str | None = None, arity: int | None = None) -> Iterator[Literal]:
        """Iterate over the agent's beliefs (rules are not included), optionally only those of a name and number of
        arguments.
        """
        for term in list(self._mind.beliefs.literals()):
            belief = literal_of(term)
            if functor in (None, belief.functor) and arity in (None, len(belief.arguments)):
                yield belief

    def ask(self, query: str) -> Iterator[dict[str, Any]]:
        """Iterate over the answers of a query such as ``"path(X, Y) & Y > 3"``: values of its variables by name.

        All answers are found before the first one is returned.

        Raises:
            AslError: the text is not a query.
        """
        mind = self._mind
        names = Variables()
        formula = lower(parse_formula(query), names.__getitem__)
        mark = len(mind.trail)
        answers = [
            {name: to_value(resolve(variable)) for name, variable in names.items() if name[:1] != "_"}
            for _ in mind.context.answers(formula)
        ]
        undo(mind.trail, mark)
        yield from answers

    def believes(self, query: str) -> bool:
        """Return whether a query has an answer.

        Raises:
            AslError: the text is not a query.
        """
        return next(self.ask(query), None) is not None

    def add_belief(self, belief: object) -> None:
        """Add a belief: a text such as ``"position(3, kitchen)"``, or a `Literal`.

        Without a source, ``source(self)`` is added. The event is external.

        Raises:
            AslError, ValueError: it is not a literal.
        """
        self._mind.tell(literal_term(belief))
        self._mind.architecture.ready()

    def remove_belief(self, belief: object) -> bool:
        """Remove a source (default ``self``) of a belief; return False if the agent does not have it.

        Raises:
            AslError, ValueError: it is not a literal.
        """
        found = self._mind.untell(literal_term(belief))
        self._mind.architecture.ready()
        return found

    def achieve(self, goal: object) -> None:
        """Adopt a goal in an intention of its own.

        Raises:
            AslError, ValueError: it is not a literal.
        """
        self._mind.post_goal(literal_term(goal))

    def send(self, receiver: str, performative: str, content: object) -> bool:
        """Send a message: a literal as text, or another Python value. Return False if the receiver does not exist.

        Raises:
            AslError: the text is not a literal.
        """
        mind = self._mind
        term = literal_term(content) if isinstance(content, str) else term_of(content)
        message = SpeechAct(performative, mind.name, receiver, rename(term), mind.next_message_id())
        return mind.architecture.send(message)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r})"


def agent_of(mind: Mind) -> Agent:
    """Return the `Agent` of a mind; always the same object."""
    if mind.face is None:
        give_face(mind, Agent())
    assert isinstance(mind.face, Agent)
    return mind.face


def give_face(mind: Mind, face: Agent) -> None:
    """Make *face* the `Agent` of a mind."""
    face._mind = mind
    mind.face = face
