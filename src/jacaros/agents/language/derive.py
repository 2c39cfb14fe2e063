"""``{ derive(name, pattern) }``: a belief or event composed of changes of beliefs.

>>> from jacaros.agents.language.loader import load_program
>>> program, _ = load_program("robot.asl", "{ derive(often, count(bump(_), within(5000), at_least(3))) }")
>>> program.derived[0].options
(('within', 5.0), ('at_least', 3.0))
>>> format_derivation(program.derived[0])
'{ derive(often, count(bump(_), within(5000), at_least(3))) }'
"""

from collections.abc import Callable, Iterator, Mapping
from typing import Any, Final, cast

from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import format_term
from jacaros.agents.language.nodes import is_ground
from jacaros.agents.language.program_parser import WrongDirective
from jacaros.agents.terms.text import number_text
from jacaros.artifacts.streams.pattern import OPERATORS, faults, unknown

EXAMPLE: Final = "write `{ derive(bumped_often, count(bump(_), within(5000), at_least(3))) }`"
_TIMES: Final = {"within": "within", "lasting": "for"}
"""Options in milliseconds, and their names in the schema, where they are in seconds (`for` is a keyword)."""

_OF_MAPPINGS: Final = {
    "equals": "write the value into the belief, as in `door(open)`",
    "lateness": "remove it: an agent handles changes in order, so none is late",
}
"""Options that only mapping files have, and the alternative here."""

Placed = Callable[[nodes.Term], nodes.Term]
"""Puts a literal without a namespace into that of its block."""

Mistakes = list[WrongDirective]


def read_derivation(
    directive: nodes.Literal, namespace: str | None, placed: Placed
) -> tuple[nodes.Derivation | None, Mistakes]:
    """Return the derivation that the directive declares, and its mistakes."""
    match directive.arguments:
        case (
            nodes.Literal(arguments=(), negated=False, annotations=None) as name,
            nodes.Literal(operator, arguments) as pattern,
        ):
            pass
        case _:
            return None, [WrongDirective("`derive` expects a name and a pattern", EXAMPLE)]
    if operator not in OPERATORS:
        fault = unknown(operator)
        return None, [WrongDirective(fault.message, fault.help, pattern.span)]
    if not arguments:
        return None, [WrongDirective(f"`{operator}` expects a belief", EXAMPLE, pattern.span)]
    first, *rest = arguments
    wrong: Mistakes = []
    several = OPERATORS[operator].several and isinstance(first, nodes.ListTerm)
    written_streams = first.items if several and isinstance(first, nodes.ListTerm) else (first,)
    streams = [each for each in written_streams if _is_stream(each, operator, wrong)]
    placed_streams = cast("list[nodes.Literal]", list(map(placed, streams)))
    options = dict(_options(rest, wrong))
    values = {name: value for name, (value, _) in options.items()}
    for fault in faults(operator, list(map(written, placed_streams)), values):
        place = options[fault.option][1] if fault.option in options else pattern
        wrong.append(WrongDirective(_as_written(fault.message), _as_written(fault.help), place.span))
    if OPERATORS[operator].valued and streams:
        _check_values(operator, placed_streams[0], values, wrong)
    made = nodes.Derivation(
        name.functor, namespace, operator, tuple(placed_streams), tuple(values.items()), span=directive.span
    )
    return made, wrong


def _is_stream(term: nodes.Term, operator: str, wrong: Mistakes) -> bool:
    if not isinstance(term, nodes.Literal):
        help = "write its name and arguments, such as `bump(_)`"
        wrong.append(WrongDirective(f"`{operator}` expects a belief", help, term.span))
        return False
    if term.annotations is not None:
        wrong.append(WrongDirective("annotations have no effect here", "remove them", term.span))
    for argument in term.arguments:
        if not isinstance(argument, nodes.Variable) and not is_ground(argument):
            help = "write `_` for the whole argument"
            wrong.append(WrongDirective("variable within a term", help, argument.span))
    return True


def _options(terms: list[nodes.Term], wrong: Mistakes) -> Iterator[tuple[str, tuple[Any, nodes.Node]]]:
    """Yield the names of options, with values as in the schema and places."""
    for term in terms:
        if not isinstance(term, nodes.Literal) or not term.arguments:
            help = "write options after the belief, such as `within(5000)`"
            wrong.append(WrongDirective("expected an option", help, term.span))
        elif term.functor in _OF_MAPPINGS:
            message = f"option `{term.functor}` exists in mapping files only"
            wrong.append(WrongDirective(message, _OF_MAPPINGS[term.functor], term.span))
        else:
            values = [_constant(each) for each in term.arguments]
            value: Any = values[0] if len(values) == 1 else tuple(values)
            if term.functor in _TIMES and isinstance(value, float):
                value /= 1000.0
            yield _TIMES.get(term.functor, term.functor), (value, term)


def _check_values(
    operator: str, stream: nodes.Literal, options: Mapping[str, object], wrong: Mistakes
) -> None:
    bare = operator == "held" and not {"above", "below"} & options.keys()
    if len(values_of(stream)) != (0 if bare else 1):
        wanted = "no named variables" if bare else "1 named variable"
        help = "make one argument a variable, and the others `_`"
        if bare:
            help = "write `_` for the arguments that do not matter"
        wrong.append(WrongDirective(f"`{operator}` expects {wanted} in its belief", help, stream.span))


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
