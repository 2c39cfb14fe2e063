"""Calls of commands."""

import pytest
from command_lab import Outcome, Told

from jacaros.runtime.cli.main import call


@pytest.fixture
def outcome(request: pytest.FixtureRequest, capsys: pytest.CaptureFixture[str]) -> Outcome:
    """Calls a command, after the words in ``COMMAND`` of the test's module."""
    command = getattr(request.module, "COMMAND", ())

    def run(*arguments: str) -> tuple[int, str, str]:
        code = call([*command, *arguments])
        captured = capsys.readouterr()
        return code, captured.out, captured.err

    return run


@pytest.fixture
def told(outcome: Outcome) -> Told:
    def run(*arguments: str) -> str:
        code, output, errors = outcome(*arguments)
        assert (code, errors) == (0, ""), errors
        return output

    return run
