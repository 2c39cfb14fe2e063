"""Program texts to programs: the entry points of the front end."""

from collections.abc import Callable, Mapping
from dataclasses import replace
from itertools import count
from typing import TypeVar

from jacaros.asl import nodes
from jacaros.asl.cursor import Names, SyntaxPanic
from jacaros.asl.declaration import Declaration
from jacaros.asl.diagnostics import AslError, Diagnostic
from jacaros.asl.directives.processor import DirectiveProcessor, Read
from jacaros.asl.literal_parser import Namespaces
from jacaros.asl.plan_parser import PlanParser
from jacaros.asl.source import TEXT, SourceFile
from jacaros.asl.walk import shape
from jacaros.terms.functions import FunctionNames

Result = TypeVar("Result")

_run_time_names = Names(count(1_000_000), count(1_000_000), count(1_000_000))
"""Numbers for what is read at run time, apart from those of programs."""


def load_program(
    name: str,
    text: str,
    read: Read | None = None,
    functions: Mapping[str, tuple[int, int | None]] | None = None,
    actions: Mapping[str, Declaration] | None = None,
) -> tuple[nodes.Program, list[Diagnostic]]:
    """The program in *text*, with its includes, and the warnings.

    Args:
        name: what diagnostics call the file; also given to *read* as the including file.
        text: the AgentSpeak source.
        read: ``read(path, including_name) -> (name, text)`` finds an included file; raises FileNotFoundError.
        functions: arithmetic functions of the project, with their least and greatest numbers of arguments; it is
            asked for every name with a dot that is met.
        actions: internal actions by name; contexts refuse those that act or wait.

    Raises:
        AslError: with all errors of all files.
    """
    program, diagnostics = read_program(SourceFile(name, text), read, functions, actions)
    _refuse_errors(diagnostics)
    return program, diagnostics


def read_program(
    file: SourceFile,
    read: Read | None = None,
    functions: Mapping[str, tuple[int, int | None]] | None = None,
    actions: Mapping[str, Declaration] | None = None,
) -> tuple[nodes.Program, list[Diagnostic]]:
    """What can be read of the program in *file*, and all errors and warnings; as `load_program`."""
    diagnostics: list[Diagnostic] = []
    # An empty mapping may be one that fills while names are met.
    known = {} if functions is None else functions
    names = Names(count(1), count(1), count(1), known=known, actions={} if actions is None else actions)
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
    """A program file that is included at run time, in *namespace* (None: the default one).

    Args:
        path: as the program writes it.
        read: ``read(path) -> (name, text)`` finds it; raises FileNotFoundError.
        functions: registered arithmetic functions with their numbers of arguments.
        actions: internal actions by name; contexts refuse those that act or wait.

    Raises:
        FileNotFoundError: the file is not there.
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
    """The term in *text*; a final '.' is allowed.

    *functions* are the registered arithmetic functions with their numbers of arguments.  Unnamed variables
    get numbers that no program has.

    Raises:
        AslError: if the text is no term.
    """
    return _parse(text, name, functions, PlanParser.expression)


def parse_formula(text: str, name: str = TEXT, functions: Mapping[str, int] | None = None) -> nodes.Term:
    """The condition in *text*; as `parse_term`."""
    return _parse(text, name, functions, PlanParser.condition)


def parse_literal(text: str, name: str = TEXT, functions: Mapping[str, int] | None = None) -> nodes.Literal:
    """The literal in *text*; as `parse_term`."""

    def literal(parser: PlanParser) -> nodes.Literal:
        start = parser.token
        term = parser.operand(formula=True)
        if not isinstance(term, nodes.Literal):
            parser.fail("unexpected-token", "a literal is expected", parser.span_from(start))
        return term

    return _parse(text, name, functions, literal)


def parse_trigger(text: str, name: str = TEXT, functions: Mapping[str, int] | None = None) -> nodes.Trigger:
    """The trigger in *text* (``+!g(X)``); as `parse_term`."""
    return _parse(text, name, functions, PlanParser.trigger)


def parse_plan(text: str, name: str = TEXT, functions: Mapping[str, int] | None = None) -> nodes.Plan:
    """The one plan in *text*, with or without its final '.' and with or without braces around it.

    Raises:
        AslError: if the text is no plan.
    """

    def plan(parser: PlanParser) -> nodes.Plan:
        if parser.token.kind != "{":
            return parser.plan()
        start = parser.token
        term = parser.braces()
        if not isinstance(term, nodes.PlanTerm):
            parser.fail("unexpected-token", "a plan is expected", parser.span_from(start))
        return term.plan

    return _parse(text, name, functions, plan)


def parse_plans(
    text: str,
    name: str = TEXT,
    functions: Mapping[str, int] | None = None,
    actions: Mapping[str, Declaration] | None = None,
) -> tuple[nodes.Plan, ...]:
    """The plans in *text*, each with its final '.' (the last one may lack it).

    Raises:
        AslError: with all errors, also when the text holds beliefs or goals.
    """
    diagnostics: list[Diagnostic] = []
    processor = DirectiveProcessor(None, _names_with(functions, actions), diagnostics)
    section = processor.read_file(SourceFile(name, text), last_dot_optional=True)
    for clause in (*section.beliefs, *section.goals):
        diagnostics.append(
            Diagnostic("error", "only plans are expected", clause.span, None, "unexpected-token")
        )
    _settled(diagnostics)
    return tuple(section.plans)


def parse_literals(text: str, name: str = TEXT) -> tuple[nodes.Literal, ...]:
    """The literals in *text*, with ',' between them, as in the options of project files.

    Raises:
        AslError: if the text is anything else.
    """

    def literals(parser: PlanParser) -> tuple[nodes.Literal, ...]:
        found = []
        while parser.token.kind != "end":
            start = parser.token
            parser.accept("!")
            term = parser.operand(formula=True)
            if not isinstance(term, nodes.Literal):
                parser.fail("unexpected-token", "a literal is expected", parser.span_from(start))
            found.append(term)
            if not (parser.accept(",") or parser.accept(".") or parser.accept(";")):
                break
        return tuple(found)

    return _parse(text, name, None, literals)


def _parse(
    text: str, name: str, functions: Mapping[str, int] | None, read: Callable[[PlanParser], Result]
) -> Result:
    """What *read* makes of the whole of *text*."""
    diagnostics: list[Diagnostic] = []
    parser = PlanParser(SourceFile(name, text), _names_with(functions), diagnostics)
    result: Result | None = None
    try:
        result = read(parser)
        parser.accept(".")
        if parser.token.kind != "end":
            parser.unexpected("the end")
    except SyntaxPanic:
        pass
    except RecursionError:
        parser.report("nested-too-deeply", "this is nested too deeply")
    _settled(diagnostics)
    assert result is not None
    return result


def _names_with(
    functions: Mapping[str, int] | None, actions: Mapping[str, Declaration] | None = None
) -> Names:
    known = functions.known if isinstance(functions, FunctionNames) else {}
    return replace(_run_time_names, functions=dict(functions or {}), known=known, actions=actions or {})


def _settled(diagnostics: list[Diagnostic]) -> None:
    """Refuse a text with errors; the diagnostics are put into the order of the text, file by file."""
    _refuse_errors(_ordered(diagnostics))


def _refuse_errors(diagnostics: list[Diagnostic]) -> None:
    if any(diagnostic.severity == "error" for diagnostic in diagnostics):
        raise AslError(diagnostics)


def _ordered(diagnostics: list[Diagnostic]) -> list[Diagnostic]:
    """In the order of the text, file by file."""
    files: dict[str, int] = {}
    for diagnostic in diagnostics:
        if diagnostic.span is not None:
            files.setdefault(diagnostic.span.file.name, len(files))

    def place(diagnostic: Diagnostic) -> tuple[int, int, int]:
        span = diagnostic.span
        return (-1, 0, 0) if span is None else (files[span.file.name], span.line, span.column)

    return sorted(diagnostics, key=place)


def _check_labels(plans: list[nodes.Plan], diagnostics: list[Diagnostic]) -> None:
    """Report labels that two different plans have; repetitions of one and the same plan are taken out.

    Repetitions come about when a file is included twice.  *plans* is changed in place.
    """
    known: dict[tuple[object, str], nodes.Plan] = {}
    repeated: list[int] = []
    for index, plan in enumerate(plans):
        if plan.subplans:
            _check_labels(list(plan.subplans), diagnostics)
        if not isinstance(plan.label, nodes.Literal):
            continue
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
    return Diagnostic(
        "error",
        f"two different plans have one label, @{second.label.functor}{where}",
        second.label.span or second.span,
        "give one of them another label",
        "duplicate-label",
    )
