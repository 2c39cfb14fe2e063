"""Agents and agent architectures as Python code sees them, and the classes to be subclassed for one's own."""

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
    """An agent.  Internal actions are given one; subclasses change how an agent works.

    A subclass is named in the project file: ``agents: bob agentClass my.Careful;`` in a ``.mas2j`` file,
    ``agent bob { ag-class: my.Careful }`` in a ``.jcm`` file.  It overrides what it wants to change among `init`,
    the selection functions (`select_event`, `select_option`, `select_intention`, `select_message`), `brf`, `buf`,
    `soc_acc` and `kill_acc`; what it does not override costs nothing.  An exception in one of them is told in the
    log, and the default is done in its place.
    """

    _mind: Mind

    # --- what may be overridden ----------------------------------------------------------------------------

    def init(self, *arguments: Any) -> None:
        """Called before the agent begins, with the arguments of ``agentClass my.Careful(1, fast)``."""

    def select_event(self, events: Sequence[EventView]) -> EventView:
        """Choose the event to be handled next; asked when there are several, oldest first."""
        return events[0]

    def select_option(self, options: Sequence[Option]) -> Option | None:
        """Choose among the applicable plans of an event, in the order of the program.

        None means that no plan is to be used.  Sub-plans are not asked about.
        """
        return options[0]

    def select_intention(self, intentions: Sequence[IntentionView]) -> IntentionView:
        """Choose the intention to make the next step; asked when there are several, in the order of their turns.

        An atomic intention goes first without asking.
        """
        return intentions[0]

    def select_message(self, messages: Sequence[Message]) -> Message:
        """Choose the message to be read next; asked when there are several, oldest first."""
        return messages[0]

    def brf(
        self, added: Literal | None, removed: Literal | None, intention: IntentionView | None
    ) -> bool | None:
        """Revise beliefs: asked before a plan or a message adds or removes one.

        Args:
            added, removed: one of them; what is removed may hold variables, unset `Out` objects.
            intention: whose step it is; None for a message.

        Returns:
            False to refuse: the step fails with ``error(belief_revision_failed)``, the message is passed over.
        """
        return True

    def buf(self, percepts: Sequence[PerceptView]) -> Sequence[PerceptView]:
        """Update beliefs: what is noticed of these changes in the environment; the others leave no trace."""
        return percepts

    def soc_acc(self, message: Message) -> bool:
        """Whether a message is acceptable; others are passed over.  Answers to own questions are not asked about."""
        return True

    def kill_acc(self, killer: str) -> bool:
        """Whether the agent called *killer* may end this one by ``.kill_agent``."""
        return True

    # --- what an agent offers ------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """Its name."""
        return self._mind.name

    @property
    def random(self) -> Random:
        """Its random numbers, which follow from the seed of the run."""
        return self._mind.architecture.random

    def now(self) -> float:
        """The time of the run's clock: seconds since the Unix epoch."""
        return self._mind.architecture.now()

    def print(self, *values: object) -> None:
        """Print a line as ``.print`` does."""
        shown = (value if isinstance(value, str) else text(term_of(value)) for value in values)
        self._mind.architecture.print("".join(str(value) for value in shown))

    def log(self, message: str, level: str = "info") -> None:
        """Tell people something; *level* is ``debug``, ``info``, ``warning`` or ``error``."""
        self._mind.architecture.log(level, message)

    def beliefs(self, functor: str | None = None, arity: int | None = None) -> Iterator[Literal]:
        """Its beliefs (rules are not among them), perhaps only those of one name and number of arguments."""
        for term in list(self._mind.beliefs.literals()):
            belief = literal_of(term)
            if functor in (None, belief.functor) and arity in (None, belief.arity):
                yield belief

    def ask(self, query: str) -> Iterator[dict[str, Any]]:
        """The answers of a query such as ``"path(X, Y) & Y > 3"``: the values of its variables by name.

        All of them are looked for at once.

        Raises:
            AslError: the text is no query.
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
        """Whether a query has an answer.

        Raises:
            AslError: the text is no query.
        """
        return next(self.ask(query), None) is not None

    def add_belief(self, belief: object) -> None:
        """Believe something: a text such as ``"position(3, kitchen)"``, or a `Literal`.

        Without a source it is ``source(self)``.  The event comes from outside of all intentions.

        Raises:
            AslError, ValueError: it is no literal.
        """
        self._mind.tell(literal_term(belief))
        self._mind.architecture.ready()

    def remove_belief(self, belief: object) -> bool:
        """Take a source (``self`` unless one is named) off a belief; False when it is not held.

        Raises:
            AslError, ValueError: it is no literal.
        """
        found = self._mind.untell(literal_term(belief))
        self._mind.architecture.ready()
        return found

    def achieve(self, goal: object) -> None:
        """Adopt a goal, as an intention of its own.

        Raises:
            AslError, ValueError: it is no literal.
        """
        self._mind.post_goal(literal_term(goal))

    def send(self, receiver: str, performative: str, content: object) -> bool:
        """Send a message: a text that is a literal, or another Python value; False when there is no such agent.

        Raises:
            AslError: the text is no literal.
        """
        mind = self._mind
        term = literal_term(content) if isinstance(content, str) else term_of(content)
        message = SpeechAct(performative, mind.name, receiver, rename(term), mind.next_message_id())
        return mind.architecture.send(message)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({self.name!r})"


def agent_of(mind: Mind) -> Agent:
    """What Python code sees of a mind; always the same object."""
    if mind.face is None:
        give_face(mind, Agent())
    assert isinstance(mind.face, Agent)
    return mind.face


def give_face(mind: Mind, face: Agent) -> None:
    """Let Python code see *face* for a mind."""
    face._mind = mind
    mind.face = face


def overridden(face: Agent, name: str) -> Callable[..., object] | None:
    """The method of a subclass that overrides the one of `Agent`, or None."""
    if getattr(type(face), name) is getattr(Agent, name):
        return None
    method: Callable[..., object] = getattr(face, name)
    return method


# --- architectures: what stands between a mind and its surroundings ------------------------------------------


class Action:
    """An external action that an agent wants to be done.

    Attributes:
        functor: its name.
        arguments: Python values; unbound variables are `Out` objects, and what is set there is the result.
        annotations: Python values.
    """

    def __init__(self, raw: Act) -> None:
        self.raw = raw
        self._outputs: Outputs = []
        self.functor = symbol_name(raw.functor)
        self.arguments = tuple(to_value(resolve(a), self._outputs) for a in raw.arguments)
        self.annotations = tuple(to_value(resolve(a)) for a in raw.annotations)

    def outputs(self) -> tuple[tuple[Var, Term], ...]:
        """The variables for which there are results, with the terms for them."""
        return tuple((variable, term_of(out.value)) for variable, out in self._outputs if out.is_set)

    def completion(self, success: bool, message: str = "") -> Completion:
        """How the action ended, as the mind takes it."""
        told = ((ERROR_MSG, String(message)),) if message else ()
        return Completion(success, self.outputs() if success else (), told)

    def __str__(self) -> str:
        return str(Literal(self.functor, tuple(None if isinstance(a, Out) else a for a in self.arguments)))


class AgentArch:
    """How an agent perceives, acts, and exchanges messages; to be subclassed.

    A subclass is named in the project file: ``agents: bob agentArchClass my.Arch;`` in a ``.mas2j`` file,
    ``agent bob { ag-arch: my.Arch }`` in a ``.jcm`` file.  Several may be named: the last one is asked first, and hands
    on by ``super()``.

    Attributes:
        agent: whose architecture it is.
    """

    agent: Agent
    following: "AgentArch"

    def init(self, *arguments: Any) -> None:
        """Called before the agent begins, with the arguments of ``agentArchClass my.Arch(1)``."""

    def perceive(self) -> Iterable[object] | None:
        """All that is perceived through this architecture now: texts such as ``"light(3)"``, or `Literal` objects.

        Called before each reasoning cycle; None says that nothing has changed.  What is there for the first time
        becomes a belief, what is there no more is forgotten.  An agent without anything to do makes no cycles: see `wake`.
        """
        return None

    def act(self, action: Action) -> bool | Awaitable[bool | None] | None:
        """Do an external action.

        Returns:
            True when it is done (what was set in `Out` arguments is its result), False when it failed.  A coroutine
            (``async def act``) may take its time.  ``super().act(action)`` leaves it to the environment.
        """
        return self.following.act(action)

    def send(self, message: Message) -> bool:
        """Send a message; False when it cannot be delivered."""
        return self.following.send(message)

    def check_mail(self, message: Message) -> bool:
        """Look at a message that came; False throws it away."""
        return self.following.check_mail(message)

    def wake(self) -> None:
        """Give the agent a turn soon, because there is something new to perceive."""
        self.following.wake()

    def stop(self) -> None:
        """Called when the agent ends."""


class Perception:
    """What one architecture perceives, as changes since the last time."""

    def __init__(self) -> None:
        self._held: dict[Term, Percept] = {}

    def changes(self, found: Iterable[object]) -> list[Percept]:
        """The percepts to be added and removed, so that *found* is all there is."""
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
