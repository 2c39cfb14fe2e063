"""Conditions that ask for the past of beliefs of which no history is kept."""

from collections.abc import Iterator, Sequence

from jacaros.asl import nodes
from jacaros.asl.checks.beliefs import key_of
from jacaros.asl.checks.formulas import conditions, parts_of
from jacaros.asl.diagnostics import Diagnostic
from jacaros.asl.directives.history import asks_for_past


def undeclared_histories(program: nodes.Program, found: Sequence[nodes.Node]) -> Iterator[Diagnostic]:
    """Report ``b(X)[ago(Ms)]`` without ``{ history(b(_), within(Ms)) }``, which no belief answers."""
    kept = {(each.belief.namespace, *key_of(each.belief)) for each in program.histories}
    for node in found:
        for condition in conditions(node):
            for part in parts_of(condition):
                if (
                    isinstance(part, nodes.Literal)
                    and asks_for_past(part)
                    and not isinstance(part.namespace, nodes.Variable)
                    and (part.namespace, *key_of(part)) not in kept
                ):
                    yield _undeclared(part)


def _undeclared(literal: nodes.Literal) -> Diagnostic:
    arguments = f"({', '.join('_' * len(literal.arguments))})" if literal.arguments else ""
    belief = f"{literal.functor}{arguments}"
    return Diagnostic(
        "warning",
        f"no history of `{belief}` is kept: `ago` finds nothing",
        literal.span,
        f"declare {{ history({belief}, within(2000)) }}",
        "no-history",
    )
