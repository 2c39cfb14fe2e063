"""Code that matches a pattern with a value (heads of plans and rules, rows of beliefs) and loops over answers.

Everything is written in continuation style: ``match(fn, pattern, value, then)`` writes the test, and inside it
whatever *then* writes.  A pattern that meets a structure is taken apart in place; whatever is rarer (an unbound
variable, annotations, arithmetic) goes to `unify`.
"""

from collections.abc import Callable, Sequence

from jacaros.agents.language import nodes
from jacaros.agents.language.nodes import names_in
from jacaros.agents.mind.generated.building import (
    annotation_parts,
    build,
    constant_value,
    functor_of_literal,
    is_static,
    resolved,
    tuple_of,
)
from jacaros.agents.mind.generated.function import FunctionBuilder
from jacaros.agents.terms.values import CONS, SOURCE

Then = Callable[[], None]
_SHORT_LIST = 4
MAX_DEPTH = 50
"""Levels of indentation after which code goes on in another way."""


def match(
    fn: FunctionBuilder, pattern: nodes.Node, value: str, then: Then, pattern_left: bool = True
) -> None:
    """Match one pattern with the value of a local name."""
    if isinstance(pattern, nodes.Variable) and _is_plain(pattern):
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
    elif isinstance(pattern, nodes.Literal) and _is_plain(pattern) and _is_taken_apart(pattern):
        symbol = fn.constant(functor_of_literal(pattern))
        _match_structure(fn, symbol, pattern.arguments, value, then)
    elif isinstance(pattern, nodes.ListTerm) and _is_taken_apart_list(pattern):
        items, tail = pattern.items, pattern.tail
        rest = tail if len(items) == 1 else nodes.replace(pattern, items=items[1:])
        _match_list(fn, (items[0], rest or nodes.ListTerm(())), value, then)
    else:
        _match_any(fn, pattern, value, then, pattern_left)


def _open(expected: str, value: str) -> str:
    """Unify an atom, number or string with a value of another type; structures are skipped immediately."""
    closed = f"{value}.__class__ not in CLOSED and ({value}.__class__ is not tuple or {value}[0].kind)"
    return f"{closed} and unify({expected}, {value}, t)"


def _is_atom(pattern: nodes.Node) -> bool:
    if isinstance(pattern, nodes.ListTerm):
        return not pattern.items and pattern.tail is None
    return isinstance(pattern, nodes.Literal) and not pattern.arguments and _is_plain(pattern)


def _is_taken_apart(pattern: nodes.Literal) -> bool:
    """Whether the arguments are matched one by one; large constants are better compared as a whole."""
    return not is_static(pattern) or all(
        isinstance(a, nodes.Number | nodes.String) or _is_atom(a) for a in pattern.arguments
    )


def _is_taken_apart_list(pattern: nodes.ListTerm) -> bool:
    if not pattern.items or is_static(pattern):
        return False
    return len(pattern.items) == 1 or len(pattern.items) <= _SHORT_LIST


def _is_plain(pattern: nodes.Variable | nodes.Literal) -> bool:
    if pattern.annotations is not None:
        return False
    if isinstance(pattern, nodes.Variable):
        return pattern.namespace is None and not pattern.negated
    return not isinstance(pattern.namespace, nodes.Variable)


def _test(fn: FunctionBuilder, condition: str, then: Then) -> None:
    with fn.writer.block(f"if {condition}:"):
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
        with fn.writer.block(f"elif {value}.__class__ is List:"):
            fn.line(f"{found} = True")
            if not _is_anything(first):
                fn.line(f"{parts[0]} = {value}.stack[{value}.size - 1]")
            if not _is_anything(rest):
                fn.line(f"{parts[1]} = {value}.rest()")

    _match_structure(fn, fn.constant(CONS), first_and_rest, value, then, of_list)


def _is_anything(pattern: nodes.Node) -> bool:
    return isinstance(pattern, nodes.Variable) and pattern.unnamed and _is_plain(pattern)


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
    with fn.writer.block(f"if {value}.__class__ is tuple:"):
        fn.line(f"{found} = {value}[0] is {symbol}")
        fn.line(f"if {found}: _, {', '.join(parts)} = {value}")
    if otherwise is not None:
        otherwise(value, parts, found)
    with fn.writer.block(f"elif {value}.__class__ in CLOSED:"):
        fn.line(f"{found} = False")
    with fn.writer.block("else:"):
        for part, argument in zip(parts, arguments, strict=True):
            name = argument.name if isinstance(argument, nodes.Variable) and not argument.unnamed else "_"
            fn.line(f"{part} = Var({name!r})")
        fn.line(f"{found} = unify({tuple_of([symbol, *parts])}, {value}, t)")
    with fn.writer.block(f"if {found}:"):
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
    if fn.writer.depth > MAX_DEPTH:
        _match_together(fn, patterns, values, then)
        return
    match(fn, patterns[0], values[0], lambda: match_all(fn, patterns[1:], values[1:], then))


def _only_binds(fn: FunctionBuilder, pattern: nodes.Node) -> bool:
    """Return whether any value matches: the pattern is a variable that occurs for the first time."""
    return isinstance(pattern, nodes.Variable) and _is_plain(pattern) and fn.values.get(pattern.name) is None


def _nothing() -> None:
    pass


def _match_together(fn: FunctionBuilder, patterns: list[nodes.Node], values: list[str], then: Then) -> None:
    """Match many patterns in one test: Python allows no more than 100 levels of indentation."""
    expected = tuple_of([build(fn, pattern) for pattern in patterns])
    with fn.writer.block(f"if unify_rows({expected}, {tuple_of(values)}, t):"):
        settle_fresh(fn, names_in(*patterns))
        then()


def _match_any(fn: FunctionBuilder, pattern: nodes.Node, value: str, then: Then, pattern_left: bool) -> None:
    """Build the pattern as a term and unify."""
    expected = build(fn, pattern)
    left, right = (expected, value) if pattern_left else (value, expected)
    with fn.writer.block(f"if unify({left}, {right}, t):"):
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
        with fn.writer.block(f"while ({answer} := (yield {source})) is not None:"):
            if targets:
                fn.line(f"{tuple_of(targets)} = {answer}")
            then()
    else:
        with fn.writer.block(f"for {tuple_of(targets) if targets else '_'} in {generator}:"):
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
    with fn.writer.block(f"if {test}:"):
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
