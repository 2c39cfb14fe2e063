"""Outcomes of tests: as data, as text and as JUnit XML."""

import re
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from xml.etree import ElementTree

from jacaros.asl.diagnostics import excerpt
from jacaros.asl.source import Span
from jacaros.testing.probe import Assertion
from jacaros.testing.suites import AgentTest, Suite

Paint = Callable[[str, str], str]
"""``paint(text, kind)``: returns *text* in the colour of *kind*: ``passed``, ``failed``, ``place`` or ``quiet``."""

_WORTH_TELLING = 0.5
"""Seconds: faster tests are not listed as slow."""


@dataclass(frozen=True, slots=True)
class Problem:
    """One reason why a test failed.

    Attributes:
        message: the error, in one line.
        details: further lines, such as the expected value.
        span: place in the program; None if unknown.
    """

    message: str
    details: tuple[str, ...] = ()
    span: Span | None = None

    @staticmethod
    def of(assertion: Assertion) -> "Problem":
        """Return the problem for a failed assertion."""
        details = []
        if assertion.expected:
            details.append(f"expected  {assertion.expected}")
        if assertion.actual:
            details.append(f"{'but' if assertion.expected else 'because':9} {assertion.actual}")
        return Problem(f"{assertion.name} failed", tuple(details), assertion.span)

    def lines(self) -> list[str]:
        """Return the problem as text: place and message, source line, details."""
        place = (
            f"{self.span.file.name}:{self.span.line}:{self.span.column}: " if self.span is not None else ""
        )
        shown = excerpt(self.span) if self.span is not None else []
        return [f"{place}{self.message}", *shown, *(f"  {detail}" for detail in self.details)]


@dataclass(slots=True)
class Outcome:
    """The outcome of one test.

    Attributes:
        problems: reasons for the failure; empty if the test passed.
        assertions: number of assertions evaluated.
        output: output of agents and log lines, in order.
        seconds: duration on the wall clock.
        simulated: duration on the clock of the run, in seconds.
    """

    test: AgentTest
    problems: list[Problem] = field(default_factory=list)
    assertions: int = 0
    output: list[str] = field(default_factory=list)
    seconds: float = 0.0
    simulated: float = 0.0

    @property
    def passed(self) -> bool:
        """Whether the test passed."""
        return not self.problems

    def lines(self) -> list[str]:
        """Return all problems and the output as text."""
        found = [line for problem in self.problems for line in problem.lines()]
        if self.output:
            found += ["printed:", *(f"  {line}" for text in self.output for line in text.splitlines())]
        return found


@dataclass(slots=True)
class SuiteOutcome:
    """The outcomes of the tests of one file, in the order in which they ran."""

    suite: Suite
    outcomes: list[Outcome] = field(default_factory=list)

    @property
    def path(self) -> Path:
        return self.suite.path

    @property
    def passed(self) -> bool:
        """Whether the file could be run and none of its tests failed."""
        return self.suite.error is None and all(outcome.passed for outcome in self.outcomes)


def line_of(outcome: Outcome, paint: Paint, timed: bool) -> str:
    """Return the line of one test, with its duration if *timed*."""
    verdict = paint("ok    ", "passed") if outcome.passed else paint("FAILED", "failed")
    took = paint(f"  {outcome.seconds:.2f} s", "quiet") if timed else ""
    return f"  {verdict}  {outcome.test.name}{took}"


def failures(suites: Sequence[SuiteOutcome], paint: Paint) -> Iterator[str]:
    """Yield the lines about failures."""
    for suite in suites:
        if suite.suite.error is not None:
            yield from ("", paint(f"{suite.path}: cannot run the file", "failed"), suite.suite.error)
        for outcome in suite.outcomes:
            if not outcome.passed:
                yield from ("", paint(f"{suite.path}::{outcome.test.name}", "failed"))
                yield from (f"  {line}" for line in outcome.lines())


def slowest(suites: Sequence[SuiteOutcome], number: int) -> Iterator[str]:
    """Yield the lines about the slowest tests."""
    outcomes = [(outcome, suite) for suite in suites for outcome in suite.outcomes]
    outcomes.sort(key=lambda pair: -pair[0].seconds)
    slow = [pair for pair in outcomes[:number] if pair[0].seconds >= _WORTH_TELLING]
    if slow:
        yield from ("", "slowest:")
    for outcome, suite in slow:
        simulated = f" ({outcome.simulated:.1f} s simulated)" if outcome.simulated >= 1.0 else ""
        yield f"  {outcome.seconds:6.2f} s  {suite.path}::{outcome.test.name}{simulated}"


def summary(suites: Sequence[SuiteOutcome], seed: int | None, paint: Paint) -> str:
    """Return the last line, with the counts."""
    outcomes = [outcome for suite in suites for outcome in suite.outcomes]
    failed = sum(not outcome.passed for outcome in outcomes)
    errors = sum(suite.suite.error is not None for suite in suites)
    counts = [f"{len(outcomes) - failed} passed"]
    if failed:
        counts.append(f"{failed} failed")
    if errors:
        counts.append(f"{errors} {'file' if errors == 1 else 'files'} cannot be run")
    assertions = sum(outcome.assertions for outcome in outcomes)
    text = f"{', '.join(counts)}; {assertions} assertions, seed {seed}"
    return paint(text, "failed" if failed or errors else "passed")


_UNFIT = re.compile("[^\t\n\r\u0020-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")
"""Characters that XML does not allow."""


def write_junit(path: Path, suites: Sequence[SuiteOutcome]) -> None:
    """Write outcomes as JUnit XML to *path*, creating its folder.

    A file that could not be run becomes one test case with an error.

    Raises:
        OSError: the file cannot be written.
    """
    root = ElementTree.Element("testsuites", _counts(suites), name="jacaros")
    for suite in suites:
        counts = _counts([suite])
        element = ElementTree.SubElement(root, "testsuite", counts, name=str(suite.path))
        if suite.suite.error is not None:
            case = _case(element, suite, "the file", 0.0)
            _text(ElementTree.SubElement(case, "error", message="cannot run the file"), suite.suite.error)
        for outcome in suite.outcomes:
            _add(element, suite, outcome)
    ElementTree.indent(root)
    path.parent.mkdir(parents=True, exist_ok=True)
    ElementTree.ElementTree(root).write(path, encoding="utf-8", xml_declaration=True)


def _counts(suites: Sequence[SuiteOutcome]) -> dict[str, str]:
    outcomes = [outcome for suite in suites for outcome in suite.outcomes]
    errors = sum(suite.suite.error is not None for suite in suites)
    return {
        "tests": str(len(outcomes) + errors),
        "failures": str(sum(not outcome.passed for outcome in outcomes)),
        "errors": str(errors),
        "skipped": "0",
        "time": f"{sum(outcome.seconds for outcome in outcomes):.3f}",
    }


def _add(element: ElementTree.Element, suite: SuiteOutcome, outcome: Outcome) -> None:
    case = _case(element, suite, outcome.test.name, outcome.seconds)
    case.set("assertions", str(outcome.assertions))
    if outcome.test.span is not None:
        case.set("file", outcome.test.span.file.name)
        case.set("line", str(outcome.test.span.line))
    if outcome.problems:
        failure = ElementTree.SubElement(case, "failure", message=_fit(outcome.problems[0].message))
        _text(failure, "\n".join(line for problem in outcome.problems for line in problem.lines()))
    if outcome.output:
        _text(ElementTree.SubElement(case, "system-out"), "\n".join(outcome.output))


def _case(
    element: ElementTree.Element, suite: SuiteOutcome, name: str, seconds: float
) -> ElementTree.Element:
    group = ".".join(part for part in suite.path.with_suffix("").parts if part not in ("/", "..", "."))
    return ElementTree.SubElement(
        element, "testcase", classname=group, name=name, time=f"{seconds:.3f}", file=str(suite.path)
    )


def _text(element: ElementTree.Element, text: str) -> None:
    element.text = _fit(text)


def _fit(text: str) -> str:
    return _UNFIT.sub("\N{REPLACEMENT CHARACTER}", text)
