"""What an intention waits for: a timer, an answer, an external action."""

from collections.abc import Callable
from typing import Any

from jacaros.bdi.state.intention import Frame, Intention, NextStep
from jacaros.terms.values import Term, atom, functor

ACTION = functor("action", 1)
"""Functor of the reason of those who wait for the end of an external action."""

OWN_SUSPENSION = atom("suspended")
"""Reason of the steps by which an intention suspends itself: its goals are suspended, they do not wait."""


def is_action(reason: Term) -> bool:
    """Whether what is waited for is an external action."""
    return reason.__class__ is tuple and reason[0] is ACTION


class Waiting:
    """A suspended step; whoever made it calls `resume` or `fail` once.

    Attributes:
        reason: a term for ``.intention`` and ``.suspended``.
        on_drop: called when the intention is dropped meanwhile.
        on_suspend, on_resume: called when it is suspended and resumed meanwhile.
    """

    __slots__ = (
        "agent",
        "ended",
        "failure",
        "frame",
        "intention",
        "next_step",
        "on_drop",
        "on_resume",
        "on_suspend",
        "reason",
    )

    def __init__(self, agent: Any, intention: Intention, reason: Term) -> None:
        self.agent, self.intention, self.reason = agent, intention, reason
        self.frame: Frame | None = None
        self.next_step: NextStep = None
        self.ended = False
        self.failure: tuple[str, tuple[Term, ...]] | None = None
        self.on_drop: Callable[[], None] | None = None
        self.on_suspend: Callable[[], None] | None = None
        self.on_resume: Callable[[], None] | None = None

    def attach(self, frame: Frame, next_step: NextStep) -> None:
        """The step is suspended in *frame*, and goes on with *next_step*."""
        self.frame, self.next_step = frame, next_step
        self.intention.waiting = self

    def resume(self) -> None:
        """The step has succeeded; the intention goes on in the agent's next cycle."""
        if not self.ended:
            self.ended = True
            self.agent.waiting_ended(self)

    def fail(self, message: str, *annotations: Term) -> None:
        """The step has failed; *annotations* may hold an ``error(..)``."""
        if not self.ended:
            self.ended = True
            self.failure = (message, annotations)
            self.agent.waiting_ended(self)

    def cancel(self) -> None:
        """The intention is gone."""
        if not self.ended:
            self.ended = True
            if self.on_drop is not None:
                self.on_drop()
