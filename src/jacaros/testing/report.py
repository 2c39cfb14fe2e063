"""Outcomes for people: one line for each test as it ends, and then what failed."""

from collections.abc import Callable, Iterator, Sequence

from jacaros.testing.outcomes import Outcome, SuiteOutcome

Paint = Callable[[str, str], str]
"""``paint(text, kind)``: *text* in the colour of *kind*, which is ``passed``, ``failed``, ``place`` or ``quiet``."""

_WORTH_TELLING = 0.5
"""Tests that took less, in seconds, are not told to be slow."""


def plain(text: str, kind: str) -> str:
    """No colours."""
    del kind
    return text


def line_of(outcome: Outcome, paint: Paint = plain, timed: bool = False) -> str:
    """The line of one test; *timed* with the time that it took."""
    verdict = paint("ok    ", "passed") if outcome.passed else paint("FAILED", "failed")
    took = paint(f"  {outcome.seconds:.2f} s", "quiet") if timed else ""
    return f"  {verdict}  {outcome.test.name}{took}"


def failures(suites: Sequence[SuiteOutcome], paint: Paint = plain) -> Iterator[str]:
    """The lines about all that failed."""
    for suite in suites:
        if suite.suite.error is not None:
            yield from ("", paint(f"{suite.path}: cannot be run", "failed"), suite.suite.error)
        for outcome in suite.outcomes:
            if not outcome.passed:
                yield from ("", paint(f"{suite.path}::{outcome.test.name}", "failed"))
                yield from (f"  {line}" for line in outcome.lines())


def slowest(suites: Sequence[SuiteOutcome], number: int) -> Iterator[str]:
    """The lines about the tests that took longest."""
    outcomes = [(outcome, suite) for suite in suites for outcome in suite.outcomes]
    outcomes.sort(key=lambda pair: -pair[0].seconds)
    slow = [pair for pair in outcomes[:number] if pair[0].seconds >= _WORTH_TELLING]
    if slow:
        yield from ("", "slowest:")
    for outcome, suite in slow:
        simulated = f" ({outcome.simulated:.1f} s simulated)" if outcome.simulated >= 1.0 else ""
        yield f"  {outcome.seconds:6.2f} s  {suite.path}::{outcome.test.name}{simulated}"


def summary(suites: Sequence[SuiteOutcome], seed: int | None, paint: Paint = plain) -> str:
    """The last line: the counts."""
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
