"""Imports ported files."""

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest
from porting_lab import Loaded


@pytest.fixture
def load(tmp_path: Path) -> Loaded:
    """Import the Python text of a port."""

    def run(text: str) -> ModuleType:
        path = tmp_path / "ported.py"
        path.write_text(text, encoding="utf-8")
        spec = importlib.util.spec_from_file_location("ported", path)
        assert spec is not None
        assert spec.loader is not None
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
        return module

    return run
