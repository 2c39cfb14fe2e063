"""A test's view of one agent, and the path from assertions of the agent to the test."""

import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from jacaros.agents.language.diagnostics import Span
from jacaros.agents.mind.actions.internal_action import ActionError
from jacaros.agents.mind.explaining.failure_reason import place_of_call
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.state.intention import GOAL, PLAN
from jacaros.testing.recorded import Fakes


@dataclass(frozen=True, slots=True)
class Assertion:
    """An assertion evaluated by a program.

    Attributes:
        name: the assertion goal, such as ``assert_equals``.
        passed: whether it held.
        expected, actual: for the report; may be empty.
        span: place in the program; None if unknown.
    """

    name: str
    passed: bool
    expected: str
    actual: str
    span: Span | None

    def text(self) -> str:
        """Return the assertion in one line, without its place."""
        if self.passed:
            return f"{self.name} passed"
        text = f"expected {self.expected}" if self.expected else ""
        if self.actual:
            text += f"{', but ' if text else ''}{self.actual}"
        return f"{self.name} failed: {text}"


@dataclass(frozen=True, slots=True)
class Probe:
    """A test that observes one agent.

    Attributes:
        prints: lines that the agent printed, oldest first.
    """

    fakes: Fakes
    asserted: Callable[[Assertion], None]
    prints: Callable[[], Sequence[str]]


class Asserting:
    """A call of an internal action behind an assertion goal.

    Args:
        probe: the test of the agent; None to log failed assertions.
    """

    def __init__(self, ctx: Context, probe: Probe | None) -> None:
        self.ctx = ctx
        self._probe = probe

    def report(self, passed: bool, expected: str, actual: str = "") -> None:
        """Report the assertion made by the goal whose plan makes this call."""
        assertion = Assertion(self._goal(), passed, _readable(expected), _readable(actual), self._place())
        if self._probe is not None:
            self._probe.asserted(assertion)
            return
        where = f"{assertion.span.file.name}:{assertion.span.line}: " if assertion.span is not None else ""
        self.ctx.architecture.log("info" if passed else "error", f"{where}{assertion.text()}")

    def probe(self, what: str) -> Probe:
        """Return the test of this agent; *what* names the calling assertion.

        Raises:
            ActionError: the agent is not in a test.
        """
        if self._probe is None:
            raise ActionError(f"{what} works only in tests; run them with `jacaros test`")
        return self._probe

    def _goal(self) -> str:
        if self.ctx.intention is None:
            return "assertion"
        name: str = self.ctx.intention.frames[-1][GOAL][0].functor.name
        return name

    def _place(self) -> Span | None:
        """Return where the assertion goal is called; None without a caller, as for ``!!assert_true(F)``."""
        intention = self.ctx.intention
        if intention is None:
            return None
        own = len(intention.frames) - 1
        if intention.frames[own][GOAL][0].failing and intention.handlers:
            # A handler is above the frame of the failed goal.
            own = intention.handlers[-1]
        if own == 0 or not intention.frames[own - 1][PLAN].steps:
            return None
        return place_of_call(intention.frames[own - 1], intention.frames[-1][GOAL][0].functor)


def _readable(shown: str) -> str:
    """Return text with anonymous variables as ``_``, without their numbers."""
    return re.sub(r"\b_\d+\b", "_", shown)
