"""Check for conditions on the past of beliefs without a history."""

from collections.abc import Iterator

from jacaros.asl import nodes
from jacaros.asl.checks.beliefs import key_of
from jacaros.asl.checks.formulas import clauses as clauses_of
from jacaros.asl.checks.formulas import conditions, parts_of
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.directives.history import asks_for_past
from jacaros.asl.walk import walk


def undeclared_histories(program: nodes.Program) -> Iterator[nodes.Literal]:
    """Yield each ``b(X)[ago(Ms)]`` without ``{ history(b(_), within(Ms)) }`` in the program."""
    kept = {(each.belief.namespace, *key_of(each.belief)) for each in program.histories}
    for node in walk(*clauses_of(program)):
        for condition in conditions(node):
            for part in parts_of(condition):
                if (
                    isinstance(part, nodes.Literal)
                    and asks_for_past(part)
                    and not isinstance(part.namespace, nodes.Variable)
                    and (part.namespace, *key_of(part)) not in kept
                ):
                    yield part


def no_history(literal: nodes.Literal) -> Diagnostic:
    """Return the warning about a condition that no belief answers."""
    arguments = f"({', '.join('_' * len(literal.arguments))})" if literal.arguments else ""
    belief = f"{literal.functor}{arguments}"
    return Diagnostic(
        "warning",
        f"no history of `{belief}` is kept: `ago` finds nothing",
        literal.span,
        f"declare `{{ history({belief}, within(2000)) }}`, or `history: 2` in the mapping file of a property",
        "no-history",
    )
