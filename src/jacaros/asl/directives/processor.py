"""Run the directives of a program: includes, namespaces, functions and goal patterns."""

from collections.abc import Callable
from itertools import count
from typing import Any, Final

from jacaros.asl import nodes
from jacaros.asl.cursor import Names, SyntaxPanic
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.directives.goal_patterns import PATTERNS, apply_pattern
from jacaros.asl.directives.libraries import counterpart, is_known_library, is_library, is_of_organisations
from jacaros.asl.directives.pattern import PatternCall, PatternError
from jacaros.asl.literal_parser import Namespaces
from jacaros.asl.plan_parser import PlanParser
from jacaros.asl.program_parser import ProgramParser
from jacaros.asl.source import SourceFile, Span
from jacaros.asl.walk import rebuilt
from jacaros.suggestions import suggestion

Read = Callable[[str, str], tuple[str, str]]
"""``read(path, including_name) -> (name, text)``: finds an included file; raises FileNotFoundError,
whose text says where it was searched."""

_SIMPLE: Final = ("derive", "include", "namespace", "register_function")
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
        self._derived: list[nodes.Derivation] = []

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
        if name == "include":
            section.extend(self._include(parser, directive))
        elif name == "namespace":
            self._declare_namespace(parser, directive)
        elif name == "register_function":
            function = self._function(parser, directive)
            if function is not None:
                section.functions.append(function)
        elif name == "derive":
            self._derive(parser, directive, section)
        elif name in PATTERNS:
            parser.report(
                "wrong-directive",
                f"`{name}` expects a block",
                directive.span,
                f"{{ begin {name}(...) }} plans {{ end }}",
            )
        else:
            parser.report("unknown-directive", f"unknown directive `{name}`", directive.span, _meant(name))

    def apply_to_block(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        """Parse the block of a directive and add the resulting clauses to *section*."""
        name = directive.functor
        if name == "namespace":
            outside = parser.namespaces.current
            parser.namespaces.current = self._namespace(parser, directive)
            section.extend(parser.block(directive))
            parser.namespaces.current = outside
            return
        if name not in PATTERNS:
            help = f"write `{{ {name}(...) }}` without `begin`" if name in _SIMPLE else _meant(name)
            parser.report(
                "unknown-directive", f"unknown directive `{name}` with a block", directive.span, help
            )
            section.extend(parser.block(directive))
            return
        block = parser.block(directive)
        try:
            section.extend(apply_pattern(self._call(parser, directive), block))
        except PatternError as error:
            parser.report("wrong-directive", str(error), directive.span, error.help)
            section.extend(block)

    # include

    def _include(self, parser: ProgramParser, directive: nodes.Literal) -> nodes.Section:
        arguments = directive.arguments
        if not 1 <= len(arguments) <= 2 or not isinstance(arguments[0], nodes.String):
            parser.report(
                "wrong-directive",
                "`include` expects the name of a file as a string",
                directive.span,
                'write `{ include("file.asl") }`',
            )
            return nodes.Section()
        path = arguments[0].value
        # As in Jason, local namespaces are local to their file.
        namespaces = Namespaces(parser.namespaces.current)
        if len(arguments) == 2:
            namespaces.current = self._include_namespace(parser, arguments[1])
        found = self._find(parser, path, directive)
        if found is None:
            return nodes.Section()
        if found.name in self._open_files:
            wrong, help = f"file `{path}` includes itself", "break the cycle: files cannot include each other"
        elif len(self._open_files) > _DEEPEST:
            wrong = f"file `{path}` is included more than {_DEEPEST} levels deep"
            help = "include it from a file further up"
        elif self._included >= _MOST_INCLUDES:
            wrong, help = f"program includes more than {_MOST_INCLUDES} files", "include each file once"
        else:
            wrong = help = ""
        if wrong:
            parser.report("include-circle", wrong, directive.span, help)
            return nodes.Section()
        self._included += 1
        return self.read_file(found, namespaces)

    def _find(self, parser: ProgramParser, path: str, directive: nodes.Literal) -> SourceFile | None:
        """Return the included file; None for most libraries of other systems."""
        try:
            if self._read is None:
                raise FileNotFoundError(path)
            name, text = self._read(path, parser.file.name)
            return SourceFile(name, text)
        except FileNotFoundError as missing:
            ours = counterpart(path)
            if ours is not None or is_known_library(path):
                return ours
            if is_of_organisations(path):
                self._warn_of_organisations(parser, path, directive)
                return None
            if is_library(path):
                parser.warn(
                    "unknown-library",
                    f"unknown library `{path}`: nothing is included",
                    _place(directive),
                )
                return None
            parser.report(
                "include-not-found",
                f"included file not found: `{path}`",
                directive.span,
                str(missing),
            )
        except (OSError, UnicodeError) as error:
            parser.report(
                "include-not-found", f"cannot read the included file `{path}`: {error}", directive.span
            )
        return None

    def _warn_of_organisations(self, parser: ProgramParser, path: str, directive: nodes.Literal) -> None:
        """Warn once per program that organisations are not supported: their libraries are included together."""
        if not self._warned_of_organisations:
            self._warned_of_organisations = True
            parser.warn(
                "organisation-library",
                f"nothing of `{path}` is included: organisations are not supported",
                _place(directive),
            )

    def _include_namespace(self, parser: ProgramParser, term: nodes.Term) -> str | None:
        if isinstance(term, nodes.Literal) and not term.arguments:
            return Namespaces().resolve(term.functor)
        if isinstance(term, nodes.String):
            return Namespaces().resolve(term.value)
        if isinstance(term, nodes.Variable):
            return f"{term.name}#{next(self._names.local_namespaces)}"
        parser.report("wrong-directive", "the namespace of an include must be an atom", term.span)
        return None

    # namespaces and functions

    def _declare_namespace(self, parser: ProgramParser, directive: nodes.Literal) -> None:
        """Declare a namespace local or global; without a block it stays empty."""
        before = len(self._diagnostics)
        self._namespace(parser, directive)
        if len(directive.arguments) == 1 and directive.span is not None and len(self._diagnostics) == before:
            parser.warn(
                "wrong-directive",
                "this directive has no effect without a block",
                directive.span,
                "write `{ begin namespace(...) } clauses { end }`",
            )

    def _namespace(self, parser: ProgramParser, directive: nodes.Literal) -> str | None:
        """Return the namespace that the directive switches to."""
        arguments = directive.arguments
        names = [term.functor for term in arguments if isinstance(term, nodes.Literal) and not term.arguments]
        if (
            not 1 <= len(arguments) <= 2
            or len(names) != len(arguments)
            or names[1:] not in ([], ["local"], ["global"])
        ):
            parser.report(
                "wrong-directive",
                "`namespace` expects an atom, and optionally `local` or `global`",
                directive.span,
                "write `{ begin namespace(robot) }` or `{ namespace(robot, local) }`",
            )
            return parser.namespaces.current
        name = names[0]
        if names[1:] == ["local"] and name not in parser.namespaces.local:
            # A name that cannot be written, so that the namespace cannot be reached from outside.
            parser.namespaces.local[name] = f"{name}#{next(self._names.local_namespaces)}"
        elif names[1:] == ["global"]:
            parser.namespaces.local.pop(name, None)
        return parser.namespaces.resolve(name)

    def _function(self, parser: ProgramParser, directive: nodes.Literal) -> nodes.RegisteredFunction | None:
        arguments = directive.arguments
        if len(arguments) == 1 and isinstance(arguments[0], nodes.String):
            if self._names.known.get(arguments[0].value) is None:
                _warn_of_java_function(parser, directive, arguments[0].value)
            return None
        match arguments:
            case (nodes.String(value=name), nodes.Number(value=arity), nodes.String(value=rule)):
                if "." not in name.strip(".") or name.startswith("."):
                    parser.report(
                        "wrong-directive",
                        f"function name `{name}` must contain a dot, but not at the beginning",
                        arguments[0].span,
                        "write a name such as `my.sum`",
                    )
                    return None
                self._names.functions[name] = int(arity)
                return nodes.RegisteredFunction(name, int(arity), rule, span=directive.span)
        parser.report(
            "wrong-directive",
            "`register_function` expects a name, a number of arguments and a rule",
            directive.span,
            '{ register_function("my.sum", 2, "sum") }',
        )
        return None

    def _derive(self, parser: ProgramParser, directive: nodes.Literal, section: nodes.Section) -> None:
        from jacaros.asl.directives.derive import (
            circle,
            read_derivation,
        )  # imported here: few programs use `derive`

        def report(message: str, span: Span | None, help: str) -> None:
            parser.report("wrong-directive", message, span or directive.span, help)

        def placed(term: nodes.Term) -> nodes.Term:
            return self._placed(parser.namespaces, term)

        made = read_derivation(directive, parser.namespaces.current, placed, report)
        if made is None:
            return
        self._derived.append(made)
        if circle(self._derived) is not None:
            report(f"`{made.name}` is derived from itself", directive.span, "derive it from other beliefs")
            self._derived.pop()
            return
        section.derived.append(made)

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
        raise PatternError(f"{parser.file.name} is not a {what}: {reason}")
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
