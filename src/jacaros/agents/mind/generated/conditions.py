"""Code for conditions: contexts, tests, bodies of rules, and the questions inside internal actions.

Continuation style: ``condition(fn, formula, then)`` writes a search whose innermost point is what *then* writes; a
literal becomes a loop over rows, a comparison an ``if``. Bindings made on the way are undone when the search continues
(`Trail`), and kept when *then* leaves the function.

Predicates with rules are searched by generators. There are two ways of running them:

* In an ordinary function the generator looks like a loop over rows: it is nested (see `predicates`), or
driven by ``run``
  if it goes deep, or if its answers are taken one by one while other things happen.
* In the body of a rule (``fn.trampoline``) the function is itself such a generator: it yields another
generator to have
  it run and is sent its next answer, so that rules of any depth need no Python recursion.
"""

from collections.abc import Callable
from typing import Any, cast

from jacaros.agents.language import nodes
from jacaros.agents.language.nodes import names_in, operands
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.generated.function import TOP, FunctionBuilder
from jacaros.agents.mind.generated.matching import (
    MAX_DEPTH,
    Then,
    as_name,
    build,
    is_number,
    is_plain,
    is_static,
    loop_binding,
    loop_over_answers,
    match,
    match_all,
    tuple_of,
    undoing,
)
from jacaros.agents.mind.generated.queries import TRUTHS, internal_action, literal, query
from jacaros.agents.terms.operators import BINARY

# Code for relations in conditions: comparisons, unification and ``=..``.


def relation(fn: FunctionBuilder, node: nodes.Relation, then: Then) -> None:
    """A test of a relation, which may bind variables."""
    if node.operator == "=":
        _unification(fn, node, then)
    elif node.operator == "=.." and isinstance(node.left, nodes.Variable) and node.left.namespace is not None:
        _deconstruction_in_namespace(fn, node, node.left, then)
    elif node.operator == "=..":
        _deconstruction(fn, node, then)
    else:
        with fn.block(f"if {comparison(fn, node)}:"):
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
        with fn.block(f"if {found} is not None:"):
            fn.bind(left.name, found)
            then()
        return
    known = build(fn, left)
    if len(parts) in (3, 4) and _take_anything(fn, parts):
        values = [fn.local("p") for _ in parts]
        fn.line(f"{found} = deconstructed({known}, {len(parts)})")
        with fn.block(f"if {found} is not None:"):
            fn.line(f"{tuple_of(values)} = {found}")
            match_all(fn, list(parts), values, then)
        return
    undoing(fn, f"deconstruct({known}, {build(fn, right)}, t)", [], then)


def _take_anything(fn: FunctionBuilder, patterns: tuple[nodes.Term, ...]) -> bool:
    """Whether all are variables, different ones that are met here for the first time."""
    variables = [each for each in patterns if isinstance(each, nodes.Variable) and is_plain(each)]
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
    """An expression for a relation that binds nothing (see `jacaros.agents.terms.substitution.related`)."""
    written = BINARY[node.operator]
    left, right = as_name(fn, build(fn, node.left)), as_name(fn, build(fn, node.right))
    tests = [f"{o}.__class__ is float" for o in dict.fromkeys((left, right)) if not is_number(o)]
    plain = written.code_for(left, right)
    if not tests:
        return f"({plain})"
    return f"({plain} if {' and '.join(tests)} else related({node.operator!r}, {left}, {right}))"


def _unification(fn: FunctionBuilder, node: nodes.Relation, then: Then) -> None:
    for side, other in ((node.left, node.right), (node.right, node.left)):
        if isinstance(side, nodes.Variable) and _is_unbound(fn, side) and side.name not in names_in(other):
            fn.bind(side.name, build(fn, other))
            then()
            return
    left, right = build(fn, node.left), build(fn, node.right)
    undoing(fn, f"unify({left}, {right}, t)", names_in(node), then)


def _is_unbound(fn: FunctionBuilder, node: nodes.Variable) -> bool:
    return is_plain(node) and not node.unnamed and node.name not in fn.values


_MAX_LOOPS = 12
_FEW = 24
"""So many formulae of a chain are written inside each other."""


def condition(fn: FunctionBuilder, node: nodes.Node, then: Then) -> None:
    """Write the search for answers of *node*, with *then* at its innermost point."""
    fn.at(node)
    if fn.indent > MAX_DEPTH and not isinstance(node, nodes.Literal | nodes.Variable):
        in_own_function(fn, node, then)
        return
    if fn.loops > _MAX_LOOPS and not isinstance(node, (nodes.Relation, nodes.Not)):
        in_own_function(fn, node, then)
        return
    with fn.branch():
        _WRITERS[type(node)](fn, node, then)


def _and(fn: FunctionBuilder, node: nodes.And, then: Then) -> None:
    formulae = operands(node)
    size = _FEW
    while len(formulae) > size:
        size *= _FEW
    size //= _FEW
    # A long chain is cut into functions, else writing it would need a level of Python's stack for each formula.
    _all(fn, [_joined(formulae[i : i + size]) for i in range(0, len(formulae), size)], then)


def _all(fn: FunctionBuilder, formulae: list[nodes.Node], then: Then) -> None:
    if not formulae:
        then()
        return
    if len(formulae) > 1 and (fn.indent > MAX_DEPTH or fn.loops > _MAX_LOOPS):
        in_own_function(fn, _joined(formulae), then)
        return
    first, *others = formulae
    write = in_own_function if isinstance(first, nodes.And) else condition
    write(fn, first, lambda: _all(fn, others, then))


def _joined(formulae: list[Any]) -> nodes.Node:
    joined: Any
    joined, *others = reversed(formulae)
    for formula in others:
        joined = nodes.And(formula, joined, span=formula.span)
    return cast("nodes.Node", joined)


def _not(fn: FunctionBuilder, node: nodes.Not, then: Then) -> None:
    if not (fn.trampoline or fn.snapshot or fn.loops > _MAX_LOOPS) and _not_in_place(fn, node.operand, then):
        return
    call = question(fn, node.operand, [])
    if fn.trampoline:
        mark, found = fn.local("n"), fn.local("m")
        fn.line(f"{mark} = len(t)")
        fn.line(f"{found} = yield {call}")
        fn.line(f"undo(t, {mark})")
        head = f"if {found} is None:"
    else:
        head = f"if not exists({call}, t):"
    with fn.block(head):
        then()


def _not_in_place(fn: FunctionBuilder, node: nodes.Node, then: Then) -> bool:
    """Write the search for something that must have no answer right here, if it is a simple one."""
    if isinstance(node, nodes.Relation) and not BINARY[node.operator].binds:
        with fn.block(f"if not ({comparison(fn, node)}):"):
            then()
        return True
    if not isinstance(node, nodes.Literal) or node.functor in TRUTHS:
        return False
    if node.annotations is not None or isinstance(node.namespace, nodes.Variable):
        return False
    found, mark, room = fn.local("f"), fn.local("n"), fn.local("r")

    def answered() -> None:
        fn.line(f"{found} = True")
        if fn.depth != TOP:
            fn.line(f"t.room = {room}")
        fn.line("break")

    fn.line(f"{found} = False")
    fn.line(f"{mark} = len(t)")
    if fn.depth != TOP:
        fn.line(f"{room} = t.room")
    with fn.branch():
        query(fn, node, answered)
    fn.line(f"if len(t) > {mark}: undo(t, {mark})")
    with fn.block(f"if not {found}:"):
        then()
    return True


def in_own_function(fn: FunctionBuilder, node: nodes.Node, then: Then) -> None:
    """Search by a generator function of its own that yields the values of the variables it binds."""
    new = [name for name in names_in(node) if name not in fn.values]
    call = question(fn, node, new)
    targets = [f"v_{name}" for name in new]

    def bound() -> None:
        for name in new:
            fn.bind(name)
        then()

    loop_over_answers(fn, call, targets, bound)


def question(fn: FunctionBuilder, node: nodes.Node, results: list[str]) -> str:
    """Write a generator function for the answers of *node*; returns the call that makes the generator.

    It yields the values of the variables *results*.  It runs the way its caller does (plain or trampolined).
    """
    captured = [name for name in names_in(node) if name in fn.values]
    inner = fn.inner()
    name = fn.unit.fresh_function("answers")
    inner.values = {c: f"v_{c}" for c in captured}
    inner.at(node)
    with inner.function(name, "agent", "t", "d", *(f"v_{c}" for c in captured)):
        if isinstance(node, nodes.Or):
            for side in operands(node):
                with inner.branch():
                    condition(inner, side, lambda: _yield(inner, results))
        else:
            condition(inner, node, lambda: _yield(inner, results))
        inner.line("return")
        inner.line("yield")
    return _called(fn, name, captured)


def _called(fn: FunctionBuilder, name: str, captured: list[str]) -> str:
    """The call of a function that searches on behalf of this one."""
    if fn.depth == TOP:
        fn.line("t.room = agent.options.rule_depth")
    return f"{name}(agent, t, {fn.depth}{''.join(f', {fn.values[c]}' for c in captured)})"


def _yield(fn: FunctionBuilder, results: list[str]) -> None:
    values = [fn.values.get(r) or f'Var("{r}")' for r in results]
    fn.line(f"yield {tuple_of(values)}" if values else "yield ()")


# --- internal actions that ask questions -------------------------------------------------------------------


def _internal_action(fn: FunctionBuilder, node: nodes.InternalAction, then: Then) -> None:
    action = fn.unit.actions.get(node.name)
    if action is not None and action.is_collecting(len(node.arguments)):
        _collecting(fn, action, node, then)
    else:
        internal_action(fn, node, then)


def collect(fn: FunctionBuilder, template: nodes.Node, formula: nodes.Node) -> str:
    """Write a function that gives the list of all instances of *template*; returns the call."""
    captured = [n for n in names_in(template, formula) if n in fn.values]
    inner = fn.inner(searching=False)
    name = fn.unit.fresh_function("collect")
    inner.values = {c: f"v_{c}" for c in captured}
    inner.at(formula)
    with inner.function(name, "agent", "t", "d", *(f"v_{c}" for c in captured)):
        inner.line("found = []")
        inner.line("room = t.room")
        inner.line("if d <= 0: t.room = agent.options.rule_depth")  # what asks counts its rules by itself

        def found() -> None:
            value = as_name(inner, build(inner, template))
            is_copied = not (is_number(value) or is_static(template))
            copy = f"{value} if {value}.__class__ in ATOMIC else copy({value})" if is_copied else value
            inner.line(f"found.append({copy})")

        condition(inner, formula, found)
        inner.line("t.room = room")
        inner.line("return found")
    return _called(fn, name, captured)


def _result(fn: FunctionBuilder, target: nodes.Node, value: str, then: Then) -> None:
    """Unify the last argument of an internal action with a computed value."""
    found = as_name(fn, value)
    mark = fn.local("n")
    fn.line(f"{mark} = len(t)")
    match(fn, target, found, then)
    fn.line(f"if len(t) > {mark}: undo(t, {mark})")


def _collecting(fn: FunctionBuilder, action: InternalAction, node: nodes.InternalAction, then: Then) -> None:
    template, formula, target = (nodes.Number(0.0), *node.arguments)[-3:]
    if not isinstance(formula, (nodes.Variable, nodes.Constant)):  # a variable stands for what is known later
        _result(fn, target, f"{fn.constant(action.function)}({collect(fn, template, formula)})", then)
    else:
        arguments = tuple_of([build(fn, a) for a in node.arguments])
        undoing(fn, f"agent.collect_formula({fn.constant(action)}, {arguments}, t)", names_in(node), then)


# --- which code is written for which formula ---------------------------------------------------------------


def searched(fn: FunctionBuilder, node: nodes.Node, then: Then) -> None:
    """A formula that is known only at run time, or too large to be compiled."""
    formula = build(fn, node)
    loop_binding(fn, f"agent.solve_formula({formula}, t)", names_in(node), then)


_WRITERS: dict[type, Callable[..., None]] = {
    nodes.And: _and,
    nodes.Or: in_own_function,
    nodes.Not: _not,
    nodes.Relation: relation,
    nodes.Literal: literal,
    nodes.InternalAction: _internal_action,
    nodes.Variable: searched,
    nodes.Constant: searched,
    nodes.FunctionCall: searched,
    nodes.Number: searched,
    nodes.String: searched,
    nodes.ListTerm: searched,
    nodes.Arithmetic: searched,
    nodes.PlanTerm: searched,
    nodes.TriggerTerm: searched,
    nodes.RuleTerm: searched,
    nodes.BodyTerm: searched,
}
