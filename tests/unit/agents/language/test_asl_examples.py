"""Modules of the front end begin with an example, which runs."""

import doctest
import inspect
import pkgutil
from importlib import import_module
from types import ModuleType

import pytest

import jacaros.agents.language

MODULES = [
    import_module(found.name)
    for found in pkgutil.walk_packages(jacaros.agents.language.__path__, "jacaros.agents.language.")
]


def name_of(module: ModuleType) -> str:
    return module.__name__


@pytest.mark.parametrize("module", MODULES, ids=name_of)
def test_the_examples_of_a_module_run(module):
    assert doctest.testmod(module).failed == 0


@pytest.mark.parametrize("module", MODULES, ids=name_of)
def test_a_module_with_a_public_function_begins_with_an_example(module):
    functions = [
        name
        for name, value in inspect.getmembers(module, inspect.isfunction)
        if value.__module__ == module.__name__ and not name.startswith("_")
    ]
    assert not functions or ">>>" in (module.__doc__ or "")
