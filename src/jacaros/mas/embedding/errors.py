"""Errors for Python code around a run.

JacarosError
├── UnknownAgent        no participant has this name
├── AgentEnded          the agent has ended, so the call is not possible
├── RunEnded            the run has ended, or has not begun
└── GoalFailed          an awaited goal failed, or was dropped
"""

from collections.abc import Iterable

from jacaros.errors import JacarosError
from jacaros.files.texts import suggestion


class UnknownAgent(JacarosError):
    """No participant has this name. The text suggests similar names."""

    def __init__(self, name: str, known: Iterable[str]) -> None:
        names = list(known)
        listed = ", ".join(names[:10]) + (", …" if len(names) > 10 else "")
        help = suggestion(name, names, f"agents: {listed}" if names else "", 3)
        super().__init__(f"unknown agent `{name}`{'; ' * bool(help)}{help}")
        self.name = name


class AgentEnded(JacarosError):
    """The agent has ended."""


class RunEnded(JacarosError):
    """The run has ended, or has not begun."""


class GoalFailed(JacarosError):
    """An awaited goal failed without a plan for its failure, or was dropped.

    Attributes:
        goal: the goal as it was given.
        message: the message of the failure.
        reasons: its terms as plain values (see `jacaros.artifacts.env.values`), such as ``error(no_relevant)``.
    """

    def __init__(self, text: str, goal: str, message: str = "", reasons: tuple[object, ...] = ()) -> None:
        super().__init__(text)
        self.goal, self.message, self.reasons = goal, message, reasons

    def reason(self, functor: str) -> object:
        """Return the argument of the first reason with this functor (a tuple of several), or None."""
        for term in self.reasons:
            if getattr(term, "functor", None) == functor:
                arguments: tuple[object, ...] = term.arguments  # type: ignore[attr-defined]
                return arguments[0] if len(arguments) == 1 else arguments
        return None
