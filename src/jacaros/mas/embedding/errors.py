"""What Python code around a run is told.

JacarosError
├── UnknownAgent        nobody of that name takes part
├── AgentEnded          the agent has ended, so it cannot do what was asked
├── RunEnded            the run has ended, or has not begun
└── GoalFailed          a goal that was awaited failed, or was dropped
"""

from collections.abc import Iterable

from jacaros.errors import JacarosError


class UnknownAgent(JacarosError):
    """Nobody of that name takes part; the text has names that may have been meant."""

    def __init__(self, name: str, known: Iterable[str]) -> None:
        from difflib import get_close_matches  # here: only for a name that is not there

        names = list(known)
        near = get_close_matches(name, names, n=3, cutoff=0.6)
        listed = ", ".join(names[:10]) + (", …" if len(names) > 10 else "")
        help = f"did you mean {' or '.join(near)}?" if near else f"agents: {listed}" if names else ""
        super().__init__(f"unknown agent {name}{'; ' * bool(help)}{help}")
        self.name = name


class AgentEnded(JacarosError):
    """The agent has ended."""


class RunEnded(JacarosError):
    """The run has ended, or has not begun."""


class GoalFailed(JacarosError):
    """A goal that was awaited failed, and no plan took care of that; or it was dropped.

    Attributes:
        goal: as it was given.
        message: what the failure says to people.
        reasons: its terms as plain values (see `jacaros.env.values`), such as ``error(no_relevant)``.
    """

    def __init__(self, text: str, goal: str, message: str = "", reasons: tuple[object, ...] = ()) -> None:
        super().__init__(text)
        self.goal, self.message, self.reasons = goal, message, reasons

    def reason(self, functor: str) -> object:
        """The argument of the first reason with that functor (a tuple of several); None without one."""
        for term in self.reasons:
            if getattr(term, "functor", None) == functor:
                arguments: tuple[object, ...] = term.arguments  # type: ignore[attr-defined]
                return arguments[0] if len(arguments) == 1 else arguments
        return None
