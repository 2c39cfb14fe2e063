"""What passes between a mind and its host: acts and how they ended, percepts, messages, and the ports."""

from collections.abc import Callable, Coroutine, Mapping, Sequence
from dataclasses import dataclass, field
from random import Random
from typing import Any, Protocol

from jacaros.agents.mind.state.intention import Frame, Intention
from jacaros.agents.mind.state.triggers import EventAnnotations, Goal
from jacaros.agents.terms.values import Functor, Term, functor
from jacaros.runtime.trace import Cause

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


# Messages between agents.


@dataclass(slots=True, eq=False)
class SpeechAct:
    """A message between agents (KQML). Never changed once it has been sent.

    Attributes:
        performative: ``tell``, ``achieve``, ``askOne`` … in Jason's spelling.
        sender: name of the sending agent, ``self`` in messages to oneself.
        receiver: name of the receiving agent.
        content: a term; a copy, so that agents share no variables.
        _id: unique in the system; or the number of the message among those of its sender, from which `id` is made.
        in_reply_to: id of the question that this message answers, or None.
        flat: the content is known to be an atom, or a structure of atoms, numbers and strings: it need not be
            copied or searched; False if this has not been checked.
    """

    performative: str
    sender: str
    receiver: str
    content: Term
    _id: str | int
    in_reply_to: str | None = None
    flat: bool = False

    @property
    def id(self) -> str:
        """Id of the message, unique in the system, such as ``mid7_ann``."""
        if isinstance(self._id, int):
            self._id = message_id(self._id, self.receiver if self.sender == "self" else self.sender)
        return str(self._id)

    def with_content(self, content: Term) -> "SpeechAct":
        """Return the same message with another content."""
        return SpeechAct(self.performative, self.sender, self.receiver, content, self._id, self.in_reply_to)


def message_id(number: int, sender: str) -> str:
    """Return the id of a message; numbers are unique for its sender."""
    return f"mid{number}_{sender}"


# The ports of a mind: to its host (Jason's agent architecture), and to the observer of its reasons.


class MindObserver(Protocol):
    """Hears what one mind does and why; it changes nothing and raises nothing."""

    def selected(
        self,
        goal: Goal,
        annotations: EventAnnotations,
        intention: Intention | None,
        frame: Frame | None,
        cause: Cause | None,
    ) -> Cause | None:
        """Hear which plan was taken for a goal or event.

        Args:
            goal: as it was before plans were tried.
            annotations: of the goal.
            intention: that posted it, None for an event from outside.
            frame: of the plan that was taken, None when no plan is applicable.
            cause: of an event from outside.

        Returns:
            the cause of what the plan does.
        """

    def cause(self) -> Cause | None:
        """Return what led to the step, or the message, that the mind is at; None for neither."""

    def place(self, intention: Intention) -> Mapping[str, Any]:
        """Return plan, file and line of the step that an intention is at."""

    def changed(
        self,
        operator: str,
        symbol: Functor,
        row: tuple[Term, ...],
        annotations: tuple[Term, ...],
        cause: Cause | None,
    ) -> None:
        """Hear of a belief that was added (``+``) or deleted (``-``); *annotations* came or went."""

    def reads(self, message: SpeechAct | None) -> None:
        """Hear that the mind begins to read a message, and (None) that it has read it."""

    def plans_changed(self) -> None:
        """Hear that plans came or went."""


class Callers(Protocol):
    """Hears what an agent tells the callers outside who gave it goals; it changes nothing and raises nothing."""

    def accepted(self, intention: Intention) -> None:
        """Hear that the goal of an intention is accepted."""

    def progressed(self, intention: Intention, fraction: float, note: str) -> None:
        """Hear how far the goal of an intention is, from 0 to 1."""

    def announced(self, event: Term) -> None:
        """Hear of an event that the program offers."""


# The port of a mind to its host (Jason's agent architecture).
#
# A mind does no input or output of its own. It gets input through `Mind.receive`, `Mind.perceive` and `Mind.complete`, and
# reaches out through this port alone.


class TimerHandle(Protocol):
    """A pending call."""

    def cancel(self) -> None:
        """Cancel the call."""


class Activity:
    """Counts what will give an agent something to do, so that a run can detect idleness.

    Worlds, batteries and processes of artifacts do not count: they never end.
    """

    def __init__(self) -> None:
        self.pending = 0

    def begin(self) -> None:
        """Something has begun."""
        self.pending += 1

    def end(self) -> None:
        """It has ended, or was cancelled."""
        self.pending -= 1


class Services(Protocol):
    """The directory facilitator: which agents provide which services."""

    def register(self, name: str, service: str) -> None:
        """Register an agent as provider of a service, and notify the subscribers."""

    def deregister(self, name: str, service: str) -> None:
        """Deregister an agent as provider of a service."""

    def providers(self, service: str) -> Sequence[str]:
        """Return the known providers of a service, in the order of registration."""

    def subscribe(self, name: str, service: str) -> None:
        """Subscribe an agent to all providers of a service, by messages."""


class AgentSystem(Protocol):
    """What agents of every kind ask of the agent system."""

    @property
    def services(self) -> Services:
        """The directory facilitator."""

    def agent_names(self) -> Sequence[str]:
        """Return the names of all agents of the system, in order of creation."""

    def create_agent(self, name: str, source: str | None, classes: Mapping[str, str]) -> str | None:
        """Create and start an agent (from the program file *source*, default NAME.asl). Return its final name, or None
        after logging the reason.

        *classes* are its classes, by ``agentClass``, ``agentArchClass`` and ``beliefBaseClass``.
        """

    def clone_agent(self, original: str, name: str) -> str | None:
        """Create an agent with a copy of another's mind. Return its final name, or None after logging the reason."""

    def kill_agent(self, name: str, delay: float, killer: str) -> bool:
        """End an agent on behalf of another, *delay* seconds after announcing it.

        Return False if it does not exist or refuses.
        """

    def explain(self, question: str, agent: str) -> Mapping[str, Any]:
        """Answer a question of an agent about the run so far, as plain data; see `Explanation.data` in
        `jacaros.look.why.explanation`.

        Raises:
            UsageError: the question is invalid.
        """

    def read_program(self, path: str) -> tuple[str, str]:
        """Return the name and text of a program file (for ``.include``).

        Raises:
            FileNotFoundError: it does not exist.
        """

    def list_files(self, folder: str) -> Sequence[str]:
        """Return the files in a folder and its subfolders, as sorted paths that begin with *folder*.

        Raises:
            OSError: the folder cannot be read.
        """

    def write_file(self, path: str, text: str) -> None:
        """Write a text file, replacing its contents. A relative path is relative to the project's folder.

        Raises:
            OSError: the file cannot be written.
        """


class Architecture(Protocol):
    """What a mind needs from its host. No call may re-enter the agent before it returns."""

    @property
    def system(self) -> AgentSystem:
        """The system of the agent."""

    @property
    def random(self) -> Random:
        """The agent's own random number generator, seeded by the run."""

    def now(self) -> float:
        """Return seconds since the Unix epoch on the run's clock."""

    def print(self, text: str) -> None:
        """Print a line of the program's output."""

    def log(self, level: str, text: str) -> None:
        """Log a message; *level* is ``debug``, ``info``, ``warning`` or ``error``."""

    def stop_system(self, delay: float, exit_code: int) -> None:
        """End the run after *delay* seconds."""

    def ready(self) -> None:
        """Report that the agent has work to do: `Mind.run` must be called soon."""

    def set_timer(self, delay: float, callback: Callable[[], None]) -> TimerHandle:
        """Call *callback* after *delay* seconds of the run's clock."""

    def start_coroutine(
        self, coroutine: Coroutine[Any, Any, Any], ended: Callable[[object, BaseException | None], None]
    ) -> TimerHandle:
        """Run a coroutine of the project's Python code concurrently with the agent.

        *ended* is called with its result, or the exception that ended it; not after it was cancelled.
        """

    def act(self, act: Act) -> None:
        """Begin an external action; `Mind.complete` reports its end (later, or during this call)."""

    def cancel_act(self, act_id: int) -> None:
        """Report that the intention of a pending act was dropped."""

    def suspend_act(self, act_id: int) -> None:
        """Report that the intention of a pending act was suspended."""

    def resume_act(self, act_id: int) -> None:
        """Report that the intention of a pending act was resumed."""

    def send(self, message: SpeechAct) -> bool:
        """Deliver a message; return False if the receiver does not exist."""

    def goal_lost(self) -> None:
        """Report that a goal failed and no plan handled the failure; the warning comes through `log`."""

    def out_of_memory(self) -> None:
        """Report that a step or an event raised a `MemoryError`; the agent continues as long as the host allows."""
