"""Agents as Python code sees them, and the base class for your own."""

from collections.abc import Iterator, Sequence
from random import Random
from typing import Any

from jacaros.asl.loader import parse_formula
from jacaros.asl.lowering import Names, lower
from jacaros.bdi.mind import Mind
from jacaros.bdi.state.speech_act import SpeechAct
from jacaros.body.values import to_value
from jacaros.extension.literal import Literal, literal_of, literal_term, term_of
from jacaros.extension.views import Message, Option
from jacaros.terms.substitution import rename, resolve
from jacaros.terms.text import text
from jacaros.terms.unifier import undo


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
