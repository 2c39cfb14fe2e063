"""Code that builds terms, matches patterns with values (heads of plans and rules, rows of beliefs), and loops over answers.

Everything is written in continuation style: ``match(fn, pattern, value, then)`` writes the test, and inside it
whatever *then* writes.  A pattern that meets a structure is taken apart in place; whatever is rarer (an unbound
variable, annotations, arithmetic) goes to `unify`.
"""

import math
from collections.abc import Callable, Sequence

from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import lower
from jacaros.agents.language.nodes import names_in, variables_in
from jacaros.agents.mind.generated.function import FunctionBuilder
from jacaros.agents.terms.operators import named
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.values import CONS, FUNCTION, SOURCE, Functor, Term, functor

Then = Callable[[], None]
_SHORT_LIST = 4
MAX_DEPTH = 50
"""Levels of indentation after which code goes on in another way."""


def match(fn: FunctionBuilder, pattern: nodes.Node, value: str, then: Then) -> None:
    """Match one pattern with the value of a local name."""
    if isinstance(pattern, nodes.Variable) and is_plain(pattern):
        _match_variable(fn, pattern, value, then)
    elif isinstance(pattern, nodes.Number):
        number = build(fn, pattern)  # infinite ones are not Python literals
        _test(fn, f"{value} == {number} if {value}.__class__ is float else {_open(number, value)}", then)
    elif isinstance(pattern, nodes.String):
        text = build(fn, pattern)
        _test(fn, f"{value} == {text} if {value}.__class__ is String else {_open(text, value)}", then)
    elif _is_atom(pattern):
        symbol = build(fn, pattern)
        _test(fn, f"{value} is {symbol} or ({_open(symbol, value)})", then)
    elif isinstance(pattern, nodes.Literal) and is_plain(pattern) and _is_taken_apart(pattern):
        symbol = fn.constant(functor_of_literal(pattern))
        _match_structure(fn, symbol, pattern.arguments, value, then)
    elif isinstance(pattern, nodes.ListTerm) and _is_taken_apart_list(pattern):
        items, tail = pattern.items, pattern.tail
        rest = tail if len(items) == 1 else nodes.replace(pattern, items=items[1:])
        _match_list(fn, (items[0], rest or nodes.ListTerm(())), value, then)
    else:
        _match_any(fn, pattern, value, then)


def _open(expected: str, value: str) -> str:
    """Unify an atom, number or string with a value of another type; structures are skipped immediately."""
    closed = f"{value}.__class__ not in CLOSED and ({value}.__class__ is not tuple or {value}[0].kind)"
    return f"{closed} and unify({expected}, {value}, t)"


def _is_atom(pattern: nodes.Node) -> bool:
    if isinstance(pattern, nodes.ListTerm):
        return not pattern.items and pattern.tail is None
    return isinstance(pattern, nodes.Literal) and not pattern.arguments and is_plain(pattern)


def _is_taken_apart(pattern: nodes.Literal) -> bool:
    """Whether the arguments are matched one by one; large constants are better compared as a whole."""
    return not is_static(pattern) or all(
        isinstance(a, nodes.Number | nodes.String) or _is_atom(a) for a in pattern.arguments
    )


def _is_taken_apart_list(pattern: nodes.ListTerm) -> bool:
    if not pattern.items or is_static(pattern):
        return False
    return len(pattern.items) == 1 or len(pattern.items) <= _SHORT_LIST


def is_plain(pattern: nodes.Variable | nodes.Literal) -> bool:
    """Whether nothing stands around a variable or literal that is known only at run time."""
    if pattern.annotations is not None:
        return False
    if isinstance(pattern, nodes.Variable):
        return pattern.namespace is None and not pattern.negated
    return not isinstance(pattern.namespace, nodes.Variable)


def _test(fn: FunctionBuilder, condition: str, then: Then) -> None:
    with fn.block(f"if {condition}:"):
        then()


def _match_variable(fn: FunctionBuilder, pattern: nodes.Variable, value: str, then: Then) -> None:
    if pattern.unnamed:
        then()
        return
    known = fn.values.get(pattern.name)
    if known is None:
        fn.bind(pattern.name, value)
        then()
        return
    condition = f"{known} == {value} if {known}.__class__ is float and {value}.__class__ is float"
    _test(fn, f"{condition} else unify({known}, {value}, t)", then)


def _match_list(
    fn: FunctionBuilder, first_and_rest: tuple[nodes.Node, nodes.Node], value: str, then: Then
) -> None:
    """Take the first element off a list."""

    def of_list(value: str, parts: list[str], found: str) -> None:
        first, rest = first_and_rest
        with fn.block(f"elif {value}.__class__ is List:"):
            fn.line(f"{found} = True")
            if not _is_anything(first):
                fn.line(f"{parts[0]} = {value}.stack[{value}.size - 1]")
            if not _is_anything(rest):
                fn.line(f"{parts[1]} = {value}.rest()")

    _match_structure(fn, fn.constant(CONS), first_and_rest, value, then, of_list)


def _is_anything(pattern: nodes.Node) -> bool:
    return isinstance(pattern, nodes.Variable) and pattern.unnamed and is_plain(pattern)


def _match_structure(
    fn: FunctionBuilder,
    symbol: str,
    arguments: Sequence[nodes.Node],
    value: str,
    then: Then,
    otherwise: Callable[[str, list[str], str], None] | None = None,
) -> None:
    """Take a structure apart; the parts are matched inside the test.

    *otherwise* writes a test for values of another class.
    """
    parts = [fn.local("p") for _ in arguments]
    found = fn.local("m")
    outer, value = value, fn.local("d")
    fn.line(f"{value} = deref({outer}) if {outer}.__class__ is Var else {outer}")
    with fn.block(f"if {value}.__class__ is tuple:"):
        fn.line(f"{found} = {value}[0] is {symbol}")
        fn.line(f"if {found}: _, {', '.join(parts)} = {value}")
    if otherwise is not None:
        otherwise(value, parts, found)
    with fn.block(f"elif {value}.__class__ in CLOSED:"):
        fn.line(f"{found} = False")
    with fn.block("else:"):
        for part, argument in zip(parts, arguments, strict=True):
            name = argument.name if isinstance(argument, nodes.Variable) and not argument.unnamed else "_"
            fn.line(f"{part} = Var({name!r})")
        fn.line(f"{found} = unify({tuple_of([symbol, *parts])}, {value}, t)")
    with fn.block(f"if {found}:"):
        match_all(fn, list(arguments), parts, then)


def match_all(fn: FunctionBuilder, patterns: list[nodes.Node], values: list[str], then: Then) -> None:
    """Match patterns with values, one inside the other."""
    bound = 0
    while bound < len(patterns) and _only_binds(fn, patterns[bound]):
        match(fn, patterns[bound], values[bound], _nothing)
        bound += 1
    patterns, values = patterns[bound:], values[bound:]
    if not patterns:
        then()
        return
    if fn.indent > MAX_DEPTH:
        _match_together(fn, patterns, values, then)
        return
    match(fn, patterns[0], values[0], lambda: match_all(fn, patterns[1:], values[1:], then))


def _only_binds(fn: FunctionBuilder, pattern: nodes.Node) -> bool:
    """Return whether any value matches: the pattern is a variable that occurs for the first time."""
    return isinstance(pattern, nodes.Variable) and is_plain(pattern) and fn.values.get(pattern.name) is None


def _nothing() -> None:
    pass


def _match_together(fn: FunctionBuilder, patterns: list[nodes.Node], values: list[str], then: Then) -> None:
    """Match many patterns in one test: Python allows no more than 100 levels of indentation."""
    expected = tuple_of([build(fn, pattern) for pattern in patterns])
    with fn.block(f"if unify_rows({expected}, {tuple_of(values)}, t):"):
        settle_fresh(fn, names_in(*patterns))
        then()


def _match_any(fn: FunctionBuilder, pattern: nodes.Node, value: str, then: Then) -> None:
    with fn.block(f"if unify({build(fn, pattern)}, {value}, t):"):
        settle_fresh(fn, names_in(pattern))
        then()


def settle_fresh(fn: FunctionBuilder, names: list[str]) -> None:
    """After unification the values of variables are read, into names of their own: the old ones may be tried again."""
    for name in names:
        if name in fn.values:
            settled = fn.local("v")
            fn.line(f"{settled} = deref({fn.values[name]})")
            fn.values[name] = settled


# --- loops over answers ------------------------------------------------------------------------------------


def loop_over_answers(fn: FunctionBuilder, generator: str, targets: list[str], then: Then) -> None:
    """A loop over the answers of a generator expression, whose values go to *targets*."""
    if fn.trampoline:
        source, answer = fn.local("g"), fn.local("r")
        fn.line(f"{source} = {generator}")
        with fn.block(f"while ({answer} := (yield {source})) is not None:"):
            if targets:
                fn.line(f"{tuple_of(targets)} = {answer}")
            then()
    else:
        with fn.block(f"for {tuple_of(targets) if targets else '_'} in {generator}:"):
            then()


def loop_binding(fn: FunctionBuilder, generator: str, names: list[str], then: Then) -> None:
    """A loop over answers that bind variables in place."""

    def settled() -> None:
        settle_fresh(fn, names)
        then()

    loop_over_answers(
        fn, generator if fn.trampoline else f"run({generator}, agent.options.rule_depth)", [], settled
    )


def undoing(fn: FunctionBuilder, test: str, names: list[str], then: Then) -> None:
    """Write a test that may bind variables; the bindings are undone when the search continues."""
    mark = fn.local("n")
    fn.line(f"{mark} = len(t)")
    with fn.block(f"if {test}:"):
        settle_fresh(fn, names)
        then()
    fn.line(f"if len(t) > {mark}: undo(t, {mark})")


# Code that finds annotations among those of a belief or an event.
#
# The annotations of a pattern are looked for in their order, each among those that are held, from the first to the last:
# nested loops, as `jacaros.agents.terms.unifier.each_annotation_match` has them.  Tails, and patterns whose order depends
# on the values of variables, are left to that function.


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
    with fn.block(f"for {candidate} in {held}:"):
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

        with fn.block(f"for {candidate} in {held}:"):
            _pass_over_others(fn, patterns[index], candidate)
            fn.line(f"{mark} = len(t)")
            match(fn, patterns[index], candidate, matched)
            fn.line(f"if len(t) > {mark}: undo(t, {mark})")

    one(0)
    with fn.block(f"if {found}:"):
        fn.values = known
        then()


# Code that builds terms: an expression for the value of a piece of syntax.

_STATIC = (nodes.Literal, nodes.ListTerm, nodes.String)
_LONG_LIST = 12


def build(fn: FunctionBuilder, node: nodes.Node) -> str:
    """An expression (a name or a small literal) for the value of a term; variables without value get a `Var`."""
    if isinstance(node, nodes.Number):
        return (
            repr(node.value)
            if node.value.__class__ is float and math.isfinite(node.value)
            else _const(fn, node)
        )
    if isinstance(node, nodes.Constant):
        return fn.constant(node.value)
    if isinstance(node, nodes.Variable):
        return _variable(fn, node)
    if isinstance(node, _STATIC) and is_static(node):
        return _const(fn, node)
    return _COMPOUND[type(node)](fn, node)


def written(node: nodes.Node) -> Term | None:
    """The value of a term that is the same at every evaluation; None for others."""
    return resolve(lower(node, _no_variable)) if isinstance(node, _STATIC) and is_static(node) else None


def is_static(node: object) -> bool:
    """Whether a term is the same at every evaluation."""
    if any(True for _ in variables_in(node)):
        return False
    return not _has_calls(node)


def _has_calls(node: object) -> bool:
    if isinstance(node, (nodes.FunctionCall, nodes.Constant)):
        return True
    if isinstance(node, nodes.Arithmetic):
        # A division may have no result, which is for the plan to see when it comes to it.
        return named(node.operator, len(node.operands)).partial or _has_calls(node.operands)
    if isinstance(node, tuple):
        return any(_has_calls(item) for item in node)
    if isinstance(node, nodes.Literal):
        return _has_calls(node.arguments) or (
            node.annotations is not None and _has_calls(node.annotations.items)
        )
    if isinstance(node, nodes.ListTerm):
        return _has_calls(node.items) or (node.tail is not None and _has_calls(node.tail))
    return not isinstance(node, (nodes.Number, nodes.String))


def _const(fn: FunctionBuilder, node: nodes.Node) -> str:
    return fn.constant(constant_value(node))


def constant_value(node: nodes.Node) -> Term:
    """The value of a term that is the same at every evaluation."""
    return resolve(lower(node, _no_variable))


def _no_variable(name: str) -> object:
    raise KeyError(name)


def variable(fn: FunctionBuilder, name: str) -> str:
    """The value of a variable; one without value gets a `Var` of its own."""
    value = fn.values.get(name)
    return value if value is not None else fn.bind(name, f'Var("{name}")')


def _variable(fn: FunctionBuilder, node: nodes.Variable) -> str:
    value = f'Var("{node.name}")' if node.unnamed else variable(fn, node.name)
    if node.namespace is not None or node.negated:
        value = f"qualify({value}, {namespace(fn, node.namespace)}, {node.negated})"
    return _annotated(fn, value, node.annotations)


def functor_of_literal(literal: nodes.Literal) -> Functor:
    """The functor of a literal whose namespace is known when the plan is compiled."""
    assert not isinstance(literal.namespace, nodes.Variable)
    return functor(literal.functor, len(literal.arguments), literal.negated, literal.namespace)


def namespace(fn: FunctionBuilder, value: str | nodes.Variable | None) -> str:
    """An expression for a namespace."""
    if isinstance(value, nodes.Variable):
        return f"namespace_name({variable(fn, value.name)})"
    return repr(value)


def _annotated(fn: FunctionBuilder, value: str, annotations: nodes.Annotations | None) -> str:
    if annotations is None:
        return value
    items, tail = annotation_parts(fn, annotations)
    return f"Annotated({value}, {items}, {tail})"


def annotation_parts(fn: FunctionBuilder, annotations: nodes.Annotations) -> tuple[str, str]:
    """Expressions for the sorted annotations and for the tail."""
    tail = "None" if annotations.tail is None else build(fn, annotations.tail)
    if all(is_static(item) for item in annotations.items):
        from_terms = tuple(map(constant_value, annotations.items))
        return fn.constant(annotation_set(from_terms)), tail
    items = tuple_of([build(fn, item) for item in annotations.items])
    return (f"annotation_set({items})" if len(annotations.items) > 1 else items), tail


def tuple_of(items: list[str]) -> str:
    """A tuple display."""
    return f"({', '.join(items)}{',' if len(items) == 1 else ''})"


def _literal(fn: FunctionBuilder, node: nodes.Literal) -> str:
    arguments = [build(fn, a) for a in node.arguments]
    if isinstance(node.namespace, nodes.Variable):
        parts = ", ".join([repr(node.functor), repr(node.negated), namespace(fn, node.namespace), *arguments])
        value = f"literal_in({parts})"
    else:
        symbol = fn.constant(functor_of_literal(node))
        value = tuple_of([symbol, *arguments]) if arguments else symbol
    return _annotated(fn, value, node.annotations)


def _list(fn: FunctionBuilder, node: nodes.ListTerm) -> str:
    if node.tail is None:
        return f"make_list({tuple_of([build(fn, i) for i in node.items])})"
    tail = build(fn, node.tail)
    items = [build(fn, i) for i in node.items]
    if len(items) > _LONG_LIST:
        return f"make_list({tuple_of(items)}, {tail})"
    for item in reversed(items):
        tail = f"(CONS, {item}, {tail})"
    return tail


def _arithmetic(fn: FunctionBuilder, node: nodes.Arithmetic) -> str:
    operands = [as_name(fn, build(fn, o)) for o in node.operands]
    result = fn.local()
    value = named(node.operator, len(operands)).code_for(*operands)
    tests = [f"{o}.__class__ is float" for o in dict.fromkeys(operands) if not is_number(o)]
    if tests:
        value += f' if {" and ".join(tests)} else calculated("{node.operator}", {", ".join(operands)})'
    fn.line(f"{result} = {value}")
    return result


def is_number(expression: str) -> bool:
    """Whether the expression is a number literal."""
    return expression[0].isdigit() or expression[0] == "-"


def as_name(fn: FunctionBuilder, expression: str) -> str:
    """The expression as something that may be written twice."""
    if expression.isidentifier() or is_number(expression):
        return expression
    name = fn.local()
    fn.line(f"{name} = {expression}")
    return name


def resolved(fn: FunctionBuilder, expression: str) -> str:
    """The expression with all bindings applied."""
    if is_number(expression):
        return expression
    name = as_name(fn, expression)
    return f"{name} if {name}.__class__ in ATOMIC else resolve({name})"


def _function(fn: FunctionBuilder, node: nodes.FunctionCall) -> str:
    arguments = [build(fn, a) for a in node.arguments]
    symbol = fn.constant(functor(node.name, len(arguments), kind=FUNCTION))
    result = fn.local()
    fn.line(f"{result} = agent.call_function({tuple_of([symbol, *arguments])})")
    return result


def _lowered(fn: FunctionBuilder, node: nodes.Node) -> str:
    """A formula, plan, rule or body as a term, which is made as an interpreted step makes it: few programs need many."""
    values = ", ".join(f"{name!r}: {variable(fn, name)}" for name in names_in(node))
    return f"lower({fn.constant(node)}, Variables({{{values}}}).__getitem__)"


_COMPOUND: dict[type, Callable[..., str]] = {
    nodes.String: _const,
    nodes.Literal: _literal,
    nodes.ListTerm: _list,
    nodes.Arithmetic: _arithmetic,
    nodes.FunctionCall: _function,
    **dict.fromkeys((nodes.Relation, nodes.Not, nodes.And, nodes.Or, nodes.InternalAction), _lowered),
    **dict.fromkeys((nodes.PlanTerm, nodes.TriggerTerm, nodes.RuleTerm, nodes.BodyTerm), _lowered),
}
