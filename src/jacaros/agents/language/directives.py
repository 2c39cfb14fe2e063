"""Directives: files that programs include, namespaces, patterns and declarations, and libraries of other systems.

Their contents are built in here (joining and focusing, answers to messages), have a counterpart in our own library
(questions about workspaces), or are not supported (organisations).

>>> is_library("$jacamo/templates/common-cartago.asl"), is_library("robot.asl")
(True, False)
"""

from collections.abc import Callable
from itertools import count
from pathlib import Path
from typing import Any, Final

from jacaros.agents.language import nodes
from jacaros.agents.language.cursor import Names, SyntaxPanic
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile, Span
from jacaros.agents.language.goal_patterns import PATTERNS, PatternCall, apply_pattern
from jacaros.agents.language.nodes import rebuilt
from jacaros.agents.language.plan_parser import PlanParser
from jacaros.agents.language.program_parser import ProgramParser, WrongDirective
from jacaros.agents.language.term_parser import Namespaces
from jacaros.files.texts import suggestion

_ROOTS: Final = frozenset(
    {"$jacamo", "$jacamoJar", "$jason", "$jasonJar", "$moise", "$moiseJar", "$cartago", "$cartagoJar"}
)
_KNOWN: Final = frozenset(
    {"common.asl", "dynamic-focus.asl", "kqmlPlans.asl"}
    | {"tester_agent.asl", "test_assert.asl", "test_manager.asl"}
)
"""Files of them that programs here do not need."""
_ORGANISATIONS: Final = frozenset({"common-moise.asl", "org-obedient.asl", "org-rules.asl", "sai-rules.asl"})
_OURS: Final = {"common-cartago.asl": "common_cartago.asl", "wsp-rules.asl": "common_cartago.asl"}


def is_library(path: str) -> bool:
    """Return whether *path* names a file of one of these systems, as in ``$jacamo/templates/common-cartago.asl``."""
    return path.partition("/")[0] in _ROOTS


# Run the directives of a program: includes, namespaces, functions and goal patterns.


Read = Callable[[str, str], tuple[str, str]]
"""``read(path, including_name) -> (name, text)``: finds an included file; raises FileNotFoundError,
whose text says where it was searched."""

_SIMPLE: Final = ("include", "namespace", "register_function")
_DEEPEST: Final = 40
"""Maximum depth of includes, so that parsing them does not exhaust Python's stack."""
_MOST_INCLUDES: Final = 10_000
"""Maximum number of includes: 30 files that each include the next one twice would make a thousand million."""


class DirectiveProcessor:
    """The directives of one program with all its files."""

    def __init__(self, read: Read | None, names: Names, diagnostics: list[Diagnostic]) -> None:
        self._read = read
        self._names = names
        self._diagnostics = diagnostics
        self._open_files: list[str] = []
        self._pattern_numbers = count(1)
        self._warned_of_organisations = False
        self._included = 0

    def read_file(
        self, file: SourceFile, namespaces: Namespaces | None = None, last_dot_optional: bool = False
    ) -> nodes.Section:
        """Parse all clauses of *file* and of its includes."""
        self._open_files.append(file.name)
        parser = ProgramParser(
            file, self._names, self._diagnostics, self, namespaces, last_dot_optional=last_dot_optional
        )
        section = parser.file_clauses()
        self._open_files.pop()
        return section

    def apply(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        """Run a directive without a block."""
        name = directive.functor
        run = {
            "include": self._include,
            "namespace": self._declare_namespace,
            "register_function": self._register,
        }.get(name)
        try:
            if run is not None:
                run(parser, directive, section)
            elif name == "derive":
                message = "programs do not declare derived events"
                raise WrongDirective(message, "declare them in a mapping file, below `derived:`")
            elif name in PATTERNS:
                raise WrongDirective(f"`{name}` expects a block", f"{{ begin {name}(...) }} plans {{ end }}")
            else:
                message = f"unknown directive `{name}`"
                parser.report("unknown-directive", message, directive.span, _meant(name))
        except WrongDirective as wrong:
            _report(parser, directive, wrong)

    def apply_to_block(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        """Parse the block of a directive and add the resulting clauses to *section*."""
        name = directive.functor
        outside = parser.namespaces.current
        try:
            if name == "namespace":
                parser.namespaces.current = self._namespace(parser, directive)
            elif name not in PATTERNS:
                help = f"write `{{ {name}(...) }}` without `begin`" if name in _SIMPLE else _meant(name)
                message = f"unknown directive `{name}` with a block"
                parser.report("unknown-directive", message, directive.span, help)
        except WrongDirective as wrong:
            _report(parser, directive, wrong)
        block = parser.block(directive)
        parser.namespaces.current = outside
        try:
            section.extend(apply_pattern(self._call(parser, directive), block) if name in PATTERNS else block)
        except WrongDirective as wrong:
            _report(parser, directive, wrong)
            section.extend(block)

    # include

    def _include(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        match directive.arguments:
            case (nodes.String(path), *namespace) if len(namespace) <= 1:
                pass
            case _:
                message = "`include` expects the name of a file as a string"
                raise WrongDirective(message, 'write `{ include("file.asl") }`')
        # As in Jason, local namespaces are local to their file.
        namespaces = Namespaces(parser.namespaces.current)
        if namespace:
            namespaces.current = self._include_namespace(parser, namespace[0])
        found = self._find(parser, path, directive)
        if found is not None:
            self._refuse_circles(found, path)
            self._included += 1
            section.extend(self.read_file(found, namespaces))

    def _refuse_circles(self, found: SourceFile, path: str) -> None:
        if found.name in self._open_files:
            wrong, help = f"file `{path}` includes itself", "break the cycle: files cannot include each other"
        elif len(self._open_files) > _DEEPEST:
            wrong = f"file `{path}` is included more than {_DEEPEST} levels deep"
            help = "include it from a file further up"
        elif self._included >= _MOST_INCLUDES:
            wrong, help = f"program includes more than {_MOST_INCLUDES} files", "include each file once"
        else:
            return
        raise WrongDirective(wrong, help, code="include-circle")

    def _find(self, parser: ProgramParser, path: str, directive: nodes.Literal) -> SourceFile | None:
        """Return the included file; None for most libraries of other systems."""
        try:
            if self._read is None:
                raise FileNotFoundError(path)
            return SourceFile(*self._read(path, parser.file.name))
        except FileNotFoundError as missing:
            if not is_library(path):
                message = f"included file not found: `{path}`"
                raise WrongDirective(message, str(missing), code="include-not-found") from None
        except (OSError, UnicodeError) as error:
            message = f"cannot read the included file `{path}`: {error}"
            raise WrongDirective(message, code="include-not-found") from error
        name = path.rpartition("/")[2]
        if name in _OURS:
            file = Path(__file__).parent / "library" / _OURS[name]
            return SourceFile(f"$jacaros/{file.name}", file.read_text(encoding="utf-8"))
        if name in _ORGANISATIONS:
            self._warn_of_organisations(parser, path, directive)
        elif name not in _KNOWN:
            message = f"unknown library `{path}`: nothing is included"
            parser.warn("unknown-library", message, _place(directive))
        return None

    def _warn_of_organisations(self, parser: ProgramParser, path: str, directive: nodes.Literal) -> None:
        """Warn once per program that organisations are not supported: their libraries are included together."""
        if not self._warned_of_organisations:
            self._warned_of_organisations = True
            message = f"nothing of `{path}` is included: organisations are not supported"
            parser.warn("organisation-library", message, _place(directive))

    def _include_namespace(self, parser: ProgramParser, term: nodes.Term) -> str | None:
        match term:
            case nodes.Literal(name, ()) | nodes.String(name):
                return Namespaces().resolve(name)
            case nodes.Variable(name):
                return f"{name}#{next(self._names.local_namespaces)}"
        parser.report("wrong-directive", "the namespace of an include must be an atom", term.span)
        return None

    # namespaces and functions

    def _declare_namespace(
        self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section
    ) -> None:
        """Declare a namespace local or global; without a block it stays empty."""
        self._namespace(parser, directive)
        if len(directive.arguments) == 1:
            message = "this directive has no effect without a block"
            help = "write `{ begin namespace(...) } clauses { end }`"
            parser.warn("wrong-directive", message, _place(directive), help)

    def _namespace(self, parser: ProgramParser, directive: nodes.Literal) -> str | None:
        """Return the namespace that the directive switches to."""
        local = parser.namespaces.local
        match directive.arguments:
            case (nodes.Literal(name, ()),):
                pass
            case (nodes.Literal(name, ()), nodes.Literal("local", ())):
                if name not in local:
                    # A name that cannot be written, so that the namespace cannot be reached from outside.
                    local[name] = f"{name}#{next(self._names.local_namespaces)}"
            case (nodes.Literal(name, ()), nodes.Literal("global", ())):
                local.pop(name, None)
            case _:
                message = "`namespace` expects an atom, and optionally `local` or `global`"
                help = "write `{ begin namespace(robot) }` or `{ namespace(robot, local) }`"
                raise WrongDirective(message, help)
        return parser.namespaces.resolve(name)

    def _register(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        match directive.arguments:
            case (nodes.String(name),):
                if self._names.known.get(name) is None:
                    _warn_of_java_function(parser, directive, name)
            case (nodes.String(name) as written, nodes.Number(arity), nodes.String(rule)):
                if "." not in name.strip(".") or name.startswith("."):
                    message = f"function name `{name}` must contain a dot, but not at the beginning"
                    raise WrongDirective(message, "write a name such as `my.sum`", written.span)
                self._names.functions[name] = int(arity)
                function = nodes.RegisteredFunction(name, int(arity), rule, span=directive.span)
                section.functions.append(function)
            case _:
                message = "`register_function` expects a name, a number of arguments and a rule"
                raise WrongDirective(message, '{ register_function("my.sum", 2, "sum") }')

    # patterns

    def _call(self, parser: ProgramParser, directive: nodes.Literal) -> PatternCall:
        def parse(text: str, read: Callable[[PlanParser], Any], what: str) -> Any:
            text_parser = PlanParser(SourceFile(f"`{text}`", text), self._names, [])
            text_parser.namespaces = parser.namespaces
            return _parse_text(text_parser, read, what)

        arguments = tuple(
            self._placed(parser.namespaces, rebuilt(argument, _named)) for argument in directive.arguments
        )
        number = next(self._pattern_numbers)
        return PatternCall(directive.functor, arguments, directive.span, number, parse)

    def _placed(self, namespaces: Namespaces, argument: nodes.Term) -> nodes.Term:
        """Put a goal or belief given to a pattern into the namespace of the block."""
        if isinstance(argument, nodes.Literal) and argument.namespace is None:
            return nodes.replace(argument, namespace=namespaces.of_literal(argument.functor))
        return argument


def _report(parser: ProgramParser, directive: nodes.Literal, wrong: WrongDirective) -> None:
    parser.report(wrong.code, str(wrong), wrong.span or directive.span, wrong.help)


def _warn_of_java_function(parser: ProgramParser, directive: nodes.Literal, name: str) -> None:
    module, _, function = name.rpartition(".")
    parser.warn(
        "java-function",
        f"function `{name}` is written in Java and not available",
        _place(directive),
        f"write it in Python: a function {function} with @arithmetic_function in {module.replace('.', '/')}.py; "
        'or as a rule: { register_function("my.sum", 2, "sum") }',
    )


def _parse_text(parser: PlanParser, read: Callable[[PlanParser], Any], what: str) -> Any:
    """Parse the whole text of *parser* with *read*; an invalid text is an invalid argument of the directive."""
    try:
        result = read(parser)
    except SyntaxPanic:
        result = None
    if result is None or parser.token.kind != "end" or parser.diagnostics:
        reason = parser.diagnostics[0].message if parser.diagnostics else f"unexpected `{parser.token.text}`"
        raise WrongDirective(f"{parser.file.name} is not a {what}: {reason}")
    return result


def _named(node: nodes.Node) -> nodes.Node:
    """Give an unnamed variable a name, so that it means the same in several places of a plan."""
    unnamed = isinstance(node, nodes.Variable) and node.unnamed
    return nodes.replace(node, unnamed=False) if unnamed else node


def _meant(name: str) -> str | None:
    return suggestion(name, [*_SIMPLE, *PATTERNS]) or None


def _place(directive: nodes.Literal) -> Span:
    """Return the place of a directive, which the parser always sets."""
    assert directive.span is not None
    return directive.span
