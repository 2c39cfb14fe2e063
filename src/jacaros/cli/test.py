"""``jacaros test FILE|FOLDER ...``."""

import os
import re
import sys
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from jacaros.cli.graph_options import noise_option
from jacaros.cli.usage import examples, usage_error
from jacaros.files.texts import visible
from jacaros.runtime.output import beneath

if TYPE_CHECKING:
    from jacaros.testing.run import AgentTest, Suite, SuiteOutcome
    from jacaros.testing.trial import TrialOptions

_STYLED = re.compile(r"(\x1b\[.*?\x1b\[0m)", re.DOTALL)
_COLOURS = {"passed": "green", "failed": "red", "place": "cyan"}


MOST_NAMES = 8
"""Number of tests listed when none matches."""


@click.command(
    "test",
    short_help="Run the tests of agent programs.",
    epilog=examples(
        "jacaros test",
        "jacaros test tests/test_patrol.asl -k charging -v",
    ),
)
@click.argument("paths", nargs=-1, type=click.Path(path_type=Path), metavar="[FILE|FOLDER]...")
@click.option(
    "-k",
    "pattern",
    metavar="PATTERN",
    help="Run only tests whose FILE::NAME contains PATTERN; * matches anything.",
)
@click.option("-x", "first", is_flag=True, help="Stop after the first failed test.")
@click.option(
    "--timeout",
    type=click.FloatRange(0.0, min_open=True),
    default=60.0,
    show_default=True,
    metavar="S",
    help="Time limit for each test, in seconds of the run's clock; the label [test, timeout(Ms)] overrides it.",
)
@click.option(
    "--cycles",
    type=click.IntRange(1),
    default=1_000_000,
    show_default=True,
    metavar="N",
    help="Limit on the reasoning cycles of each test.",
)
@click.option(
    "--patience",
    type=click.FloatRange(0.0),
    default=300.0,
    show_default=True,
    metavar="S",
    help="Limit on the real time of each test, in seconds; 0 for no limit.",
)
@click.option(
    "--clock",
    type=click.Choice(["real", "fast"]),
    default="fast",
    show_default=True,
    help="Clock to run on: real, or fast (virtual time).",
)
@click.option("--seed", type=int, default=0, show_default=True, metavar="N", help="Seed for random numbers.")
@click.option(
    "--world",
    metavar="FILE",
    help="World file or name of a shipped world, instead of the project's; `none` for a graph without robots.",
)
@noise_option
@click.option(
    "--mapping",
    "mappings",
    multiple=True,
    metavar="FILE",
    help="Mapping file for all tests; the label [test, mapping(FILE)] adds one for a single test. Repeatable.",
)
@click.option(
    "--color",
    type=click.Choice(["auto", "always", "never"]),
    default="auto",
    show_default=True,
    help="Whether to colour the report; auto: on a terminal, unless NO_COLOR is set.",
)
@click.option(
    "-v",
    "--verbose",
    is_flag=True,
    help="Also show the time of each test and the output of passed tests.",
)
def command(
    paths: tuple[Path, ...],
    pattern: str | None,
    first: bool,
    clock: str,
    color: str,
    verbose: bool,
    **given: Any,
) -> int:
    """Run the tests in files and folders (default: the current folder).

    A test is a plan with the label `test`: `@charges[test] +!test_charging <- ...`. In folders, jacaros runs all programs
    with such plans, and all projects whose names begin with `test_` or end in `_test`. The exit code is 1 if a test fails.
    """  # fmt: skip
    # Imported here: it imports all that runs a system.
    from jacaros.testing.run import collect, failures, summary
    from jacaros.testing.trial import TrialOptions

    paint = _Paint(color)
    suites = _chosen(collect(paths or (Path(),)), paths, pattern)
    options = TrialOptions(fast=clock == "fast", **given)
    outcomes = _Progress(options, paint, pattern, first, verbose).run(suites)
    for line in (*failures(outcomes, paint), "", summary(outcomes, options.seed, paint)):
        paint.echo(line)
    return 0 if all(outcome.passed for outcome in outcomes) else 1


class _Paint:
    """Colours, if enabled."""

    def __init__(self, color: str) -> None:
        if color == "auto":
            self._wanted = sys.stdout.isatty() and not os.environ.get("NO_COLOR")
        else:
            self._wanted = color == "always"
        self._painted: set[str] = set()

    def __call__(self, text: str, kind: str) -> str:
        if not self._wanted:
            return text
        painted = click.style(
            visible(text), fg=_COLOURS.get(kind), bold=kind == "failed" or None, dim=kind == "quiet" or None
        )
        self._painted.add(painted)
        return painted

    def echo(self, line: str) -> None:
        """Print a line; control characters that are not painted here are escaped."""
        parts = (part if part in self._painted else visible(part) for part in _STYLED.split(line))
        click.echo("".join(parts), beneath(sys.stdout), color=True)


class _Progress:
    """Runs suites and prints each test as it ends."""

    def __init__(
        self, options: "TrialOptions", paint: _Paint, pattern: str | None, first: bool, verbose: bool
    ) -> None:
        self._options, self._paint, self._pattern = options, paint, pattern
        self._first, self._verbose = first, verbose

    def run(self, suites: "Sequence[Suite]") -> "list[SuiteOutcome]":
        """Run all tests that match the pattern, or up to the first failed one."""
        from jacaros.testing.run import SuiteOutcome

        outcomes = []
        for suite in suites:
            for warning in suite.warnings:
                click.echo(warning, err=True)
            self._paint.echo(self._paint(str(suite.path), "place"))
            outcome = SuiteOutcome(suite)
            outcomes.append(outcome)
            self._run(outcome)
            if self._first and not outcome.passed:
                break
        return outcomes

    def _run(self, suite: "SuiteOutcome") -> None:
        from jacaros.testing.run import line_of
        from jacaros.testing.trial import run_suite

        if suite.suite.error is not None:
            self._paint.echo(f"  {self._paint('ERROR ', 'failed')}  cannot run the file")
            return
        for outcome in run_suite(
            suite.suite, self._options, lambda test: _is_meant(suite.suite, test, self._pattern)
        ):
            suite.outcomes.append(outcome)
            self._paint.echo(line_of(outcome, self._paint, self._verbose))
            if self._verbose and outcome.passed:
                for text in outcome.output:
                    self._paint.echo(self._paint(f"          {text}", "quiet"))
            if self._first and not outcome.passed:
                return


def _chosen(found: "list[Suite]", paths: Sequence[Path], pattern: str | None) -> "list[Suite]":
    """Return the suites with tests to run.

    Raises:
        UsageError: no test is found, or none matches the pattern.
    """
    places = ", ".join(map(str, paths)) or "this folder"
    if not any(suite.tests or suite.error is not None for suite in found):
        raise usage_error(
            f"no tests in {places}",
            "a test is a plan for a goal with the label test: @name[test] +!goal <- ...",
        )
    chosen = [
        suite
        for suite in found
        if suite.error is not None or any(_is_meant(suite, test, pattern) for test in suite.tests)
    ]
    if not any(suite.tests for suite in chosen) and not any(suite.error is not None for suite in chosen):
        names = [f"{suite.path}::{test.name}" for suite in found for test in suite.tests]
        shown = ", ".join(names[:MOST_NAMES]) + (", ..." if len(names) > MOST_NAMES else "")
        raise usage_error(f"no test in {places} matches `-k {pattern}`", f"tests: {shown}")
    return chosen


def _is_meant(suite: "Suite", test: "AgentTest", pattern: str | None) -> bool:
    if pattern is None:
        return True
    return fnmatchcase(f"{suite.path}::{test.name}".lower(), f"*{pattern.lower()}*")
