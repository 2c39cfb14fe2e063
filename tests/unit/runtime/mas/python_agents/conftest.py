"""Files of code that tests rewrite."""

import sys

import pytest


@pytest.fixture(autouse=True)
def no_compiled_files(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files that a test writes twice within a second are read twice."""
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
