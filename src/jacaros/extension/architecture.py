"""Agent architectures of a project: what stands between a mind and its surroundings."""

from collections.abc import Awaitable, Iterable
from typing import Any

from jacaros.bdi.explaining.failure_reason import ERROR_MSG
from jacaros.bdi.state.act import Act, Completion, Percept
from jacaros.bdi.state.belief_base import parts
from jacaros.body.values import Outputs, symbol_name, to_value
from jacaros.env.values import Out
from jacaros.extension.agent import Agent
from jacaros.extension.literal import Literal, literal_term, term_of
from jacaros.extension.views import Message
from jacaros.terms.order import annotation_set
from jacaros.terms.substitution import resolve
from jacaros.terms.values import SOURCE_PERCEPT, String, Term, Var


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
