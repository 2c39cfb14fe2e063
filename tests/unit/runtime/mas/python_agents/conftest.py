"""Runs of agents in Python, in files of code that tests rewrite."""

import sys
from functools import partial
from pathlib import Path

import pytest
from python_agents_lab import TALK, Ran, class_a
from python_agents_lab import run as run_in


@pytest.fixture(autouse=True)
def no_compiled_files(monkeypatch: pytest.MonkeyPatch) -> None:
    """Files that a test writes twice within a second are read twice."""
    monkeypatch.setattr(sys, "dont_write_bytecode", True)


@pytest.fixture
def run(tmp_path: Path) -> Ran:
    return partial(run_in, tmp_path)


@pytest.fixture
def alone(run: Ran) -> Ran:
    """Runs one agent in Python, given by the body of its class."""
    return lambda body, **options: run(a_py=class_a(body), **options)


@pytest.fixture
def talk(run: Ran) -> Ran:
    """Runs an agent in Python and bob; the line ``# bob`` separates the body of the class and the program of bob."""

    def talk(text: str) -> object:
        body, _, bob = text.partition("# bob\n")
        return run(m_mas2j=TALK, a_py=class_a(body), bob_asl=bob)

    return talk
