"""Each module of terms begins with an example, which is run here."""

import doctest
import pkgutil
from importlib import import_module
from pathlib import Path

import pytest

import jacaros.agents.terms

MODULES = [each.name for each in pkgutil.iter_modules(jacaros.agents.terms.__path__)]


@pytest.mark.parametrize("name", MODULES)
def test_a_module_begins_with_an_example_that_is_true(name):
    module = import_module(f"jacaros.agents.terms.{name}")
    assert ">>> " in (module.__doc__ or ""), f"{Path(module.__file__ or name)} has no example"
    result = doctest.testmod(module)
    assert result.failed == 0
    assert result.attempted >= 1
