"""``jacaros test FILE|FOLDER ...``."""

import sys
from collections.abc import Sequence
from fnmatch import fnmatchcase
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from jacaros.runtime.cli.graph_options import noise_option
from jacaros.runtime.cli.options import PATH, option
from jacaros.runtime.cli.usage import counted, examples, has_colours, listed, usage_error
from jacaros.runtime.files.texts import visible
from jacaros.runtime.output import beneath

if TYPE_CHECKING:
    from jacaros.testing.suites import Outcome, Suite
    from jacaros.testing.trial import TrialOptions

_COLOURS = {"passed": "green", "failed": "red", "place": "cyan"}


@click.command(
    "test",
    epilog=examples(
        "jacaros test",
        "jacaros test tests/test_patrol.asl -k charging -v",
    ),
)
@click.argument("paths", nargs=-1, type=PATH, metavar="[FILE|FOLDER]...")
@option("-k PATTERN", "Run only tests whose FILE::NAME contains PATTERN; * matches anything.", name="pattern")
@option("-x", "Stop after the first failed test.", name="first")
@option(
    "--timeout S",
    "Time limit for each test, in seconds of the run's clock; the label [test, timeout(Ms)] overrides it.",
    click.FloatRange(0.0, min_open=True),
    default=60.0,
)
@option(
    "--clock",
    "Clock to run on: real, or fast (virtual time).",
    click.Choice(["real", "fast"]),
    default="fast",
)
@option("--seed N", "Seed for random numbers.", int, default=0)
@option(
    "--world FILE",
    "World file or name of a shipped world, instead of the project's; `none` for a graph without robots.",
)
@noise_option
@option(
    "--mapping FILE...",
    "Mapping file for all tests; the label [test, mapping(FILE)] adds one for a single test. Repeatable.",
    name="mappings",
)
@option("-v --verbose", "Also show the time of each test and the output of passed tests.")
def command(
    paths: tuple[Path, ...],
    pattern: str | None,
    first: bool,
    clock: str,
    verbose: bool,
    **given: Any,
) -> int:
    """Run the tests in files and folders (default: the current folder).

    A test is a plan with the label `test`: `@charges[test] +!test_charging <- ...`. In folders, jacaros runs all programs
    with such plans, and all projects whose names begin with `test_` or end in `_test`. The exit code is 1 if a test fails.
    """  # fmt: skip
    # Imported here: it imports all that runs a system.
    from jacaros.testing.suites import collect
    from jacaros.testing.trial import TrialOptions

    suites = _chosen(collect(paths or (Path(),)), paths, pattern)
    report = _Report(verbose)
    return 0 if report.run(suites, TrialOptions(fast=clock == "fast", **given), first) else 1


class _Report:
    """Runs suites, prints each test as it ends, and then the failures.

    Args:
        verbose: also print the time of each test and the output of passed tests.
    """

    def __init__(self, verbose: bool) -> None:
        self._coloured = has_colours()
        self._verbose = verbose

    def run(self, suites: "Sequence[Suite]", options: "TrialOptions", first: bool) -> bool:
        """Run all tests, or up to the *first* failed one; return whether all passed."""
        from jacaros.testing.trial import run_suite

        failures: list[str] = []
        outcomes: list[Outcome] = []
        errors = 0
        for suite in suites:
            for warning in suite.warnings:
                click.echo(warning, err=True)
            _echo(self._paint(str(suite.path), "place"))
            if suite.error is not None:
                errors += 1
                _echo(f"  {self._paint('ERROR ', 'failed')}  cannot run the file")
                failures += ("", self._paint(f"{suite.path}: cannot run the file", "failed"))
                failures.append(visible(suite.error))
            for outcome in run_suite(suite, options):
                outcomes.append(outcome)
                self._show(outcome)
                if not outcome.passed:
                    failures += ("", self._paint(f"{suite.path}::{outcome.test.name}", "failed"))
                    failures += (f"  {visible(line)}" for line in outcome.lines())
                    if first:
                        break
            if first and failures:
                break
        failed = sum(not outcome.passed for outcome in outcomes)
        counts = [f"{len(outcomes) - failed} passed"]
        if failed:
            counts.append(f"{failed} failed")
        if errors:
            counts.append(f"{counted(errors, 'file')} cannot be run")
        assertions = sum(outcome.assertions for outcome in outcomes)
        summary = f"{', '.join(counts)}; {assertions} assertions, seed {options.seed}"
        for line in (*failures, "", self._paint(summary, "failed" if failures else "passed")):
            _echo(line)
        return not failures

    def _show(self, outcome: "Outcome") -> None:
        verdict = self._paint("ok    ", "passed") if outcome.passed else self._paint("FAILED", "failed")
        took = self._paint(f"  {outcome.seconds:.2f} s", "quiet") if self._verbose else ""
        _echo(f"  {verdict}  {visible(outcome.test.name)}{took}")
        if self._verbose and outcome.passed:
            for text in outcome.output:
                _echo(self._paint(f"          {text}", "quiet"))

    def _paint(self, text: str, kind: str) -> str:
        """Return text for the terminal: escaped, and coloured if it understands that."""
        text = visible(text)
        if not self._coloured:
            return text
        return click.style(
            text, fg=_COLOURS.get(kind), bold=kind == "failed" or None, dim=kind == "quiet" or None
        )


def _echo(line: str) -> None:
    """Print a line of escaped text, which may be coloured."""
    click.echo(line, beneath(sys.stdout), color=True)


def _chosen(found: "list[Suite]", paths: Sequence[Path], pattern: str | None) -> "list[Suite]":
    """Return the suites with tests to run, and drop the other tests.

    Raises:
        UsageError: no test is found, or none matches the pattern.
    """
    places = ", ".join(map(str, paths)) or "this folder"
    names = [f"{suite.path}::{test.name}" for suite in found for test in suite.tests]
    if not names and all(suite.error is None for suite in found):
        raise usage_error(
            f"no tests in {places}",
            "a test is a plan for a goal with the label test: @name[test] +!goal <- ...",
        )
    for suite in found if pattern is not None else ():
        wanted = f"*{pattern}*".lower()
        suite.tests = [
            test for test in suite.tests if fnmatchcase(f"{suite.path}::{test.name}".lower(), wanted)
        ]
    chosen = [suite for suite in found if suite.error is not None or suite.tests]
    if not chosen:
        raise usage_error(f"no test in {places} matches `-k {pattern}`", f"tests: {listed(names)}")
    return chosen
