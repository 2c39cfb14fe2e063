"""How tests ended, as data: for reports, files and other tools."""

from dataclasses import dataclass, field
from pathlib import Path

from jacaros.asl.diagnostics import excerpt
from jacaros.asl.source import Span
from jacaros.testing.probe import Assertion
from jacaros.testing.suites import AgentTest, Suite


@dataclass(frozen=True, slots=True)
class Problem:
    """One reason why a test failed.

    Attributes:
        message: what is wrong, in one line.
        details: further lines, such as what was expected.
        span: where in the program, None when that is unknown.
    """

    message: str
    details: tuple[str, ...] = ()
    span: Span | None = None

    @staticmethod
    def of(assertion: Assertion) -> "Problem":
        """What an assertion that failed tells."""
        details = []
        if assertion.expected:
            details.append(f"expected  {assertion.expected}")
        if assertion.actual:
            details.append(f"{'but' if assertion.expected else 'because':9} {assertion.actual}")
        return Problem(f"{assertion.name} failed", tuple(details), assertion.span)

    def lines(self) -> list[str]:
        """The problem for people: place and message, the line of the program, the details."""
        place = (
            f"{self.span.file.name}:{self.span.line}:{self.span.column}: " if self.span is not None else ""
        )
        shown = excerpt(self.span) if self.span is not None else []
        return [f"{place}{self.message}", *shown, *(f"  {detail}" for detail in self.details)]


@dataclass(slots=True)
class Outcome:
    """How one test ended.

    Attributes:
        test: the test.
        problems: why it failed; empty when it passed.
        assertions: number of assertions made.
        output: what agents printed and what was logged, in order.
        seconds: how long it took, on the wall clock.
        simulated: how long it took on the clock of the run.
    """

    test: AgentTest
    problems: list[Problem] = field(default_factory=list)
    assertions: int = 0
    output: list[str] = field(default_factory=list)
    seconds: float = 0.0
    simulated: float = 0.0

    @property
    def passed(self) -> bool:
        """Whether there is nothing to complain about."""
        return not self.problems

    def lines(self) -> list[str]:
        """For people: all problems, and then what was printed."""
        found = [line for problem in self.problems for line in problem.lines()]
        if self.output:
            found += ["printed:", *(f"  {line}" for text in self.output for line in text.splitlines())]
        return found


@dataclass(slots=True)
class SuiteOutcome:
    """How the tests of one file ended.

    Attributes:
        suite: the file.
        outcomes: of those tests that were run, in order.
    """

    suite: Suite
    outcomes: list[Outcome] = field(default_factory=list)

    @property
    def path(self) -> Path:
        """The file."""
        return self.suite.path

    @property
    def passed(self) -> bool:
        """Whether the file could be run and none of its tests failed."""
        return self.suite.error is None and all(outcome.passed for outcome in self.outcomes)
