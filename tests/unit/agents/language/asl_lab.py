"""What the tests of the front end share."""

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError, Diagnostic
from jacaros.agents.language.loader import load_program, parse_plans
from jacaros.agents.language.lowering import format_plan, format_term


def program(text: str, files: dict[str, str] | None = None) -> nodes.Program:
    """The program in *text*; *files* are what it may include."""
    return load_program("main.asl", text, reader(files or {}))[0]


def reader(files: dict[str, str]):
    """A `read` function over *files*."""

    def read(path: str, including: str) -> tuple[str, str]:
        if path not in files:
            raise FileNotFoundError(path)
        return path, files[path]

    return read


def errors(text: str, files: dict[str, str] | None = None) -> tuple[Diagnostic, ...]:
    """The diagnostics of a wrong program."""
    try:
        load_program("main.asl", text, reader(files or {}))
    except AslError as error:
        return error.diagnostics
    raise AssertionError("the program was accepted")


def places(text: str, files: dict[str, str] | None = None) -> list[tuple[int, str]]:
    """Line and message of each error of a wrong program."""
    return [(error.span.line, error.message) for error in errors(text, files) if error.span is not None]


def plan_texts(text: str, files: dict[str, str] | None = None) -> list[str]:
    """The plans of a program as text."""
    return [format_plan(plan) for plan in program(text, files).plans]


def belief_texts(text: str, files: dict[str, str] | None = None) -> list[str]:
    """The beliefs and rules of a program as text."""
    return [format_term(belief) for belief in program(text, files).beliefs]


def parse_plan(text: str, functions: dict[str, int] | None = None) -> nodes.Plan:
    """Parse the one plan in *text*."""
    (plan,) = parse_plans(text, functions)
    return plan
