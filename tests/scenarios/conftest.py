"""Fixtures for runs of examples on real graphs."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parents[1] / "integration" / "ros"))

from graph_runs import (  # noqa: F401 - fixtures and a hook of pytest
    KINDS,
    environment,
    master,
    pytest_generate_tests,
    run_agents,
    run_world,
)
from presence import is_wanted


def pytest_ignore_collect(collection_path: Path, config: pytest.Config) -> bool | None:
    """Skip the runs on real graphs where ROS is missing. The contract suite reports that once."""
    if not collection_path.name.endswith("_on_graphs.py"):
        return None
    return None if any(is_wanted(kind, config) for kind in KINDS) else True


def pytest_configure(config: pytest.Config) -> None:
    """Make the marker `only` known."""
    config.addinivalue_line("markers", "only(kinds): run a test on these kinds of graph alone")
