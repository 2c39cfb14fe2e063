"""The entry points of the front end: from program texts to programs.

>>> program, warnings = load_program("robot.asl", "at(home). +!go(X) <- move(X).")
>>> len(program.beliefs), len(program.plans), warnings
(1, 1, [])
>>> parse_term("f(X)").arguments[0].name
'X'
"""

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import count
from typing import TypeVar

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import ProgramNames, SyntaxPanic
from jacaros.agents.language.diagnostics import TEXT, AslError, Diagnostic, SourceFile, problem
from jacaros.agents.language.directives import DirectiveProcessor, ReadSource
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.language.nodes import Declaration, shape
from jacaros.agents.language.plan_parser import PlanParser
from jacaros.agents.language.term_parser import Namespaces
from jacaros.agents.terms.functions import FunctionNames
from jacaros.agents.terms.operators import ArithmeticFault

T = TypeVar("T")

_run_time_names = ProgramNames(count(1_000_000), count(1_000_000), count(1_000_000))
"""Counters for terms parsed at run time, distinct from those of programs."""


def load_program(
    name: str,
    text: str,
    read: ReadSource | None = None,
    functions: Mapping[str, tuple[int, int | None]] | None = None,
    actions: Mapping[str, Declaration] | None = None,
) -> tuple[nodes.Program, list[Diagnostic]]:
    """Parse the program in *text* with its includes; return it and its warnings.

    Args:
        name: the file name in diagnostics; also passed to *read* as the including file.
        text: the AgentSpeak source.
        read: ``read(path, including_name) -> (name, text)`` finds an included file; raises FileNotFoundError.
        functions: arithmetic functions of the project, with their minimum and maximum numbers of arguments;
            looked up for every name with a dot.
        actions: internal actions by name; contexts reject those that act or wait.

    Raises:
        AslError: with all errors of all files.
    """
    program, diagnostics = read_program(SourceFile(name, text), read, new_names(functions, actions))
    _refuse_errors(diagnostics)
    return program, diagnostics


def new_names(
    functions: Mapping[str, tuple[int, int | None]] | None = None,
    actions: Mapping[str, Declaration] | None = None,
) -> ProgramNames:
    """Return the names that a program may use; see `load_program`."""
    # Keep the caller's mapping even if it is empty: it may fill up as names are looked up.
    known = {} if functions is None else functions
    return ProgramNames(count(1), count(1), count(1), known=known, actions={} if actions is None else actions)


def read_program(
    file: SourceFile,
    read: ReadSource | None = None,
    names: ProgramNames | None = None,
) -> tuple[nodes.Program, list[Diagnostic]]:
    """Parse what is valid of the program in *file*; return it with all errors and warnings.

    Args:
        file: the AgentSpeak source.
        read: finds an included file; see `load_program`.
        names: those that the program may use, from `new_names`.
    """
    diagnostics: list[Diagnostic] = []
    names = names or new_names()
    section = DirectiveProcessor(read, names, diagnostics).read_file(file)
    _check_labels(section.plans, diagnostics)
    return section.program(), _ordered(diagnostics)


def include_program(
    path: str,
    read: Callable[[str], tuple[str, str]],
    functions: Mapping[str, int],
    actions: Mapping[str, Declaration],
    namespace: str | None = None,
) -> nodes.Program:
    """Parse a program file that is included at run time, in *namespace* (None: the default one).

    Args:
        path: as written in the program.
        read: ``read(path) -> (name, text)`` finds it; raises FileNotFoundError.
        functions: registered arithmetic functions with their numbers of arguments.
        actions: internal actions by name; contexts reject those that act or wait.

    Raises:
        FileNotFoundError: the file does not exist.
        AslError: with all errors.
    """
    name, text = read(path)
    diagnostics: list[Diagnostic] = []
    processor = DirectiveProcessor(lambda inner, _: read(inner), _names_with(functions, actions), diagnostics)
    section = processor.read_file(SourceFile(name, text), Namespaces(namespace))
    _check_labels(section.plans, diagnostics)
    _settled(diagnostics)
    return section.program()


def parse_term(text: str, name: str = TEXT, functions: Mapping[str, int] | None = None) -> nodes.Term:
    """Parse the term in *text*; a final '.' is allowed.

    *functions* are the registered arithmetic functions with their numbers of arguments. Unnamed variables
    get numbers that no program uses.

    Raises:
        AslError: the text is not a term.
    """
    return _parse(text, PlanParser.expression, name, functions)


def parse_formula(text: str) -> nodes.Term:
    """Parse the condition in *text*; see `parse_term`."""
    return _parse(text, PlanParser.condition)


def parse_literal(text: str) -> nodes.Literal:
    """Parse the literal in *text*; see `parse_term`."""
    return _parse(text, _literal)


def _literal(parser: PlanParser) -> nodes.Literal:
    start = parser.token
    term = parser.operand(formula=True)
    if not isinstance(term, nodes.Literal):
        parser.fail("unexpected-token", "expected a literal", parser.span_from(start))
    return term


def parse_trigger(text: str) -> nodes.Trigger:
    """Parse the trigger in *text* (``+!g(X)``); see `parse_term`."""
    return _parse(text, PlanParser.trigger)


def parse_plans(
    text: str, functions: Mapping[str, int] | None = None, actions: Mapping[str, Declaration] | None = None
) -> tuple[nodes.Plan, ...]:
    """Parse the plans in *text*, each with its final '.' (optional after the last one).

    Raises:
        AslError: with all errors; also if the text contains beliefs or goals.
    """
    diagnostics: list[Diagnostic] = []
    processor = DirectiveProcessor(None, _names_with(functions, actions), diagnostics)
    section = processor.read_file(SourceFile(TEXT, text), last_dot_optional=True)
    clauses = (*section.beliefs, *section.goals)
    diagnostics += [problem("unexpected-token", "expected only plans", each.span) for each in clauses]
    _settled(diagnostics)
    return tuple(section.plans)


def parse_literals(text: str, name: str = TEXT) -> tuple[nodes.Literal, ...]:
    """Parse the literals in *text*, separated by ',', as in the options of project files.

    Raises:
        AslError: the text is anything else.
    """

    def literals(parser: PlanParser) -> tuple[nodes.Literal, ...]:
        found = []
        while parser.token.kind != "end":
            parser.accept("!")
            found.append(_literal(parser))
            if not any(map(parser.accept, (",", ".", ";"))):
                break
        return tuple(found)

    return _parse(text, literals, name)


def _parse(
    text: str,
    read: Callable[[PlanParser], T],
    name: str = TEXT,
    functions: Mapping[str, int] | None = None,
) -> T:
    """Parse the whole of *text* with *read*."""
    diagnostics: list[Diagnostic] = []
    parser = PlanParser(SourceFile(name, text), _names_with(functions), diagnostics)
    result: T | None = None
    try:
        result = read(parser)
        parser.accept(".")
        if parser.token.kind != "end":
            parser.unexpected("the end of the text")
    except SyntaxPanic:
        pass
    except RecursionError:
        parser.report("nested-too-deeply", "nested too deeply")
    _settled(diagnostics)
    assert result is not None
    return result


def _names_with(
    functions: Mapping[str, int] | None, actions: Mapping[str, Declaration] | None = None
) -> ProgramNames:
    known = functions.known if isinstance(functions, FunctionNames) else {}
    return replace(_run_time_names, functions=dict(functions or {}), known=known, actions=actions or {})


def _settled(diagnostics: list[Diagnostic]) -> None:
    """Sort the diagnostics by file and position, and raise AslError if there are errors."""
    _refuse_errors(_ordered(diagnostics))


def _refuse_errors(diagnostics: list[Diagnostic]) -> None:
    if any(diagnostic.severity == "error" for diagnostic in diagnostics):
        raise AslError(diagnostics)


def _ordered(diagnostics: list[Diagnostic]) -> list[Diagnostic]:
    """Return the diagnostics sorted by position, file by file."""
    files: dict[str, int] = {}
    for diagnostic in diagnostics:
        if diagnostic.span is not None:
            files.setdefault(diagnostic.span.file.name, len(files))

    def place(diagnostic: Diagnostic) -> tuple[int, int, int]:
        span = diagnostic.span
        return (-1, 0, 0) if span is None else (files[span.file.name], span.line, span.column)

    return sorted(diagnostics, key=place)


def _check_labels(plans: list[nodes.Plan], diagnostics: list[Diagnostic]) -> None:
    """Report labels without a value or of two different plans, and drop repetitions of the same plan from *plans*.

    Repetitions occur when a file is included twice.
    """
    known: dict[tuple[object, str], nodes.Plan] = {}
    repeated: list[int] = []
    for index, plan in enumerate(plans):
        if plan.subplans:
            _check_labels(list(plan.subplans), diagnostics)
        if not isinstance(plan.label, nodes.Literal):
            continue
        try:
            lower_value(plan.label)
        except ArithmeticFault as fault:
            told = f"cannot evaluate the annotations of a label: {fault}"
            diagnostics.append(problem("wrong-label", told, plan.label.span, "write its value"))
        first = known.setdefault((plan.label.namespace, plan.label.functor), plan)
        if first is plan:
            continue
        if shape(first) == shape(plan):
            repeated.append(index)
        else:
            diagnostics.append(_two_plans(first, plan))
    for index in reversed(repeated):
        del plans[index]


def _two_plans(first: nodes.Plan, second: nodes.Plan) -> Diagnostic:
    assert isinstance(second.label, nodes.Literal)
    where = ""
    if first.span is not None:
        file = first.span.file.name
        elsewhere = second.span is None or second.span.file.name != file
        where = f"; the first one is at {f'{file}, ' if elsewhere else ''}line {first.span.line}"
    return problem(
        "duplicate-label",
        f"two different plans have the label `@{second.label.functor}`{where}",
        second.label.span or second.span,
        "rename one of the labels",
    )
