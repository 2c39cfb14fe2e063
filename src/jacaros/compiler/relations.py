"""Code for relations in conditions: comparisons, unification and ``=..``."""

from jacaros.asl import nodes
from jacaros.compiler.answers import undoing
from jacaros.compiler.building import as_name, build, is_number
from jacaros.compiler.function import FunctionBuilder
from jacaros.compiler.matching import Then
from jacaros.compiler.variables import names_in

_COMPARE = {
    "<": "less({0}, {1})",
    "<=": "at_most({0}, {1})",
    ">": "less({1}, {0})",
    ">=": "at_most({1}, {0})",
}
BINDING_NOTHING = (*_COMPARE, "==", "\\==")
"""The operators of relations that `comparison` can write."""


def relation(fn: FunctionBuilder, node: nodes.Relation, then: Then) -> None:
    """A test of a relation, which may bind variables."""
    if node.operator == "=":
        _unification(fn, node, then)
    elif node.operator == "=.." and isinstance(node.left, nodes.Variable) and node.left.namespace is not None:
        _deconstruction_in_namespace(fn, node, node.left, then)
    elif node.operator == "=..":
        left, right = build(fn, node.left), build(fn, node.right)
        undoing(fn, f"deconstruct({left}, {right}, t)", [], then)
    else:
        with fn.writer.block(f"if {comparison(fn, node)}:"):
            then()


def _deconstruction_in_namespace(
    fn: FunctionBuilder, node: nodes.Relation, variable: nodes.Variable, then: Then
) -> None:
    """``ns::X =.. L`` and ``NS::X =.. L``: the literal that is made may be of that namespace."""
    namespace = variable.namespace
    place = build(fn, namespace) if isinstance(namespace, nodes.Variable) else repr(namespace)
    left, right = build(fn, nodes.replace(variable, namespace=None)), build(fn, node.right)
    undoing(fn, f"deconstruct_in({place}, {left}, {right}, t)", [], then)


def comparison(fn: FunctionBuilder, node: nodes.Relation) -> str:
    """An expression for a relation that binds nothing."""
    left, right = as_name(fn, build(fn, node.left)), as_name(fn, build(fn, node.right))
    tests = [f"{o}.__class__ is float" for o in dict.fromkeys((left, right)) if not is_number(o)]
    if node.operator in ("==", "\\=="):
        plain = f"{left} == {right}"
        general = f"equal({left}, {right})"
        value = f"({plain} if {' and '.join(tests)} else {general})" if tests else f"({plain})"
        return f"not {value}" if node.operator == "\\==" else value
    general = _COMPARE[node.operator].format(left, right)
    plain = f"{left} {node.operator} {right}"
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
    return (
        not node.unnamed
        and node.annotations is None
        and node.namespace is None
        and not node.negated
        and node.name not in fn.values
    )
