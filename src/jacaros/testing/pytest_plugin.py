"""Plugin for pytest that collects tests of agent programs.

It is active wherever JaCaROS is installed (``-p no:jacaros`` disables it). In folders it collects the same files as
``jacaros test``, see `jacaros.testing.suites`; a file named on the command line is collected whatever its name.
"""

from collections.abc import Iterable
from os import PathLike
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pytest

# No other imports: every run of pytest loads this plugin, even without agents.

if TYPE_CHECKING:
    from jacaros.testing.suites import AgentTest, Suite

_SUFFIXES = (".asl", ".jcm", ".mas2j")


def pytest_collect_file(file_path: Path, parent: pytest.Collector) -> "AgentFile | None":
    """Collect test programs and test projects."""
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
        """Yield the tests of the file.

        Raises:
            CollectError: the file cannot be read.
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
        """Run the test in a separate system.

        Raises:
            AgentTestFailed: the test failed; the text lists all problems.
        """
        from jacaros.testing.trial import TrialOptions, run_suite

        for outcome in run_suite(self._suite, TrialOptions(), lambda test: test is self._test):
            if not outcome.passed:
                raise AgentTestFailed("\n".join(outcome.lines()))
            for line in outcome.output:
                print(line)

    def repr_failure(self, excinfo: pytest.ExceptionInfo[BaseException], style: Any = None) -> Any:
        """Return the report of a failure, without a Python traceback if the agent failed."""
        if isinstance(excinfo.value, AgentTestFailed):
            return str(excinfo.value)
        return super().repr_failure(excinfo, style)

    def reportinfo(self) -> tuple[PathLike[str] | str, int | None, str]:
        """Return file, line (counted from 0) and name."""
        line = self._test.span.line - 1 if self._test.span is not None else None
        return self.path, line, self.name


class AgentTestFailed(Exception):
    """Raised when an agent test fails; ``str()`` lists the problems."""


def _relative(path: Path) -> Path:
    """Return the path relative to the current folder if that is shorter."""
    try:
        return path.relative_to(Path.cwd())
    except ValueError:
        return path
