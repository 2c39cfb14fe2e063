"""What `jacaros` offers to the Python code of projects."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

import jacaros
import jacaros.testing


def test_every_public_name_can_be_imported() -> None:
    for package in (jacaros, jacaros.testing):
        for name in package.__all__:
            assert getattr(package, name).__module__.startswith("jacaros."), name
    assert set(jacaros.__all__) <= set(dir(jacaros))


def test_the_errors_of_the_reference_are_public() -> None:
    page = Path(__file__).parents[2] / "docs" / "reference" / "python_api.md"
    table = page.read_text(encoding="utf-8").partition("## Errors")[2].partition("All but")[0]
    rows = [line.split("|")[1] for line in table.splitlines() if line.startswith("| `")]
    errors = {name for row in rows for name in re.findall(r"`(\w+)`", row)}
    assert len(errors) > 8
    assert errors - {"TimeoutError"} <= set(jacaros.__all__)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'internal_actoin'"):
        _ = jacaros.internal_actoin  # type: ignore[attr-defined]


def test_importing_the_package_imports_nothing_else_of_it() -> None:
    code = "import sys, jacaros; print(sorted(m for m in sys.modules if m.startswith('jacaros')))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "['jacaros', 'jacaros.runtime', 'jacaros.runtime.exports']"


def test_a_program_without_python_code_does_not_import_the_extension() -> None:
    code = """
import sys, jacaros.runtime.mas.system
print([m for m in sys.modules if m.startswith("jacaros.agents.python")])
"""
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
