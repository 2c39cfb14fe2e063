"""What a condition means: its answers, found by searching beliefs and rules.

`answers` takes the syntax of a condition and the variables of its clause, `solve_formula` a term: a formula that was
bound to a variable, sent in a message or passed to an internal action.  Both give generators for
`jacaros.agents.mind.rules.searching.run`.
"""

from jacaros.agents.language import nodes
from jacaros.agents.language.lowering import Lookup, fresh_names, lower
from jacaros.agents.language.nodes import operands
from jacaros.agents.mind.actions.internal_action import InternalAction
from jacaros.agents.mind.rules.searching import (
    answers_of,
    cannot_wait,
    exists,
    holds,
    refuse_quietly,
    run,
    solve,
    solve_annotated,
    unify_rows,
    unknown,
)
from jacaros.agents.mind.state.belief_base import literal
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.plan import Answers, OpenFact, Rule
from jacaros.agents.mind.state.triggers import namespace_name
from jacaros.agents.terms import plans
from jacaros.agents.terms.operators import qualify, settle
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import ATOMIC, related, rename, resolve
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import (
    ACTION,
    CONS,
    FALSE,
    LOGIC,
    NEGATED,
    NIL,
    RELATION,
    TRUE,
    Annotated,
    Functor,
    Term,
    Var,
    annotations_of,
    arguments_of,
    atom,
    bare,
    deref,
    functor,
    list_items,
    list_length,
    make_list,
)

# The relation ``=..`` between a term and the list of its parts.


_DEFAULT = atom("default")


def deconstruct(left: Term, right: Term, trail: Trail) -> bool:
    """The relation ``=..``: a literal and the list ``[namespace, functor, arguments, annotations]``.

    The namespace may be left out of a list that is given.
    """
    term = resolve(left)
    if term.__class__ is Var:
        made = constructed(tuple(list_items(right)))
        return made is not None and unify(term, made, trail)
    parts = deconstructed(term, list_length(right))
    return parts is not None and unify(make_list(parts), right, trail)


def deconstructed(term: Term, count: int) -> tuple[Term, ...] | None:
    """The parts of a literal (without the namespace where *count* is 3) or of a plan; None for any other term."""
    term = resolve(term)
    inner = term if term.__class__ is tuple else bare(term)
    arguments: Term = NIL
    if inner.__class__ is Functor:
        symbol = inner
    elif inner.__class__ is not tuple or inner[0] is CONS:
        return None
    elif inner[0] is plans.PLAN:
        return None if count == 3 else _plan_parts(inner)
    else:
        symbol, arguments = inner[0], make_list(inner[1:])
    annotations = make_list(annotations_of(term)) if term is not inner else NIL
    if count == 3:
        return symbol.as_atom(), arguments, annotations
    return atom(symbol.namespace or "default"), symbol.as_atom(), arguments, annotations


def deconstruct_in(namespace: Term, left: Term, right: Term, trail: Trail) -> bool:
    """The relation ``=..`` for a left side that is written in a namespace: its name, or a variable for it."""
    term = resolve(left)
    if term.__class__ is not Var:
        name = namespace if namespace.__class__ is str else namespace_name(resolve(namespace))
        return deconstruct(qualify(term, name, False), right, trail)
    parts = tuple(resolve(i) for i in list_items(right))
    wanted = atom(namespace) if namespace.__class__ is str else namespace
    if len(parts) != 4 or not unify(wanted, parts[0], trail):
        return False
    made = constructed(parts, namespace_name(parts[0]))
    return made is not None and unify(term, made, trail)


def _plan_parts(plan: Term) -> tuple[Term, ...]:
    """Label, trigger, context and body of a plan."""
    label, event, context, body = plan[1:]
    event = deref(event)
    return label, (plans.PLAN_TRIGGER, *event[1:]), context, body


def constructed(parts: tuple[Term, ...], allowed: str | None = None) -> Term:
    """The literal (of the namespace *allowed*) or plan with these parts; None when they are not those of one."""
    parts = tuple(part if part.__class__ in ATOMIC else resolve(part) for part in parts)
    if len(parts) == 3:
        parts = (_DEFAULT, *parts)
    if len(parts) != 4:
        return None
    namespace, name, arguments, annotations = parts
    if name.__class__ is tuple and name[0] in plans.TRIGGERS:
        return _plan_of(*parts)
    if name.__class__ is not Functor or namespace_name(namespace) != allowed:
        return None
    term: Term = tuple(list_items(arguments))
    symbol = functor(name.name, len(term), name.negated, allowed)
    term = (symbol, *term) if term else symbol
    found = annotation_set(tuple(list_items(annotations)))
    return Annotated(term, found) if found else term


def _plan_of(label: Term, event: Term, context: Term, body: Term) -> Term:
    if plans.is_body(body):
        body = plans.make_body(plans.body_steps(body))
    return (plans.PLAN, label, (plans.TRIGGER, *event[1:]), context, body)


def answers(agent: Circumstance, node: nodes.Node, lookup: Lookup, trail: Trail) -> Answers:
    """Answers of a condition of the program; its variables are given by *lookup*."""
    if isinstance(node, nodes.And):
        return _all(agent, operands(node), 0, lookup, trail)
    if isinstance(node, nodes.Or):
        return _any(agent, operands(node), lookup, trail)
    if isinstance(node, nodes.Not):
        return _none(agent, node.operand, lookup, trail)
    if isinstance(node, nodes.Literal) and isinstance(node.namespace, nodes.Variable):
        return _in_any_namespace(agent, node, node.namespace, lookup, trail)
    if isinstance(node, nodes.InternalAction) and (action := collecting(agent, node)) is not None:
        return _collecting(agent, action, node, lookup, trail)
    if isinstance(node, nodes.Relation) and node.operator == "=..":
        return _deconstruction(node, lookup, trail)
    return solve_formula(agent, lower(node, lookup), trail)


def _deconstruction(node: nodes.Relation, lookup: Lookup, trail: Trail) -> Answers:
    """``X =.. L``, where X may be written in a namespace."""
    left, right = node.left, lower(node.right, lookup)
    mark = len(trail)
    if isinstance(left, nodes.Variable) and left.namespace is not None:
        place = left.namespace if isinstance(left.namespace, str) else lookup(left.namespace.name)
        fits = deconstruct_in(place, lower(nodes.replace(left, namespace=None), lookup), right, trail)
    else:
        fits = deconstruct(lower(left, lookup), right, trail)
    if fits:
        yield ()
    undo(trail, mark)


def _all(
    agent: Circumstance, formulae: list[nodes.Node], first: int, lookup: Lookup, trail: Trail
) -> Answers:
    if first == len(formulae):
        yield ()
        return
    found = answers(agent, formulae[first], lookup, trail)
    while (yield found) is not None:
        others = _all(agent, formulae, first + 1, lookup, trail)
        while (yield others) is not None:
            yield ()


def _any(agent: Circumstance, formulae: list[nodes.Node], lookup: Lookup, trail: Trail) -> Answers:
    for formula in formulae:
        found = answers(agent, formula, lookup, trail)
        while (yield found) is not None:
            yield ()


def _none(agent: Circumstance, formula: nodes.Node, lookup: Lookup, trail: Trail) -> Answers:
    if not exists(run(answers(agent, formula, lookup, trail), agent.options.rule_depth), trail):
        yield ()


def _in_any_namespace(
    agent: Circumstance, node: nodes.Literal, namespace: nodes.Variable, lookup: Lookup, trail: Trail
) -> Answers:
    pattern = lower(nodes.replace(node, namespace=None), lookup)
    items = tail = None
    if pattern.__class__ is Annotated:
        items, tail = pattern.annotations, pattern.tail
    arguments = arguments_of(pattern)
    return solve_in_namespaces(
        agent, lookup(namespace.name), node.functor, node.negated, arguments, items, tail, trail
    )


def _collecting(
    agent: Circumstance, action: InternalAction, node: nodes.InternalAction, lookup: Lookup, trail: Trail
) -> Answers:
    """Collect the answers of a formula of the program, as ``.findall`` does."""
    *template, formula, target = node.arguments
    search = answers(agent, formula, lookup, trail)
    wanted = lower(template[0], lookup) if template else 0.0
    mark = len(trail)
    if _collect(agent, action, wanted, search, lower(target, lookup), trail):
        yield ()
    undo(trail, mark)


def interpret_rule(
    agent: Circumstance, rule: nodes.Rule, arguments: tuple[Term, ...], trail: Trail
) -> Answers:
    """Answers of a rule for the given arguments; each is empty, or holds the annotations of the rule's head."""
    lookup = fresh_names()
    head = lower(rule.head, lookup)
    if not unify_rows(arguments, arguments_of(head), trail):
        return
    search = answers(agent, rule.body, lookup, trail)
    while (yield search) is not None:
        yield () if rule.head.annotations is None else (tuple(map(resolve, annotations_of(head))),)


def solve_formula(agent: Circumstance, formula: Term, trail: Trail) -> Answers:
    """Answers of any formula given as a term (see `jacaros.agents.mind.rules.searching.run` for the protocol)."""
    formula = settle(formula)
    kind = formula.__class__
    if kind is tuple:
        symbol = formula[0]
        if symbol is NEGATED:
            return _anything(agent, formula, trail)
        if symbol.kind == LOGIC:
            return _logic(agent, symbol.name, formula, trail)
        if symbol.kind == RELATION:
            return _relation(symbol.name, formula[1], formula[2], trail)
        if symbol.kind == ACTION:
            return _action(agent, symbol, formula[1:], trail)
        return solve(agent, agent.beliefs[symbol], formula[1:], trail)
    if kind is Functor:
        return _atom(agent, formula, trail)
    if kind is Annotated:
        return _annotated(agent, formula, trail)
    if kind is Var:
        return _anything(agent, formula, trail)
    return _nothing()


def _nothing() -> Answers:
    return
    yield


def _once() -> Answers:
    yield ()


def _atom(agent: Circumstance, symbol: Functor, trail: Trail) -> Answers:
    if symbol is TRUE:
        return _once()
    if symbol is FALSE or symbol is NIL:
        return _nothing()
    if symbol.kind == ACTION:
        return _action(agent, symbol, (), trail)
    return solve(agent, agent.beliefs[symbol], (), trail)


def _annotated(agent: Circumstance, formula: Annotated, trail: Trail) -> Answers:
    term = settle(formula.term)
    if term.__class__ is Annotated:
        return _annotated(agent, resolve(formula), trail)
    if term.__class__ is Var or (term.__class__ is tuple and term[0] is NEGATED):
        return _anything(agent, formula, trail)
    symbol, arguments = (term[0], term[1:]) if term.__class__ is tuple else (term, ())
    return solve_annotated(agent, agent.beliefs[symbol], arguments, formula.annotations, formula.tail, trail)


def _anything(agent: Circumstance, pattern: Term, trail: Trail) -> Answers:
    """A variable as a query: every belief."""
    for symbol, table in list(agent.beliefs.items()):
        for entry, annotations in table.entries():
            if isinstance(entry, Rule):
                continue
            believed = entry.head() if isinstance(entry, OpenFact) else literal(symbol, entry, annotations)
            mark = len(trail)
            if unify(pattern, believed, trail):
                yield ()
            undo(trail, mark)


def _logic(agent: Circumstance, name: str, formula: Term, trail: Trail) -> Answers:
    if name == "&":
        left = solve_formula(agent, formula[1], trail)
        while (yield left) is not None:
            right = solve_formula(agent, formula[2], trail)
            while (yield right) is not None:
                yield ()
    elif name == "|":
        for side in formula[1:]:
            search = solve_formula(agent, side, trail)
            while (yield search) is not None:
                yield ()
    elif not exists(run(solve_formula(agent, formula[1], trail), agent.options.rule_depth), trail):
        yield ()


def _relation(name: str, left: Term, right: Term, trail: Trail) -> Answers:
    mark = len(trail)
    if _holds(name, left, right, trail):
        yield ()
    undo(trail, mark)


def _holds(name: str, left: Term, right: Term, trail: Trail) -> bool:
    if name == "=":
        return unify(left, right, trail)
    if name == "=..":
        return deconstruct(left, right, trail)
    return related(name, left, right)


def collecting(agent: Circumstance, node: nodes.InternalAction) -> InternalAction | None:
    """The internal action that a formula calls, if it collects the answers of one of its arguments."""
    action = agent.engine.actions.get(node.name)
    return action if action is not None and action.is_collecting(len(node.arguments)) else None


def _action(agent: Circumstance, symbol: Functor, arguments: tuple[Term, ...], trail: Trail) -> Answers:
    mark = len(trail)
    context = agent.context
    action = agent.engine.actions.get(symbol.name)
    if action is None:
        unknown(context, symbol.name)
        return
    if not action.takes(len(arguments)):
        refuse_quietly(context, action, len(arguments))
        return
    if action.body_only:
        cannot_wait(context, action)
        return
    if action.collects:
        if collect_formula(agent, action, arguments, trail):
            yield ()
        undo(trail, mark)
        return
    values = [resolve(a) for a in arguments]
    if action.backtracks:
        for _ in answers_of(context, trail, action, *values):
            yield ()
    elif holds(context, trail, action, *values):
        yield ()
    undo(trail, mark)


def collect_formula(
    agent: Circumstance, action: InternalAction, arguments: tuple[Term, ...], trail: Trail
) -> bool:
    """Collect the answers of a formula that is known only now, as ``.findall`` does."""
    template, formula, target = (0.0, *arguments)[-3:]
    return _collect(agent, action, template, solve_formula(agent, formula, trail), target, trail)


def _collect(
    agent: Circumstance, action: InternalAction, template: Term, search: Answers, target: Term, trail: Trail
) -> bool:
    mark = len(trail)
    found = []
    for _ in run(search, agent.options.rule_depth):
        found.append(rename(template))
    undo(trail, mark)
    return unify(target, action.function(found), trail)


def solve_in_namespaces(
    agent: Circumstance,
    namespace: Term,
    name: str,
    negated: bool,
    arguments: tuple[Term, ...],
    items: tuple[Term, ...] | None,
    tail: Term,
    trail: Trail,
) -> Answers:
    """Answers of a literal whose namespace is a variable; an unbound one takes every namespace in turn."""
    for symbol in list(agent.beliefs):
        if symbol.name != name or symbol.arity != len(arguments) or symbol.negated != negated:
            continue
        mark = len(trail)
        if unify(namespace, atom(symbol.namespace or "default"), trail):
            table = agent.beliefs[symbol]
            if items is None:
                search = solve(agent, table, arguments, trail)
            else:
                search = solve_annotated(agent, table, arguments, items, tail, trail)
            while (yield search) is not None:
                yield ()
        undo(trail, mark)
