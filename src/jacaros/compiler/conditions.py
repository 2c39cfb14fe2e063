"""Code for conditions: contexts, tests, bodies of rules, and the questions inside internal actions.

Continuation style: ``condition(fn, formula, then)`` writes a search whose innermost point is what *then* writes; a
literal becomes a loop over rows, a comparison an ``if``.  What is bound on the way is undone when the search goes on
(`Trail`), and kept when *then* leaves the function.

Predicates with rules are searched by generators.  Two ways of running them:

* in an ordinary function the generator looks like a loop over rows: it is nested (see `predicates`), or driven by ``run``
  where it goes deep, or where its answers are taken one by one while other things happen;
* in the body of a rule (``fn.trampoline``) the function is itself such a generator: it yields another generator to have
  it run and is sent its next answer, so that rules of any depth need no Python recursion.
"""

from collections.abc import Callable

from jacaros.asl import nodes
from jacaros.compiler.annotations import each_match, patterns_in_order
from jacaros.compiler.building import (
    annotation_parts,
    as_name,
    build,
    constant_value,
    functor_of_literal,
    is_number,
    is_static,
    resolved,
    tuple_of,
)
from jacaros.compiler.constant import Constant
from jacaros.compiler.function import TOP, FunctionBuilder
from jacaros.compiler.matching import MAX_DEPTH, Then, match, match_all, settle_fresh
from jacaros.compiler.runtime import takes_time
from jacaros.compiler.variables import names_in
from jacaros.terms.unifier import is_key

_MAX_LOOPS = 12
_COMPARE = {
    "<": "less({0}, {1})",
    "<=": "at_most({0}, {1})",
    ">": "less({1}, {0})",
    ">=": "at_most({1}, {0})",
}
_TRUE = ("true", "false")
_BINDING_NOTHING = (*_COMPARE, "==", "\\==")


def condition(fn: FunctionBuilder, node: nodes.Node, then: Then) -> None:
    """Write the search for answers of *node*, with *then* at its innermost point."""
    fn.at(node)
    if fn.writer.depth > MAX_DEPTH and not isinstance(node, nodes.Literal | nodes.Variable):
        in_own_function(fn, node, then)
        return
    if fn.writer.loops > _MAX_LOOPS and not isinstance(node, (nodes.Relation, nodes.Not)):
        in_own_function(fn, node, then)
        return
    with fn.branch():
        _WRITERS[type(node)](fn, node, then)


def _and(fn: FunctionBuilder, node: nodes.And, then: Then) -> None:
    condition(fn, node.left, lambda: condition(fn, node.right, then))


def _or(fn: FunctionBuilder, node: nodes.Or, then: Then) -> None:
    in_own_function(fn, node, then)


def _not(fn: FunctionBuilder, node: nodes.Not, then: Then) -> None:
    if not (fn.trampoline or fn.snapshot or fn.writer.loops > _MAX_LOOPS) and _not_in_place(
        fn, node.operand, then
    ):
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
    with fn.writer.block(head):
        then()


def _not_in_place(fn: FunctionBuilder, node: nodes.Node, then: Then) -> bool:
    """Write the search for something that must have no answer right here, if it is a simple one."""
    if isinstance(node, nodes.Relation) and node.operator in _BINDING_NOTHING:
        with fn.writer.block(f"if not ({comparison(fn, node)}):"):
            then()
        return True
    if not isinstance(node, nodes.Literal) or node.functor in _TRUE:
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
    with fn.writer.block(f"if not {found}:"):
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


def question(fn: FunctionBuilder, node: nodes.Node, results: list[str]) -> str:
    """Write a generator function for the answers of *node*; returns the call that makes the generator.

    It yields the values of the variables *results*.  It runs the way its caller does (plain or trampolined).
    """
    captured = [name for name in names_in(node) if name in fn.values]
    inner = fn.inner()
    name = fn.unit.fresh_function("answers")
    inner.values = {c: f"v_{c}" for c in captured}
    inner.at(node)
    with inner.writer.block(f"def {name}(agent, t, d{''.join(f', v_{c}' for c in captured)}):"):
        if isinstance(node, nodes.Or):
            for side in (node.left, node.right):
                with inner.branch():
                    condition(inner, side, lambda: _yield(inner, results))
        else:
            condition(inner, node, lambda: _yield(inner, results))
        inner.line("return")
        inner.line("yield")
    fn.unit.add(inner.writer)
    return _called(fn, name, captured)


def _called(fn: FunctionBuilder, name: str, captured: list[str]) -> str:
    """The call of a function that searches on behalf of this one."""
    if fn.depth == TOP:
        fn.line("t.room = agent.rule_depth")
    return f"{name}(agent, t, {fn.depth}{''.join(f', {fn.values[c]}' for c in captured)})"


def _yield(fn: FunctionBuilder, results: list[str]) -> None:
    values = [fn.values.get(r) or f'Var("{r}")' for r in results]
    fn.line(f"yield {tuple_of(values)}" if values else "yield ()")


# --- relations ---------------------------------------------------------------------------------------------


def _relation(fn: FunctionBuilder, node: nodes.Relation, then: Then) -> None:
    if node.operator == "=":
        _unification(fn, node, then)
    elif node.operator == "=.." and isinstance(node.left, nodes.Variable) and node.left.namespace is not None:
        _deconstruction_in_namespace(fn, node, node.left, then)
    elif node.operator == "=..":
        left, right = build(fn, node.left), build(fn, node.right)
        _undoing(fn, f"deconstruct({left}, {right}, t)", [], then)
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
    _undoing(fn, f"deconstruct_in({place}, {left}, {right}, t)", [], then)


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
    _undoing(fn, f"unify({left}, {right}, t)", names_in(node), then)


def _is_unbound(fn: FunctionBuilder, node: nodes.Variable) -> bool:
    return (
        not node.unnamed
        and node.annotations is None
        and node.namespace is None
        and not node.negated
        and node.name not in fn.values
    )


def _undoing(fn: FunctionBuilder, test: str, names: list[str], then: Then) -> None:
    """A test that may bind variables; the bindings are taken back when the search goes on."""
    mark = fn.local("n")
    fn.line(f"{mark} = len(t)")
    with fn.writer.block(f"if {test}:"):
        settle_fresh(fn, names)
        then()
    fn.line(f"if len(t) > {mark}: undo(t, {mark})")


# --- beliefs and rules -------------------------------------------------------------------------------------


def _literal(fn: FunctionBuilder, node: nodes.Literal, then: Then) -> None:
    if node.functor in _TRUE and not node.arguments and not node.negated:
        if node.functor == "true":
            then()
        else:
            with fn.writer.block("if False:"):
                then()
        return
    if isinstance(node.namespace, nodes.Variable):
        _in_namespaces(fn, node, node.namespace, then)
        return
    if node.annotations is not None:
        _annotated_literal(fn, node, then)
        return
    query(fn, node, then)


def query(fn: FunctionBuilder, node: nodes.Literal, then: Then) -> None:
    """A loop over the rows of a predicate, by an index when arguments are known."""
    table = fn.local("b")
    symbol = fn.constant(functor_of_literal(node))
    fn.line(f"{table} = agent.beliefs[{symbol}]")
    arguments = _Arguments(fn, node.arguments)
    rows = arguments.fast_rows(table)
    general = (
        f"solve(agent, {table}, {tuple_of(arguments.terms)}, t)"
        if arguments.terms
        else f"solve(agent, {table}, (), t)"
    )
    test = " and ".join([f"{table}.plain", *arguments.tests])
    given = "".join(f", {arguments.terms[i]}" for i in arguments.given)
    pattern = sum(1 << i for i in arguments.given)
    deep = f"{table}.deep[{pattern}](agent, t, 0{given})"
    if arguments.tests:
        deep = f"{general} if {table}.plain else {deep}"
    if fn.trampoline:
        _trampolined_rows(fn, arguments, rows, deep, test, then)
        return
    if fn.snapshot:
        source = f"{rows} if {test} else run({deep}, agent.rule_depth)"
    else:
        source = _rows_at_once(fn, table, arguments, rows)
    with fn.writer.block(f"for {arguments.target} in ({source}):"):
        arguments.match_rest(then)


def _rows_at_once(fn: FunctionBuilder, table: str, arguments: "_Arguments", rows: str) -> str:
    """An expression for the rows of a search that is over before anything else happens."""
    terms = tuple_of(arguments.terms) if arguments.terms else "()"
    if arguments.tests:
        rows = f"{rows} if {' and '.join(arguments.tests)} else facts({table}, {terms}, t)"
    given = "".join(f", {arguments.terms[i]}" for i in arguments.given)
    pattern = sum(1 << i for i in arguments.given)
    if fn.depth == TOP:
        search = f"{table}.search({pattern}, agent, t)(agent, t, {TOP}{given})"
    else:
        rest = f"deeper(agent, t, {table}.deep[{pattern}](agent, t, 0{given}))"
        search = f"{table}.searches[{pattern}](agent, t, {fn.depth}{given}) if d > 0 else {rest}"
    return f"({rows}) if {table}.plain else {search}"


def _trampolined_rows(
    fn: FunctionBuilder, arguments: "_Arguments", rows: str, general: str, test: str, then: Then
) -> None:
    source, fast, row = fn.local("g"), fn.local("f"), fn.local("r")
    fn.line(f"{fast} = {test}")
    fn.line(f"{source} = iter({rows}) if {fast} else {general}")
    with fn.writer.block("while True:"):
        fn.line(f"{row} = next({source}, None) if {fast} else (yield {source})")
        fn.line(f"if {row} is None: break")
        if arguments.target != "_":
            fn.line(f"{arguments.target} = {row}")
        arguments.match_rest(then)


class _Arguments:
    """The arguments of a queried literal: which are known, which are read from the rows.

    Attributes:
        terms: an expression for each argument, as rules are asked with.
        tests: what has to hold for the known ones to be keys.
        known: places of the known arguments.
        given: places of those of which at least something is known.
        target: what a row is unpacked into.
    """

    def __init__(self, fn: FunctionBuilder, patterns: tuple[nodes.Term, ...]) -> None:
        self.fn = fn
        self.terms: list[str] = []
        self.tests: list[str] = []
        self.known: list[int] = []
        self.given: list[int] = []
        self.parts: list[str] = []
        self.rest: list[tuple[nodes.Node, str]] = []
        for index, pattern in enumerate(patterns):
            self._add(index, pattern)
        self.target = tuple_of(self.parts) if any(p != "_" for p in self.parts) else "_"

    def _add(self, index: int, pattern: nodes.Node) -> None:
        fn = self.fn
        tests = self._key_tests(pattern)
        if isinstance(pattern, nodes.Variable) and pattern.unnamed and pattern.annotations is None:
            self.terms.append("Var()")
            self.parts.append("_")
        elif tests is None:
            part = fn.local("c")
            self.terms.append(self._pattern_term(pattern))
            self.parts.append(part)
            if not isinstance(pattern, nodes.Variable):
                self.given.append(index)
            self.rest.append((pattern, part))
        else:
            value = as_name(fn, build(fn, pattern))
            self.terms.append(value)
            self.parts.append("_")
            self.known.append(index)
            self.given.append(index)
            computed = [f"{value}.__class__ in ATOMIC"] if self._is_computed(pattern, value) else []
            self.tests.extend([*tests, *computed])

    def _pattern_term(self, pattern: nodes.Node) -> str:
        """What rules are asked with: as much of the pattern as is known, so that they do not search for more."""
        if isinstance(pattern, nodes.Variable):
            return "Var()"
        with self.fn.branch():
            return as_name(self.fn, build(self.fn, pattern))

    @staticmethod
    def _is_computed(pattern: nodes.Node, value: str) -> bool:
        """Whether it is known only at run time that the pattern has a value."""
        if isinstance(pattern, nodes.Literal | nodes.ListTerm):
            return False
        return not (is_number(value) or is_static(pattern))

    def _key_tests(self, pattern: nodes.Node) -> list[str] | None:
        """What has to hold for the pattern to be a key, besides that it has a value; None when it cannot be one."""
        if any(name not in self.fn.values for name in names_in(pattern)):
            return None
        if isinstance(pattern, nodes.Variable):
            return None if pattern.unnamed or pattern.annotations is not None else []
        if isinstance(pattern, nodes.Number | nodes.String | nodes.Arithmetic | nodes.FunctionCall):
            return []
        return self._part_tests(pattern)

    def _part_tests(self, pattern: nodes.Node) -> list[str] | None:
        """The tests for a structure or list, or a part of one: annotations and anonymous parts make it no key."""
        if is_static(pattern):
            return [] if is_key(constant_value(pattern)) else None
        if isinstance(pattern, nodes.Variable):
            if pattern.unnamed or pattern.negated or pattern.annotations or pattern.namespace is not None:
                return None
            return [f"{self.fn.values[pattern.name]}.__class__ in ATOMIC"]
        if isinstance(pattern, nodes.Literal) and pattern.annotations is None:
            parts = None if isinstance(pattern.namespace, nodes.Variable) else pattern.arguments
        elif isinstance(pattern, nodes.ListTerm) and pattern.tail is None:
            parts = pattern.items
        else:
            parts = None
        found: list[str] = []
        for part in parts or ():
            tests = self._part_tests(part)
            if tests is None:
                return None
            found.extend(tests)
        return found or None

    def fast_rows(self, table: str) -> str:
        """An expression for the rows of a table that holds only facts."""
        if not self.known:
            return self._lasting(table, f"reversed({table}.rows)")
        keys = [self.terms[i] for i in self.known]
        if len(keys) == len(self.terms):
            return f"{table}.exact({tuple_of(keys)})"
        positions = self.fn.constant(tuple(self.known))
        key = keys[0] if len(keys) == 1 else tuple_of(keys)
        return self._lasting(table, f"{table}.find({positions}, {key})")

    def rows_and_annotations(self, table: str) -> str:
        """An expression for the rows of a table that holds only facts, each with its annotations."""
        if not self.known:
            return f"reversed({table}.rows.items())"
        keys = [self.terms[i] for i in self.known]
        if len(keys) == len(self.terms):
            return f"{table}.exact_item({tuple_of(keys)})"
        positions = self.fn.constant(tuple(self.known))
        return f"{table}.find_items({positions}, {keys[0] if len(keys) == 1 else tuple_of(keys)})"

    def _lasting(self, table: str, rows: str) -> str:
        """Rows that may be read while beliefs change: where answers are taken in between two steps."""
        if self.fn.trampoline:
            return f"list({rows})"
        return f"still_held({table}, list({rows}))" if self.fn.snapshot else rows

    def match_rest(self, then: Then) -> None:
        """Match the read parts with their patterns."""
        mark = None
        plain = all(isinstance(p, nodes.Variable) and p.annotations is None for p, _ in self.rest)
        if self.rest and not plain:
            mark = self.fn.local("n")
            self.fn.line(f"{mark} = len(t)")
        match_all(self.fn, [p for p, _ in self.rest], [v for _, v in self.rest], then)
        if mark is not None:
            self.fn.line(f"if len(t) > {mark}: undo(t, {mark})")


def _annotated_literal(fn: FunctionBuilder, node: nodes.Literal, then: Then) -> None:
    """A query that asks for annotations: every way to find them in those of a belief is an answer."""
    assert node.annotations is not None
    table = fn.local("b")
    symbol = fn.constant(functor_of_literal(node))
    fn.line(f"{table} = agent.beliefs[{symbol}]")
    patterns = patterns_in_order(node.annotations)
    if patterns is not None and not (fn.trampoline or fn.snapshot):
        _rows_with_annotations(fn, node, table, patterns, then)
        return
    names = names_in(node)
    arguments = tuple_of([build(fn, a) for a in node.arguments]) if node.arguments else "()"
    items, tail = annotation_parts(fn, node.annotations)
    call = f"solve_annotated(agent, {table}, {arguments}, {items}, {tail}, t)"
    _loop_binding(fn, call, names, then)


def _rows_with_annotations(
    fn: FunctionBuilder, node: nodes.Literal, table: str, patterns: list[nodes.Term], then: Then
) -> None:
    """A loop over the rows of a predicate and their annotations, and among these for those that are asked for."""
    arguments = _Arguments(fn, node.arguments)
    held = fn.local("h")
    general = f"solve_held(agent, {table}, {tuple_of(arguments.terms) if arguments.terms else '()'}, t)"
    test = " and ".join([f"{table}.plain", *arguments.tests])
    rows = arguments.rows_and_annotations(table)
    with fn.writer.block(
        f"for {arguments.target}, {held} in ({rows} if {test} else run({general}, agent.rule_depth)):"
    ):
        arguments.match_rest(lambda: each_match(fn, patterns, held, then))


def _in_namespaces(fn: FunctionBuilder, node: nodes.Literal, namespace: nodes.Variable, then: Then) -> None:
    """A literal whose namespace is a variable."""
    names = names_in(node)
    items, tail = ("None", "None") if node.annotations is None else annotation_parts(fn, node.annotations)
    arguments = tuple_of([build(fn, a) for a in node.arguments]) if node.arguments else "()"
    parts = [build(fn, namespace), repr(node.functor), repr(node.negated), arguments, items, tail]
    _loop_binding(fn, f"agent.solve_in_namespaces({', '.join(parts)}, t)", names, then)


def _loop_binding(fn: FunctionBuilder, generator: str, names: list[str], then: Then) -> None:
    """A loop over answers that bind variables in place."""

    def settled() -> None:
        settle_fresh(fn, names)
        then()

    loop_over_answers(fn, generator if fn.trampoline else f"run({generator}, agent.rule_depth)", [], settled)


def _dynamic(fn: FunctionBuilder, node: nodes.Node, then: Then) -> None:
    """A formula that is known only at run time."""
    formula = build(fn, node)
    _loop_binding(fn, f"agent.solve_formula({formula}, t)", names_in(node), then)


# --- internal actions --------------------------------------------------------------------------------------


def _internal_action(fn: FunctionBuilder, node: nodes.InternalAction, then: Then) -> None:
    special = _SPECIAL.get((node.name, len(node.arguments)))
    if special is not None:
        special(fn, node, then)
        return
    action = fn.unit.actions.get(node.name)
    names = names_in(node)
    if action is None:
        _undoing(fn, f"unknown(agent.context, {node.name!r})", names, then)
        return
    constant = fn.constant(action)
    arguments = "".join(f", {resolved(fn, build(fn, a))}" for a in node.arguments)
    if fn.quiet and takes_time(action):
        _undoing(fn, f"cannot_wait(agent.context, {constant})", names, then)
    elif not accepts(action, len(node.arguments)):
        refusal = "refuse_quietly(agent.context, " if fn.quiet else "refuse("
        _undoing(fn, f"{refusal}{constant}, {len(node.arguments)})", names, then)
    elif not action.backtracks:
        _undoing(fn, f"holds(agent.context, t, {constant}{arguments})", names, then)
    elif not fn.quiet:
        _undoing(fn, f"first_answer_of(agent.context, t, {constant}{arguments})", names, then)
    else:
        mark = fn.local("n")
        fn.line(f"{mark} = len(t)")
        with fn.writer.block(f"for _ in answers_of(agent.context, t, {constant}{arguments}):"):
            settle_fresh(fn, names)
            then()
        fn.line(f"if len(t) > {mark}: undo(t, {mark})")


def accepts(action: object, count: int) -> bool:
    """Whether an internal action takes so many arguments."""
    maximum = getattr(action, "maximum", None)
    return bool(getattr(action, "minimum", 0) <= count and (maximum is None or count <= maximum))


def collect(fn: FunctionBuilder, template: nodes.Node, formula: nodes.Node) -> str:
    """Write a function that gives the list of all instances of *template*; returns the call."""
    captured = [n for n in names_in(template, formula) if n in fn.values]
    inner = fn.inner(searching=False)
    name = fn.unit.fresh_function("collect")
    inner.values = {c: f"v_{c}" for c in captured}
    inner.at(formula)
    with inner.writer.block(f"def {name}(agent, t, d{''.join(f', v_{c}' for c in captured)}):"):
        inner.line("found = []")
        inner.line("room = t.room")
        inner.line("if d <= 0: t.room = agent.rule_depth")  # what asks counts its rules by itself

        def found() -> None:
            value = as_name(inner, build(inner, template))
            is_copied = not (is_number(value) or is_static(template))
            copy = f"{value} if {value}.__class__ in ATOMIC else copy({value})" if is_copied else value
            inner.line(f"found.append({copy})")

        condition(inner, formula, found)
        inner.line("t.room = room")
        inner.line("return found")
    fn.unit.add(inner.writer)
    return _called(fn, name, captured)


def _result(fn: FunctionBuilder, target: nodes.Node, value: str, then: Then) -> None:
    """Unify the last argument of an internal action with a computed value."""
    found = as_name(fn, value)
    mark = fn.local("n")
    fn.line(f"{mark} = len(t)")
    match(fn, target, found, then)
    fn.line(f"if len(t) > {mark}: undo(t, {mark})")


def _findall(fn: FunctionBuilder, node: nodes.InternalAction, then: Then) -> None:
    template, formula, target = node.arguments
    if _is_question(fn, formula):
        _result(fn, target, f"make_list({collect(fn, template, formula)})", then)
    else:
        _dynamic_collect(fn, node, then)


def _setof(fn: FunctionBuilder, node: nodes.InternalAction, then: Then) -> None:
    template, formula, target = node.arguments
    if _is_question(fn, formula):
        _result(fn, target, f"make_list(annotation_set(tuple({collect(fn, template, formula)})))", then)
    else:
        _dynamic_collect(fn, node, then)


def _count(fn: FunctionBuilder, node: nodes.InternalAction, then: Then) -> None:
    formula, target = node.arguments
    if _is_question(fn, formula):
        _result(fn, target, f"float(len({collect(fn, nodes.Number(0.0), formula)}))", then)
    else:
        _dynamic_collect(fn, node, then)


def _is_question(fn: FunctionBuilder, formula: nodes.Node) -> bool:
    """Whether a formula can be compiled here; a variable without annotations stands for one known later."""
    return not isinstance(formula, (nodes.Variable, Constant))


def _dynamic_collect(fn: FunctionBuilder, node: nodes.InternalAction, then: Then) -> None:
    arguments = tuple_of([build(fn, a) for a in node.arguments])
    _undoing(fn, f"agent.collect_formula({node.name!r}, {arguments}, t)", names_in(node), then)


_SPECIAL: dict[tuple[str, int], Callable[..., None]] = {
    (".findall", 3): _findall,
    (".setof", 3): _setof,
    (".count", 2): _count,
}

_WRITERS: dict[type, Callable[..., None]] = {
    nodes.And: _and,
    nodes.Or: _or,
    nodes.Not: _not,
    nodes.Relation: _relation,
    nodes.Literal: _literal,
    nodes.InternalAction: _internal_action,
    nodes.Variable: _dynamic,
    Constant: _dynamic,
    nodes.FunctionCall: _dynamic,
    nodes.Number: _dynamic,
    nodes.String: _dynamic,
    nodes.ListTerm: _dynamic,
    nodes.Arithmetic: _dynamic,
    nodes.PlanTerm: _dynamic,
    nodes.TriggerTerm: _dynamic,
    nodes.RuleTerm: _dynamic,
    nodes.BodyTerm: _dynamic,
}
