"""Runs on real ROS graphs; their fixtures are in `graph_runs`, the examples and their checkers in the scenario tests."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))
sys.path.insert(0, str(Path(__file__).parents[2] / "scenarios"))

from graph_runs import (  # noqa: F401 - fixtures and a hook of pytest
    KINDS,
    ask,
    environment,
    master,
    peer,
    pytest_generate_tests,
    run_agents,
    run_world,
    world,
)
from presence import is_wanted


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Leave the folder out where no real graph is: the contract suite says so once, and loudly."""
    return None if any(is_wanted(kind, config) for kind in KINDS) else True


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker `only` known."""
    config.addinivalue_line("markers", "only(kinds): run a test on these kinds of graph alone")
