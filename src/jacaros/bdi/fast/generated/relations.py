"""Code for relations in conditions: comparisons, unification and ``=..``."""

from jacaros.asl import nodes
from jacaros.asl.walk import names_in
from jacaros.bdi.fast.generated.building import as_name, build, is_number, tuple_of
from jacaros.bdi.fast.generated.function import FunctionBuilder
from jacaros.bdi.fast.generated.matching import Then, match_all, undoing
from jacaros.terms.operators import BINARY


def relation(fn: FunctionBuilder, node: nodes.Relation, then: Then) -> None:
    """A test of a relation, which may bind variables."""
    if node.operator == "=":
        _unification(fn, node, then)
    elif node.operator == "=.." and isinstance(node.left, nodes.Variable) and node.left.namespace is not None:
        _deconstruction_in_namespace(fn, node, node.left, then)
    elif node.operator == "=..":
        _deconstruction(fn, node, then)
    else:
        with fn.writer.block(f"if {comparison(fn, node)}:"):
            then()


def _deconstruction(fn: FunctionBuilder, node: nodes.Relation, then: Then) -> None:
    """``X =.. [F, A, N]``: what is met for the first time is neither a term with variables nor unified."""
    left, right = node.left, node.right
    parts = right.items if isinstance(right, nodes.ListTerm) and right.tail is None else ()
    found = fn.local("d")
    if (
        len(parts) in (3, 4)
        and isinstance(left, nodes.Variable)
        and _is_unbound(fn, left)
        and left.name not in names_in(right)
    ):
        fn.line(f"{found} = constructed({tuple_of([build(fn, part) for part in parts])})")
        with fn.writer.block(f"if {found} is not None:"):
            fn.bind(left.name, found)
            then()
        return
    known = build(fn, left)
    if len(parts) in (3, 4) and _take_anything(fn, parts):
        values = [fn.local("p") for _ in parts]
        fn.line(f"{found} = deconstructed({known}, {len(parts)})")
        with fn.writer.block(f"if {found} is not None:"):
            fn.line(f"{tuple_of(values)} = {found}")
            match_all(fn, list(parts), values, then)
        return
    undoing(fn, f"deconstruct({known}, {build(fn, right)}, t)", [], then)


def _take_anything(fn: FunctionBuilder, patterns: tuple[nodes.Term, ...]) -> bool:
    """Whether all are variables, different ones that are met here for the first time."""
    variables = [each for each in patterns if isinstance(each, nodes.Variable) and _is_plain(each)]
    named = [each.name for each in variables if not each.unnamed]
    return (
        len(variables) == len(patterns)
        and len(set(named)) == len(named)
        and not any(name in fn.values for name in named)
    )


def _deconstruction_in_namespace(
    fn: FunctionBuilder, node: nodes.Relation, variable: nodes.Variable, then: Then
) -> None:
    """``ns::X =.. L`` and ``NS::X =.. L``: the literal that is made may be of that namespace."""
    namespace = variable.namespace
    place = build(fn, namespace) if isinstance(namespace, nodes.Variable) else repr(namespace)
    left, right = build(fn, nodes.replace(variable, namespace=None)), build(fn, node.right)
    undoing(fn, f"deconstruct_in({place}, {left}, {right}, t)", [], then)


def comparison(fn: FunctionBuilder, node: nodes.Relation) -> str:
    """An expression for a relation that binds nothing (see `jacaros.terms.substitution.related`)."""
    written = BINARY[node.operator]
    left, right = as_name(fn, build(fn, node.left)), as_name(fn, build(fn, node.right))
    tests = [f"{o}.__class__ is float" for o in dict.fromkeys((left, right)) if not is_number(o)]
    known = (f"compare({left}, {right})", "0") if written.orders else (f"equal({left}, {right})", "True")
    plain, general = written.code_for(left, right), written.code_for(*known)
    return f"({plain} if {' and '.join(tests)} else {general})" if tests else f"({plain})"


def _unification(fn: FunctionBuilder, node: nodes.Relation, then: Then) -> None:
    for side, other in ((node.left, node.right), (node.right, node.left)):
        if isinstance(side, nodes.Variable) and _is_unbound(fn, side) and side.name not in names_in(other):
            fn.bind(side.name, build(fn, other))
            then()
            return
    left, right = build(fn, node.left), build(fn, node.right)
    undoing(fn, f"unify({left}, {right}, t)", names_in(node), then)


def _is_unbound(fn: FunctionBuilder, node: nodes.Variable) -> bool:
    return _is_plain(node) and not node.unnamed and node.name not in fn.values


def _is_plain(node: nodes.Variable) -> bool:
    return node.annotations is None and node.namespace is None and not node.negated
