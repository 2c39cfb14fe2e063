"""What a test knows of one of its agents, and how the assertions of an agent reach its test."""

import re
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from typing import TYPE_CHECKING

from jacaros.asl.source import Span
from jacaros.bdi.actions.internal_action import ActionError
from jacaros.bdi.explaining.failure_reason import place_of_call
from jacaros.bdi.rules.context import Context
from jacaros.bdi.state.intention import GOAL, PLAN
from jacaros.testing.recorded import Fakes

if TYPE_CHECKING:
    from jacaros.testing.fake_graph import FakeGraph


@dataclass(frozen=True, slots=True)
class Assertion:
    """An assertion that a program made.

    Attributes:
        name: the goal that made it, such as ``assert_equals``.
        passed: whether it held.
        expected, actual: for people; empty where there is nothing to tell.
        span: where the program makes it, None when that is unknown.
    """

    name: str
    passed: bool
    expected: str
    actual: str
    span: Span | None

    def text(self) -> str:
        """The assertion in one line, without its place."""
        if self.passed:
            return f"{self.name} passed"
        told = f"expected {self.expected}" if self.expected else ""
        if self.actual:
            told += f"{', but ' if told else ''}{self.actual}"
        return f"{self.name} failed: {told}"


@dataclass(frozen=True, slots=True)
class Probe:
    """A test that looks on at one agent.

    Attributes:
        prints: the lines that the agent has printed, oldest first.
        others: the rest of the ROS graph, as the test plays it.
    """

    fakes: Fakes
    asserted: Callable[[Assertion], None]
    prints: Callable[[], Sequence[str]]
    others: "Callable[[], FakeGraph]"


class Asserting:
    """A call of an action behind an assertion goal.

    Args:
        probe: the test of the agent; without one its assertions are told to people.
    """

    def __init__(self, ctx: Context, probe: Probe | None) -> None:
        self.ctx = ctx
        self._probe = probe

    def tell(self, passed: bool, expected: str, actual: str = "") -> None:
        """Report the assertion made by the goal whose plan makes this call."""
        assertion = Assertion(self._goal(), passed, _readable(expected), _readable(actual), self._place())
        if self._probe is not None:
            self._probe.asserted(assertion)
            return
        where = f"{assertion.span.file.name}:{assertion.span.line}: " if assertion.span is not None else ""
        self.ctx.architecture.log("info" if passed else "error", f"{where}{assertion.text()}")

    def probe(self, what: str) -> Probe:
        """The test of this agent; *what* asks.

        Raises:
            ActionError: the agent is not tested.
        """
        if self._probe is None:
            raise ActionError(f"{what} is for tests: run them with jacaros test")
        return self._probe

    @contextmanager
    def others(self, what: str) -> "Iterator[FakeGraph]":
        """The rest of the ROS graph; what is wrong with the arguments is told where the test has them.

        Raises:
            ActionError: the agent is not tested.
        """
        try:
            yield self.probe(what).others()
        except ValueError as wrong:
            self.tell(False, "", str(wrong))

    def _goal(self) -> str:
        if self.ctx.intention is None:
            return "assertion"
        name: str = self.ctx.intention.frames[-1][GOAL][0].functor.name
        return name

    def _place(self) -> Span | None:
        """Where the assertion goal is called; None when it has no caller, as with ``!!assert_true(F)``."""
        intention = self.ctx.intention
        if intention is None:
            return None
        own = len(intention.frames) - 1
        if intention.frames[own][GOAL][0].failing and intention.handlers:
            # A handler stands above the frame of the goal that failed.
            own = intention.handlers[-1]
        if own == 0 or not intention.frames[own - 1][PLAN].steps:
            return None
        return place_of_call(intention.frames[own - 1], intention.frames[-1][GOAL][0].functor)


def _readable(shown: str) -> str:
    """Unnamed variables as they are written, without their numbers."""
    return re.sub(r"\b_\d+\b", "_", shown)
