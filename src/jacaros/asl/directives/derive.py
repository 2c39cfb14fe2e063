"""``{ derive(name, pattern) }``: a belief or event composed of changes of beliefs."""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final

from jacaros.asl import nodes
from jacaros.asl.cursor import WrongDirective
from jacaros.asl.formatter import format_term
from jacaros.asl.source import Span
from jacaros.asl.walk import is_ground
from jacaros.streams.schema import OPERATORS, Fault, faults, unknown
from jacaros.terms.text import number_text

EXAMPLE: Final = "write `{ derive(bumped_often, count(bump(_), within(5000), at_least(3))) }`"
_TIMES: Final = {"within": "within", "lasting": "for"}
"""Options in milliseconds, and their names in the schema, where they are in seconds (`for` is a keyword)."""

_OF_MAPPINGS: Final = {
    "equals": "write the value into the belief, as in `door(open)`",
    "lateness": "remove it: an agent handles changes in order, so none is late",
}
"""Options that only mapping files have, and the alternative here."""

Report = Callable[[WrongDirective], None]
"""Reports a mistake."""

Placed = Callable[[nodes.Term], nodes.Term]
"""Puts a literal without a namespace into that of its block."""


def read_derivation(
    directive: nodes.Literal, namespace: str | None, placed: Placed, report: Report
) -> nodes.Derivation | None:
    """Return the derivation that the directive declares, or None after reporting an error."""
    match directive.arguments:
        case (
            nodes.Literal(arguments=(), negated=False, annotations=None) as name,
            nodes.Literal() as pattern,
        ):
            reader = _Reader(report, placed)
            made = reader.read(name, pattern, namespace, directive.span)
            return None if reader.wrong else made
    raise WrongDirective("`derive` expects a name and a pattern", EXAMPLE)


class _Reader:
    """Reads one pattern, and records whether it has errors."""

    def __init__(self, report: Report, placed: Placed) -> None:
        self.wrong = False
        self._placed = placed
        self._report = report

    def _report_error(self, message: str, place: nodes.Node, help_: str) -> None:
        self.wrong = True
        self._report(WrongDirective(message, help_, place.span))

    def read(
        self, name: nodes.Literal, pattern: nodes.Literal, namespace: str | None, span: Span | None
    ) -> nodes.Derivation | None:
        operator = pattern.functor
        if operator not in OPERATORS or not pattern.arguments:
            fault = (
                unknown(operator)
                if operator not in OPERATORS
                else Fault("", f"`{operator}` expects a belief", EXAMPLE)
            )
            self._report_error(fault.message, pattern, fault.help)
            return None
        first, *rest = pattern.arguments
        streams = list(self._streams(first, OPERATORS[operator].several, operator))
        options, places = self._options(rest)
        for fault in list(faults(operator, [written(each) for each in streams], options)):
            self._report_error(
                _as_written(fault.message), places.get(fault.option, pattern), _as_written(fault.help)
            )
        if OPERATORS[operator].valued and streams:
            self._check_values(operator, streams[0], options)
        return nodes.Derivation(
            name.functor, namespace, operator, tuple(streams), tuple(options.items()), span=span
        )

    def _streams(self, term: nodes.Term, several: bool, operator: str) -> Iterator[nodes.Literal]:
        terms = term.items if several and isinstance(term, nodes.ListTerm) else (term,)
        for each in terms:
            if not isinstance(each, nodes.Literal):
                self._report_error(
                    f"`{operator}` expects a belief", each, "write its name and arguments, such as `bump(_)`"
                )
                continue
            if each.annotations is not None:
                self._report_error("annotations have no effect here", each, "remove them")
            for argument in each.arguments:
                if not isinstance(argument, nodes.Variable) and not is_ground(argument):
                    self._report_error("variable within a term", argument, "write `_` for the whole argument")
            found = self._placed(each)
            assert isinstance(found, nodes.Literal)
            yield found

    def _options(self, terms: list[nodes.Term]) -> tuple[dict[str, Any], dict[str, nodes.Node]]:
        found: dict[str, Any] = {}
        places: dict[str, nodes.Node] = {}
        for term in terms:
            if not isinstance(term, nodes.Literal) or not term.arguments:
                self._report_error(
                    "expected an option", term, "write options after the belief, such as `within(5000)`"
                )
                continue
            if term.functor in _OF_MAPPINGS:
                self._report_error(
                    f"option `{term.functor}` exists in mapping files only", term, _OF_MAPPINGS[term.functor]
                )
                continue
            name = _TIMES.get(term.functor, term.functor)
            places[name] = term
            values = [_constant(each) for each in term.arguments]
            if len(values) > 1:
                found[name] = tuple(values)
            elif term.functor in _TIMES and isinstance(values[0], float):
                found[name] = values[0] / 1000.0
            else:
                found[name] = values[0]
        return found, places

    def _check_values(self, operator: str, stream: nodes.Literal, options: Mapping[str, object]) -> None:
        bare = operator == "held" and not {"above", "below"} & options.keys()
        if len(values_of(stream)) != (needed := 0 if bare else 1):
            self._report_error(
                f"`{operator}` expects {needed or 'no'} named variable{'s' if bare else ''} in its belief",
                stream,
                "write `_` for the arguments that do not matter"
                if bare
                else "make one argument a variable, and the others `_`",
            )


def values_of(stream: nodes.Literal) -> list[int]:
    """Return the indices of the arguments that are named variables: the values of an event."""
    return [
        place
        for place, argument in enumerate(stream.arguments)
        if isinstance(argument, nodes.Variable) and not argument.unnamed
    ]


def _constant(term: nodes.Term) -> object:
    """Return the number that a term is; another term is returned as it is, and is wrong."""
    if isinstance(term, nodes.Number):
        return term.value
    if isinstance(term, nodes.Arithmetic) and term.operator == "-" and len(term.operands) == 1:
        value = _constant(term.operands[0])
        return -value if isinstance(value, float) else term
    return term


def written(stream: nodes.Literal) -> str:
    """Return a name for a stream, equal for equal ones."""
    return format_term(nodes.replace(stream, arguments=tuple(map(_named_alike, stream.arguments))))


def _named_alike(term: nodes.Term) -> nodes.Term:
    return nodes.replace(term, name="_") if isinstance(term, nodes.Variable) and term.unnamed else term


def _as_written(text: str) -> str:
    """Rewrite a message of the schema with the option names of programs."""
    return (
        text.replace("`for`", "`lasting`").replace("options: for", "options: lasting").replace(", equals", "")
    )


def streams_of(derived: nodes.Derivation) -> tuple[str, ...]:
    """Return names for the streams of a declaration, in order, equal for equal ones."""
    return tuple(map(written, derived.streams))


def format_derivation(derived: nodes.Derivation) -> str:
    """Return the directive as text, equal for equal ones, in a block of its namespace if it has one."""
    streams = list(map(written, derived.streams))
    words = [_option(name, value) for name, value in derived.options]
    first = f"[{', '.join(streams)}]" if OPERATORS[derived.operator].several else streams[0]
    pattern = f"{derived.operator}({', '.join([first, *words])})"
    directive = f"{{ derive({derived.name}, {pattern}) }}"
    name = derived.namespace
    return directive if name is None else f"{{ begin namespace({name}) }} {directive} {{ end }}"


def _option(name: str, value: float) -> str:
    """Return an option as programs write it."""
    for here, known in _TIMES.items():
        if name == known:
            return f"{here}({number_text(milliseconds(value))})"
    return f"{name}({number_text(float(value))})"


def milliseconds(seconds: float) -> float:
    """Return the number of milliseconds that is parsed as that number of seconds."""
    exact = seconds * 1000.0
    rounded = round(exact, 6)
    return rounded if rounded / 1000.0 == seconds else exact


def circle(derived: list[nodes.Derivation]) -> bool:
    """Return whether the belief of the last declaration is derived from itself."""
    made_of: dict[tuple[object, str], list[tuple[object, str]]] = {
        (each.namespace, each.name): [(stream.namespace, stream.functor) for stream in each.streams]
        for each in derived
    }
    begin = (derived[-1].namespace, derived[-1].name)
    todo, seen = list(made_of[begin]), set[object]()
    while todo:
        name = todo.pop()
        if name not in seen:
            seen.add(name)
            todo += made_of.get(name, ())
    return begin in seen
