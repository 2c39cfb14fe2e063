"""Code that finds annotations among those of a belief or an event.

The annotations of a pattern are looked for in their order, each among those that are held, from the first to the last:
nested loops, as `jacaros.terms.unifier.each_annotation_match` has them.  Tails, and patterns whose order depends on the
values of variables, are left to that function.
"""

from jacaros.asl import nodes
from jacaros.bdi.fast.generated.building import (
    annotation_parts,
    build,
    constant_value,
    functor_of_literal,
    is_static,
    resolved,
    tuple_of,
)
from jacaros.bdi.fast.generated.function import FunctionBuilder
from jacaros.bdi.fast.generated.matching import Then, match
from jacaros.terms.values import SOURCE

_MOST = 4


def patterns_in_order(annotations: nodes.Annotations) -> list[nodes.Term] | None:
    """The annotations in the order in which they are looked for; None when it is not known before they have values."""
    items = annotations.items
    if annotations.tail is not None or not 0 < len(items) <= _MOST:
        return None
    if len(items) == 1:
        return list(items) if isinstance(items[0], nodes.Literal | nodes.Variable) else None
    by_name: dict[tuple[str, str, bool], nodes.Term] = {}
    for item in items:
        if not isinstance(item, nodes.Literal) or isinstance(item.namespace, nodes.Variable):
            return None
        by_name[item.namespace or "", item.functor, item.negated] = item
    # Of two with the same name the arguments decide; `annotation_set` compares them when they are known.
    return [by_name[name] for name in sorted(by_name)] if len(by_name) == len(items) else None


_SOURCE_SELF = nodes.Literal("source", (nodes.Literal("self"),))


def own_annotations(fn: FunctionBuilder, annotations: nodes.Annotations) -> str:
    """An expression for the annotations of a belief of one's own, ``source(self)`` among them when no source is named.

    They are sorted while the plan is compiled, unless their order depends on values.
    """
    known = _own_in_order(fn, annotations)
    if known is not None:
        return known
    items, tail = annotation_parts(fn, annotations)
    return f"own_annotations({items}, {tail})"


def _own_in_order(fn: FunctionBuilder, annotations: nodes.Annotations) -> str | None:
    items = annotations.items
    if not any(_is_source(item) for item in items):
        items = (*items, _SOURCE_SELF)
    patterns = patterns_in_order(nodes.Annotations(items, annotations.tail))
    if patterns is None:
        return None
    literals = [item for item in patterns if isinstance(item, nodes.Literal) and item.annotations is None]
    if len(literals) < len(patterns):
        return None
    if all(map(is_static, literals)):
        return fn.constant(tuple(map(constant_value, literals)))
    return tuple_of([_resolved_literal(fn, literal) for literal in literals])


def _is_source(item: nodes.Term) -> bool:
    if not isinstance(item, nodes.Literal) or isinstance(item.namespace, nodes.Variable):
        return False
    return functor_of_literal(item) is SOURCE


def _resolved_literal(fn: FunctionBuilder, literal: nodes.Literal) -> str:
    if is_static(literal):
        return build(fn, literal)
    arguments = [resolved(fn, build(fn, a)) for a in literal.arguments]
    return tuple_of([fn.constant(functor_of_literal(literal)), *arguments])


def each_match(fn: FunctionBuilder, patterns: list[nodes.Term], held: str, then: Then) -> None:
    """Write a search for the patterns among the annotations *held*, with *then* once for every way to find them."""
    if not patterns:
        then()
        return
    candidate, mark = fn.local("c"), fn.local("n")
    with fn.writer.block(f"for {candidate} in {held}:"):
        _pass_over_others(fn, patterns[0], candidate)
        fn.line(f"{mark} = len(t)")
        match(fn, patterns[0], candidate, lambda: each_match(fn, patterns[1:], held, then))
        fn.line(f"if len(t) > {mark}: undo(t, {mark})")


def _pass_over_others(fn: FunctionBuilder, pattern: nodes.Term, candidate: str) -> None:
    """Skip annotations that cannot match: their functor shows it."""
    if (
        isinstance(pattern, nodes.Literal)
        and pattern.arguments
        and not isinstance(pattern.namespace, nodes.Variable)
    ):
        symbol = fn.constant(functor_of_literal(pattern))
        fn.line(f"if {candidate}.__class__ is tuple and {candidate}[0] is not {symbol}: continue")


def first_match(fn: FunctionBuilder, patterns: list[nodes.Term], held: str, then: Then) -> None:
    """Write a search for the first way to find the patterns among the annotations *held*, and *then* behind it."""
    found = fn.local("f")
    known: dict[str, str] = {}
    fn.line(f"{found} = False")

    def one(index: int) -> None:
        candidate, mark = fn.local("c"), fn.local("n")

        def matched() -> None:
            if index + 1 < len(patterns):
                one(index + 1)
                fn.line(f"if {found}: break")
            else:
                fn.line(f"{found} = True")
                fn.line("break")
                known.update(fn.values)

        with fn.writer.block(f"for {candidate} in {held}:"):
            _pass_over_others(fn, patterns[index], candidate)
            fn.line(f"{mark} = len(t)")
            match(fn, patterns[index], candidate, matched)
            fn.line(f"if len(t) > {mark}: undo(t, {mark})")

    one(0)
    with fn.writer.block(f"if {found}:"):
        fn.values = known
        then()
