"""Agents and agent architectures as Python code sees them, and the base classes for your own."""

from collections.abc import Awaitable, Callable, Iterable, Iterator, Sequence
from random import Random
from typing import Any

from jacaros.asl.loader import parse_formula
from jacaros.asl.lowering import Names, lower
from jacaros.bdi.explaining.failure_reason import ERROR_MSG
from jacaros.bdi.mind import Mind
from jacaros.bdi.state.act import Act, Completion, Percept
from jacaros.bdi.state.belief_base import parts
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.body.values import Outputs, symbol_name, to_value
from jacaros.env.values import Out
from jacaros.extension.literal import Literal, literal_of, literal_term, term_of
from jacaros.extension.views import EventView, IntentionView, Message, Option, PerceptView
from jacaros.terms.order import annotation_set
from jacaros.terms.substitution import rename, resolve
from jacaros.terms.text import text
from jacaros.terms.unifier import undo
from jacaros.terms.values import SOURCE_PERCEPT, String, Term, Var


class Agent:
    """An agent. Internal actions receive one; subclasses change how an agent works.

    A subclass is named in the project file: ``agents: bob agentClass my.Careful;`` in a ``.mas2j`` file, ``agent bob {
    ag-class: my.Careful }`` in a ``.jcm`` file. It overrides any of `init`, the selection functions (`select_event`,
    `select_option`, `select_intention`, `select_message`), `brf`, `buf`, `soc_acc` and `kill_acc`. Methods that are not
    overridden have no cost. An exception in a method is logged, and the default is used instead.
    """

    _mind: Mind

    # --- what may be overridden ----------------------------------------------------------------------------

    def init(self, *arguments: Any) -> None:
        """Called before the agent starts, with the arguments of ``agentClass my.Careful(1, fast)``."""

    def select_event(self, events: Sequence[EventView]) -> EventView:
        """Choose the event to handle next; called if there are several, oldest first."""
        return events[0]

    def select_option(self, options: Sequence[Option]) -> Option | None:
        """Choose one of the applicable plans of an event, in program order.

        Return None to use no plan. Not called for sub-plans.
        """
        return options[0]

    def select_intention(self, intentions: Sequence[IntentionView]) -> IntentionView:
        """Choose the intention that runs its next step; called if there are several, in the order of their turns.

        Not called for an atomic intention, which always goes first.
        """
        return intentions[0]

    def select_message(self, messages: Sequence[Message]) -> Message:
        """Choose the message to read next; called if there are several, oldest first."""
        return messages[0]

    def brf(
        self, added: Literal | None, removed: Literal | None, intention: IntentionView | None
    ) -> bool | None:
        """Revise beliefs: called before a plan or a message adds or removes one.

        Args:
            added, removed: exactly one of them is given; a removed literal may contain variables, unset `Out` objects.
            intention: the intention whose step it is; None for a message.

        Returns:
            False to refuse: the step fails with ``error(belief_revision_failed)``, a message is ignored.
        """
        return True

    def buf(self, percepts: Sequence[PerceptView]) -> Sequence[PerceptView]:
        """Update beliefs: return those of these changes of the environment that the agent notices; the others are
        ignored.
        """
        return percepts

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
            if functor in (None, belief.functor) and arity in (None, belief.arity):
                yield belief

    def ask(self, query: str) -> Iterator[dict[str, Any]]:
        """Iterate over the answers of a query such as ``"path(X, Y) & Y > 3"``: values of its variables by name.

        All answers are found before the first one is returned.

        Raises:
            AslError: the text is not a query.
        """
        mind = self._mind
        names = Names()
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


def overridden(face: Agent, name: str) -> Callable[..., object] | None:
    """Return the method of a subclass that overrides the one of `Agent`, or None."""
    if getattr(type(face), name) is getattr(Agent, name):
        return None
    method: Callable[..., object] = getattr(face, name)
    return method


# --- architectures: between a mind and its environment
# -------------------------------------------------------


class Action:
    """An external action that an agent performs.

    Attributes:
        functor: its name.
        arguments: Python values; unbound variables are `Out` objects, whose values become results.
        annotations: Python values.
    """

    def __init__(self, raw: Act) -> None:
        self.raw = raw
        self._outputs: Outputs = []
        self.functor = symbol_name(raw.functor)
        self.arguments = tuple(to_value(resolve(a), self._outputs) for a in raw.arguments)
        self.annotations = tuple(to_value(resolve(a)) for a in raw.annotations)

    def outputs(self) -> tuple[tuple[Var, Term], ...]:
        """The variables that have results, with the terms of the results."""
        return tuple((variable, term_of(out.value)) for variable, out in self._outputs if out.is_set)

    def completion(self, success: bool, message: str = "") -> Completion:
        """Return how the action ended, in the form that the mind expects."""
        told = ((ERROR_MSG, String(message)),) if message else ()
        return Completion(success, self.outputs() if success else (), told)

    def __str__(self) -> str:
        return str(Literal(self.functor, tuple(None if isinstance(a, Out) else a for a in self.arguments)))


class AgentArch:
    """How an agent perceives, acts, and exchanges messages; to be subclassed.

    A subclass is named in the project file: ``agents: bob agentArchClass my.Arch;`` in a ``.mas2j`` file, ``agent bob {
    ag-arch: my.Arch }`` in a ``.jcm`` file. With several classes, the last one is called first, and calls the next with
    ``super()``.

    Attributes:
        agent: the agent that the architecture belongs to.
    """

    agent: Agent
    following: "AgentArch"

    def init(self, *arguments: Any) -> None:
        """Called before the agent starts, with the arguments of ``agentArchClass my.Arch(1)``."""

    def perceive(self) -> Iterable[object] | None:
        """Return all that is perceived through this architecture now: texts such as ``"light(3)"``, or `Literal`
        objects.

        Called before each reasoning cycle; None means that nothing has changed. New percepts become beliefs, missing
        ones are removed. An idle agent makes no cycles: see `wake`.
        """
        return None

    def act(self, action: Action) -> bool | Awaitable[bool | None] | None:
        """Perform an external action.

        Returns:
            True if it has succeeded (values of `Out` arguments are its results), False if it has failed. A coroutine
            (``async def act``) may take time. ``super().act(action)`` leaves the action to the environment.
        """
        return self.following.act(action)

    def send(self, message: Message) -> bool:
        """Send a message; return False if it cannot be delivered."""
        return self.following.send(message)

    def check_mail(self, message: Message) -> bool:
        """Inspect an incoming message; return False to discard it."""
        return self.following.check_mail(message)

    def wake(self) -> None:
        """Wake the agent, because there is something new to perceive."""
        self.following.wake()

    def stop(self) -> None:
        """Called when the agent ends."""


class Perception:
    """The percepts of one architecture, as changes since the last time."""

    def __init__(self) -> None:
        self._held: dict[Term, Percept] = {}

    def changes(self, found: Iterable[object]) -> list[Percept]:
        """Return the percepts to add and remove so that *found* are all percepts."""
        now: dict[Term, Percept] = {}
        for item in found:
            symbol, row, annotations = parts(literal_term(item))
            assert symbol is not None
            literal = (symbol, *row) if row else symbol
            now[literal] = Percept("add", literal, annotation_set((*annotations, SOURCE_PERCEPT)))
        gone = [
            Percept("remove", held.literal, held.annotations)
            for key, held in self._held.items()
            if key not in now
        ]
        new = [percept for key, percept in now.items() if key not in self._held]
        self._held = {key: self._held.get(key, percept) for key, percept in now.items()}
        return gone + new
