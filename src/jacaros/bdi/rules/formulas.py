"""Formulae that are known only at run time: bound to variables, sent in messages, passed to internal actions.

Formulae of the program itself are compiled (`jacaros.bdi.fast.generated.conditions`); these are searched directly.
"""

from collections.abc import Generator
from typing import Any

from jacaros.bdi.actions.internal_action import InternalAction
from jacaros.bdi.fast.generated.calls import (
    answers_of,
    cannot_wait,
    holds,
    refuse_quietly,
    unknown,
)
from jacaros.bdi.rules.deconstruction import deconstruct
from jacaros.bdi.rules.searching import exists, run, solve, solve_annotated
from jacaros.bdi.state.belief_base import literal
from jacaros.bdi.state.circumstance import Circumstance
from jacaros.bdi.state.rule import OpenFact
from jacaros.terms.arithmetic import settle
from jacaros.terms.substitution import related, rename, resolve
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import (
    ACTION,
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
    atom,
)

Search = Generator[Any, Any, None]


def solve_formula(agent: Circumstance, formula: Term, trail: Trail) -> Search:
    """Answers of any formula given as a term (see `jacaros.bdi.rules.searching.run` for the protocol)."""
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


def _nothing() -> Search:
    return
    yield


def _once() -> Search:
    yield ()


def _atom(agent: Circumstance, symbol: Functor, trail: Trail) -> Search:
    if symbol is TRUE:
        return _once()
    if symbol is FALSE or symbol is NIL:
        return _nothing()
    if symbol.kind == ACTION:
        return _action(agent, symbol, (), trail)
    return solve(agent, agent.beliefs[symbol], (), trail)


def _annotated(agent: Circumstance, formula: Annotated, trail: Trail) -> Search:
    term = settle(formula.term)
    if term.__class__ is Annotated:
        return _annotated(agent, resolve(formula), trail)
    if term.__class__ is Var or (term.__class__ is tuple and term[0] is NEGATED):
        return _anything(agent, formula, trail)
    symbol, arguments = (term[0], term[1:]) if term.__class__ is tuple else (term, ())
    return solve_annotated(agent, agent.beliefs[symbol], arguments, formula.annotations, formula.tail, trail)


def _anything(agent: Circumstance, pattern: Term, trail: Trail) -> Search:
    """A variable as a query: every belief."""
    for symbol, table in list(agent.beliefs.items()):
        for entry, annotations in table.entries():
            if entry.__class__ is not tuple and not isinstance(entry, OpenFact):
                continue
            believed = entry.head() if isinstance(entry, OpenFact) else literal(symbol, entry, annotations)
            mark = len(trail)
            if unify(pattern, believed, trail):
                yield ()
            undo(trail, mark)


def _logic(agent: Circumstance, name: str, formula: Term, trail: Trail) -> Search:
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
    elif not exists(run(solve_formula(agent, formula[1], trail), agent.rule_depth), trail):
        yield ()


def _relation(name: str, left: Term, right: Term, trail: Trail) -> Search:
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


def _action(agent: Circumstance, symbol: Functor, arguments: tuple[Term, ...], trail: Trail) -> Search:
    mark = len(trail)
    context = agent.context
    action = agent.actions.get(symbol.name)
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
    mark = len(trail)
    found = []
    for _ in run(solve_formula(agent, formula, trail), agent.rule_depth):
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
) -> Search:
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
