"""External actions: what a mind wants done in its environment, and how it ended."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

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
