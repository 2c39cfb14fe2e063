"""Code for questions in conditions: literals, asked of beliefs and rules table by table, and calls of internal actions."""

from jacaros.asl import nodes
from jacaros.asl.walk import names_in
from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated.annotations import each_match, patterns_in_order
from jacaros.bdi.fast.generated.building import (
    annotation_parts,
    build,
    functor_of_literal,
    resolved,
    tuple_of,
)
from jacaros.bdi.fast.generated.function import TOP, FunctionBuilder
from jacaros.bdi.fast.generated.matching import Then, loop_binding, match, settle_fresh, undoing
from jacaros.bdi.fast.generated.query_arguments import QueryArguments

TRUTHS = ("true", "false")
"""Literals that are not predicates."""


def literal(fn: FunctionBuilder, node: nodes.Literal, then: Then) -> None:
    """A search for what answers a literal."""
    if node.functor in TRUTHS and not node.arguments and not node.negated:
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
    arguments = QueryArguments(fn, node.arguments)
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
        source = f"{rows} if {test} else run({deep}, agent.options.rule_depth)"
    else:
        source = _rows_at_once(fn, table, arguments, rows)
    with fn.writer.block(f"for {arguments.target} in ({source}):"):
        arguments.match_rest(then)


def _rows_at_once(fn: FunctionBuilder, table: str, arguments: QueryArguments, rows: str) -> str:
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
    fn: FunctionBuilder, arguments: QueryArguments, rows: str, general: str, test: str, then: Then
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
    loop_binding(fn, call, names, then)


def _rows_with_annotations(
    fn: FunctionBuilder, node: nodes.Literal, table: str, patterns: list[nodes.Term], then: Then
) -> None:
    """A loop over the rows of a predicate and their annotations, and among these for those that are asked for."""
    arguments = QueryArguments(fn, node.arguments)
    held = fn.local("h")
    general = f"solve_held(agent, {table}, {tuple_of(arguments.terms) if arguments.terms else '()'}, t)"
    test = " and ".join([f"{table}.plain", *arguments.tests])
    rows = arguments.rows_and_annotations(table)
    with fn.writer.block(
        f"for {arguments.target}, {held} in ({rows} if {test} else run({general}, agent.options.rule_depth)):"
    ):
        arguments.match_rest(lambda: each_match(fn, patterns, held, then))


def _in_namespaces(fn: FunctionBuilder, node: nodes.Literal, namespace: nodes.Variable, then: Then) -> None:
    """A literal whose namespace is a variable."""
    names = names_in(node)
    items, tail = ("None", "None") if node.annotations is None else annotation_parts(fn, node.annotations)
    arguments = tuple_of([build(fn, a) for a in node.arguments]) if node.arguments else "()"
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
        with fn.writer.block(f"for {value} in values_of(agent.context, {constant}{rest}):"):
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
        with fn.writer.block(f"for _ in answers_of(agent.context, t, {constant}{arguments}):"):
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
        and variable.annotations is None
        and variable.namespace is None
        and not variable.negated
        and (variable.unnamed or variable.name not in fn.values)
        and all(name in fn.values and name != variable.name for other in others for name in names_in(other))
    )
