"""The conformance programs and the examples of modules."""

import doctest
import inspect
import pkgutil
import re
from importlib import import_module
from pathlib import Path
from types import ModuleType

import pytest
from asl_lab import parse_plan

import jacaros.agents.language
from jacaros.agents.checks.checker import check
from jacaros.agents.checks.goals import KnownActions
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import load_program
from jacaros.agents.language.lowering import format_plan

TESTS = Path(__file__).parents[3]
PROGRAMS = sorted(
    path for folder in ("conformance", "conformance_environment") for path in (TESTS / folder).rglob("*.asl")
)
REFUSED = sorted((TESTS / "conformance" / "syntax_errors").glob("*.expected"))
GOOD = [path for path in PROGRAMS if "syntax_errors" not in path.parts]


def read(path: str, including: str) -> tuple[str, str]:
    found = Path(including).parent / path
    return str(found), found.read_text(encoding="utf-8")


def load(path: Path):
    return load_program(str(path), path.read_text(encoding="utf-8"), read)


def test_correct_programs_are_read_and_checked_without_a_warning():
    assert len(GOOD) > 300
    assert len(REFUSED) == 14
    for path in GOOD:
        _, warnings = load(path)
        assert warnings == [], path
    for path in GOOD:
        for warning in check(load(path)[0], KnownActions({})):
            assert warning.severity in ("warning", "note")
            assert warning.span is not None


def test_every_plan_reads_back_from_its_text():
    for path in GOOD:
        program = load(path)[0]
        functions = {function.name: function.arity for function in program.functions}
        for plan in program.plans:
            text = format_plan(plan)
            # No other file can write the name of a local namespace, which ends with its file.
            if not plan.subplans and "#" not in text:
                again = format_plan(parse_plan(text, functions=functions))
                assert without_numbers(again) == without_numbers(text), path


def without_numbers(text: str) -> str:
    """Unnamed variables differ in their numbers."""
    return re.sub(r"\b_\d+", "_", text)


@pytest.mark.parametrize("expected", REFUSED, ids=lambda path: path.stem)
def test_a_wrong_program_is_refused_at_its_line(expected):
    program = expected.with_suffix(".asl")
    if not program.exists():
        program = expected.with_suffix("") / program.name
    with pytest.raises(AslError) as refused:
        load(program)
    wanted = re.search(r"! error line (\d+)", expected.read_text(encoding="utf-8"))
    lines = [diagnostic.span.line for diagnostic in refused.value.diagnostics]
    if wanted:
        assert lines == [int(wanted.group(1))]
        assert f":{wanted.group(1)}:" in str(refused.value)


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
