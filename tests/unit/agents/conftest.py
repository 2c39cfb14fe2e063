"""Lets all tests of agents run minds on the host of `mind`: test folders are not packages."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent / "mind"))


@pytest.fixture(params=["fast", "plain"])
def engines(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    """Run a test with generated code, and by the rules alone."""
    monkeypatch.setenv("JACAROS_PLAIN", "1" if request.param == "plain" else "")
