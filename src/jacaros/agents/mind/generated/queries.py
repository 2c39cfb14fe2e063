"""Code for questions in conditions: literals, asked of beliefs and rules table by table, and calls of internal actions."""

from jacaros.agents.language import nodes
from jacaros.agents.language.nodes import names_in
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.generated.function import TOP, FunctionBuilder
from jacaros.agents.mind.generated.matching import (
    Then,
    annotation_parts,
    as_name,
    build,
    constant_value,
    each_match,
    functor_of_literal,
    is_number,
    is_plain,
    is_static,
    loop_binding,
    match,
    match_all,
    patterns_in_order,
    resolved,
    settle_fresh,
    tuple_of,
    undoing,
)
from jacaros.agents.terms.substitution import is_key

# The arguments of a literal that a condition asks for: how the rows of its predicate are found and read.


class QueryArguments:
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
            if pattern.unnamed or not is_plain(pattern):
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
        taken_later = self.fn.trampoline or self.fn.snapshot
        return f"rows_still_held({table}, list({rows}))" if taken_later else rows

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


TRUTHS = ("true", "false")
"""Literals that are not predicates."""


def literal(fn: FunctionBuilder, node: nodes.Literal, then: Then) -> None:
    """A search for what answers a literal."""
    if node.functor in TRUTHS and not node.arguments and not node.negated:
        if node.functor == "true":
            then()
        else:
            with fn.block("if False:"):
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
    arguments = QueryArguments(fn, node.arguments)
    rows = arguments.fast_rows(table)
    general = f"solve(agent, {table}, {tuple_of(arguments.terms)}, t)"
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
        source = f"{rows} if {test} else run({deep}, agent.options.rule_depth)"
    else:
        source = _rows_at_once(fn, table, arguments, rows)
    with fn.block(f"for {arguments.target} in ({source}):"):
        arguments.match_rest(then)


def _rows_at_once(fn: FunctionBuilder, table: str, arguments: QueryArguments, rows: str) -> str:
    """An expression for the rows of a search that is over before anything else happens."""
    terms = tuple_of(arguments.terms)
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
    fn: FunctionBuilder, arguments: QueryArguments, rows: str, general: str, test: str, then: Then
) -> None:
    source, fast, row = fn.local("g"), fn.local("f"), fn.local("r")
    fn.line(f"{fast} = {test}")
    fn.line(f"{source} = iter({rows}) if {fast} else {general}")
    with fn.block("while True:"):
        fn.line(f"{row} = next({source}, None) if {fast} else (yield {source})")
        fn.line(f"if {row} is None: break")
        if arguments.target != "_":
            fn.line(f"{arguments.target} = {row}")
        arguments.match_rest(then)


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
    arguments = tuple_of([build(fn, a) for a in node.arguments])
    items, tail = annotation_parts(fn, node.annotations)
    call = f"solve_annotated(agent, {table}, {arguments}, {items}, {tail}, t)"
    loop_binding(fn, call, names, then)


def _rows_with_annotations(
    fn: FunctionBuilder, node: nodes.Literal, table: str, patterns: list[nodes.Term], then: Then
) -> None:
    """A loop over the rows of a predicate and their annotations, and among these for those that are asked for."""
    arguments = QueryArguments(fn, node.arguments)
    held = fn.local("h")
    general = f"solve_held(agent, {table}, {tuple_of(arguments.terms)}, t)"
    test = " and ".join([f"{table}.plain", *arguments.tests])
    rows = arguments.rows_and_annotations(table)
    with fn.block(
        f"for {arguments.target}, {held} in ({rows} if {test} else run({general}, agent.options.rule_depth)):"
    ):
        arguments.match_rest(lambda: each_match(fn, patterns, held, then))


def _in_namespaces(fn: FunctionBuilder, node: nodes.Literal, namespace: nodes.Variable, then: Then) -> None:
    """A literal whose namespace is a variable."""
    names = names_in(node)
    items, tail = ("None", "None") if node.annotations is None else annotation_parts(fn, node.annotations)
    arguments = tuple_of([build(fn, a) for a in node.arguments])
    parts = [build(fn, namespace), repr(node.functor), repr(node.negated), arguments, items, tail]
    loop_binding(fn, f"agent.solve_in_namespaces({', '.join(parts)}, t)", names, then)


# --- internal actions --------------------------------------------------------------------------------------


def internal_action(fn: FunctionBuilder, node: nodes.InternalAction, then: Then) -> None:
    """A call of an internal action, with its arguments as values."""
    action = fn.unit.actions.get(node.name)
    names = names_in(node)
    if action is None:
        undoing(fn, f"unknown(agent.context, {node.name!r})", names, then)
        return
    constant = fn.constant(action)
    if _gives_values(fn, action, node):
        variable, *others = node.arguments
        rest = "".join(f", {resolved(fn, build(fn, a))}" for a in others)
        value = fn.local("c")
        with fn.block(f"for {value} in values_of(agent.context, {constant}{rest}):"):
            match(fn, variable, value, then)
        return
    arguments = "".join(f", {resolved(fn, build(fn, a))}" for a in node.arguments)
    if fn.quiet and action.body_only:
        undoing(fn, f"cannot_wait(agent.context, {constant})", names, then)
    elif not action.takes(len(node.arguments)):
        refusal = "refuse_quietly(agent.context, " if fn.quiet else "refuse("
        undoing(fn, f"{refusal}{constant}, {len(node.arguments)})", names, then)
    elif not action.backtracks:
        undoing(fn, f"holds(agent.context, t, {constant}{arguments})", names, then)
    elif not fn.quiet:
        undoing(fn, f"first_answer_of(agent.context, t, {constant}{arguments})", names, then)
    else:
        mark = fn.local("n")
        fn.line(f"{mark} = len(t)")
        with fn.block(f"for _ in answers_of(agent.context, t, {constant}{arguments}):"):
            settle_fresh(fn, names)
            then()
        fn.line(f"if len(t) > {mark}: undo(t, {mark})")


def _gives_values(fn: FunctionBuilder, action: InternalAction, node: nodes.InternalAction) -> bool:
    """Whether a call is answered by values for its first argument, a variable that is met here for the first time."""
    if action.values is None or not fn.quiet or not action.takes(len(node.arguments)):
        return False
    variable, *others = node.arguments
    return (
        isinstance(variable, nodes.Variable)
        and is_plain(variable)
        and (variable.unnamed or variable.name not in fn.values)
        and all(name in fn.values and name != variable.name for other in others for name in names_in(other))
    )
