"""The plugin for pytest: tests of agent programs are collected beside those in Python.

It is there wherever JaCaROS is installed (``-p no:jacaros`` leaves it out).  Test files are those that ``jacaros test``
finds in a folder, see `jacaros.testing.suites`; a file that is named on the command line counts whatever its name.
"""

from collections.abc import Iterable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

# Nothing else is imported here: the plugin is loaded by every run of pytest, also by those that have no agents.

if TYPE_CHECKING:
    from jacaros.testing.suites import AgentTest, Suite

_SUFFIXES = (".asl", ".jcm", ".mas2j")


def pytest_addoption(parser: pytest.Parser) -> None:
    """The options of ``jacaros test`` that make sense here."""
    group = parser.getgroup("jacaros", "agent programs")
    group.addoption(
        "--asl-timeout",
        type=float,
        default=60.0,
        metavar="S",
        help="seconds of virtual time that an agent test may take",
    )
    group.addoption("--asl-seed", type=int, default=0, metavar="N", help="seed of agent tests")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "AgentFile | None":
    """Take test programs and test projects."""
    if file_path.suffix not in _SUFFIXES:
        return None
    from jacaros.testing.suites import is_test_file

    if not parent.session.isinitpath(file_path) and not is_test_file(file_path):
        return None
    file: AgentFile = AgentFile.from_parent(parent, path=file_path)
    return file


class AgentFile(pytest.File):
    """A program or project with agent tests."""

    def collect(self) -> Iterable["AgentItem"]:
        """Its tests.

        Raises:
            CollectError: it cannot be read.
        """
        from jacaros.testing.suites import suite_of

        suite = suite_of(_relative(self.path))
        if suite.error is not None:
            raise self.CollectError(suite.error)
        for test in suite.tests:
            yield AgentItem.from_parent(self, name=test.name, suite=suite, test=test)


class AgentItem(pytest.Item):
    """One test of an agent program."""

    def __init__(self, *, suite: "Suite", test: "AgentTest", **keywords: Any) -> None:
        super().__init__(**keywords)
        self._suite = suite
        self._test = test

    def runtest(self) -> None:
        """Run it in a system of its own.

        Raises:
            AgentTestFailed: with all that is wrong.
        """
        from jacaros.testing.trial import TrialOptions, run_suite

        given = self.config.option
        options = TrialOptions(timeout=given.asl_timeout, seed=given.asl_seed)
        for outcome in run_suite(self._suite, options, lambda test: test is self._test):
            if not outcome.passed:
                raise AgentTestFailed("\n".join(outcome.lines()))
            for line in outcome.output:
                print(line)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """What is told about a failure: no trace of Python, when the agent is to blame."""
        if isinstance(excinfo.value, AgentTestFailed):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[PathLike[str] | str, int | None, str]:
        """File, line (counted from 0) and name."""
        line = self._test.span.line - 1 if self._test.span is not None else None
        return self.path, line, self.name


class AgentTestFailed(Exception):
    """An agent test failed; ``str()`` tells what is wrong."""


def _relative(path: Path) -> Path:
    """The path as people write it, where that is shorter."""
    try:
        return path.relative_to(Path.cwd())
    except ValueError:
        return path
