"""``{ history(range(_), within(2000)) }``: keep past values of a belief for conditions with `ago(Ms)`."""

from typing import TYPE_CHECKING, Final

from jacaros.asl import nodes
from jacaros.terms.text import number_text

if TYPE_CHECKING:
    from jacaros.asl.directives.derive import Placed, Report

EXAMPLE: Final = "write `{ history(range(_), within(2000)) }`"


def read_history(directive: nodes.Literal, placed: "Placed", report: "Report") -> nodes.History | None:
    """Return the history that the directive declares, or None after reporting an error."""
    from jacaros.streams.schema import (
        LONGEST,
    )  # imported here: all conditions of programs call `asks_for_past`

    match directive.arguments:
        case (
            nodes.Literal() as belief,
            nodes.Literal(functor="within", arguments=(nodes.Number(value=window),), annotations=None),
        ):
            pass
        case (nodes.Literal(), nodes.Literal(functor="within", arguments=(_,)) as within):
            report("`within` must be above zero", within.span, "write a positive number of milliseconds")
            return None
        case _:
            report("`history` expects a belief and `within`", directive.span, EXAMPLE)
            return None
    if not 0.0 < window <= LONGEST * 1000.0:
        message = "`within` must be above zero" if window <= 0.0 else "`within` is longer than a day"
        report(message, directive.arguments[1].span, "write a positive number of milliseconds, at most a day")
        return None
    if belief.annotations is not None:
        report("annotations have no effect here", belief.span, "remove them")
        return None
    for argument in belief.arguments:
        if not isinstance(argument, nodes.Variable) or not argument.unnamed:
            report("a history keeps all values of a belief", argument.span, "write `_` for each argument")
            return None
    found = placed(belief)
    assert isinstance(found, nodes.Literal)
    return nodes.History(found, window / 1000.0, span=directive.span)


def format_history(history: nodes.History) -> str:
    """Return the directive as text, equal for equal ones."""
    from jacaros.asl.directives.derive import milliseconds, written  # imported here for the same reason

    window = number_text(milliseconds(history.window))
    return f"{{ history({written(history.belief)}, within({window})) }}"


def asks_for_past(literal: nodes.Literal) -> bool:
    """Return whether `ago(Ms)` is among the annotations of a literal."""
    items = () if literal.annotations is None else literal.annotations.items
    return any(map(_is_ago, items))


def _is_ago(item: nodes.Node) -> bool:
    return (
        isinstance(item, nodes.Literal)
        and item.functor == "ago"
        and len(item.arguments) == 1
        and item.namespace is None
        and not item.negated
    )
