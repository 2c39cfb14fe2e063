"""Internal actions about beliefs, rules and conditions."""

from collections.abc import Iterator

from jacaros.asl import nodes
from jacaros.asl.lowering import fresh_names, lower
from jacaros.bdi.actions.internal_action import WrongArguments, internal_action
from jacaros.bdi.rules import belief_update
from jacaros.bdi.rules.context import Context
from jacaros.bdi.state.belief_base import parts, without_sources
from jacaros.bdi.state.literals import own_annotations
from jacaros.bdi.state.rule import Rule
from jacaros.terms.order import annotation_set, compare
from jacaros.terms.plans import RULE
from jacaros.terms.substitution import rename, resolve
from jacaros.terms.text import text
from jacaros.terms.unifier import undo, unify, unify_annotations
from jacaros.terms.values import FALSE, TRUE, Term, Var, bare, functor_of, make_list


@internal_action(".abolish", arity=1)
def abolish(ctx: Context, pattern: Term) -> None:
    """``.abolish(P)``: delete all beliefs that match, with all their sources."""
    belief_update.abolish(ctx.agent, pattern)


def _assert(ctx: Context, term: Term, last: bool) -> None:
    if term.__class__ is tuple and term[0] is RULE:
        ctx.agent.change_rule("+>" if last else "+", term)
        return
    symbol, row, annotations = parts(term)
    if symbol is None:
        raise WrongArguments(f"a literal or a rule is expected, not {text(term)}")
    own = own_annotations(annotations)
    new = belief_update.insert(ctx.agent, symbol, row, own, last)
    if new is not None:
        belief_update.external_change(ctx.agent, "+", symbol, row, new)


@internal_action(".asserta", arity=1)
def asserta(ctx: Context, term: Term) -> None:
    """``.asserta(L)``: add a belief or rule before all others."""
    _assert(ctx, term, last=False)


@internal_action(".assertz", arity=1)
def assertz(ctx: Context, term: Term) -> None:
    """``.assertz(L)``: add a belief or rule behind all others."""
    _assert(ctx, term, last=True)


@internal_action(".belief", arity=1, backtracks=True)
def belief(ctx: Context, pattern: Term) -> Iterator[None]:
    """``.belief(P)``: each matching belief that is held, rules left out."""
    wanted = functor_of(pattern)
    for literal in list(ctx.agent.beliefs.literals()):
        if (wanted is None or functor_of(literal) is wanted) and ctx.unify(pattern, literal):
            yield


@internal_action(".list_rules", arity=0)
def list_rules(ctx: Context) -> None:
    """Print the rules."""
    for table in ctx.agent.beliefs.values():
        for entry, _ in table.entries():
            if isinstance(entry, Rule):
                ctx.architecture.print(entry.text())


@internal_action(".relevant_rules", arity=2)
def relevant_rules(ctx: Context, pattern: Term, target: Term) -> bool:
    """``.relevant_rules(P, Rs)``: Rs is the list of the rules that can prove a literal, in the order of the base.

    With *P* unbound these are all rules.

    Raises:
        WrongArguments: *P* is no literal.
    """
    symbol, _, annotations = parts(pattern)
    if symbol is None and bare(pattern).__class__ is not Var:
        raise WrongArguments(f"a literal is expected, not {text(pattern)}")
    beliefs = ctx.agent.beliefs
    found = []
    for table in beliefs.values() if symbol is None else (beliefs[symbol],):
        for entry, held in table.entries():
            if not isinstance(entry, Rule):
                continue
            rule = lower(nodes.RuleTerm(entry.node), fresh_names())
            mark = len(ctx.trail)
            fits = unify(bare(pattern), bare(rule[1]), ctx.trail) and unify_annotations(
                annotations, None, held, None, ctx.trail
            )
            undo(ctx.trail, mark)
            if fits:
                found.append((rule[0], without_sources(rule[1]), rule[2]))
    return ctx.unify(target, make_list(found))


@internal_action(".eval", arity=2)
def evaluate(ctx: Context, target: Term, formula: Term) -> bool:
    """``.eval(X, F)``: X is ``true`` or ``false``."""
    mark = len(ctx.trail)
    holds = ctx.succeeds(formula)
    while len(ctx.trail) > mark:
        ctx.trail.pop().ref = None
    return ctx.unify(target, TRUE if holds else FALSE)


@internal_action(".findall", arity=3, condition=1, collects=True, repeatable=True)
def findall(found: list[Term]) -> Term:
    """``.findall(T, F, L)``: L is the list of T for all answers of F, in order, duplicates kept."""
    return make_list(found)


@internal_action(".setof", arity=3, condition=1, collects=True, repeatable=True)
def setof(found: list[Term]) -> Term:
    """``.setof(T, F, L)``: like `.findall`, sorted and without duplicates."""
    return make_list(annotation_set(tuple(found)))


@internal_action(".count", arity=2, condition=0, collects=True, repeatable=True)
def count(found: list[Term]) -> Term:
    """``.count(F, N)``: N is the number of answers of F."""
    return float(len(found))


def best(ctx: Context, template: Term, formula: Term, sign: int) -> Term | None:
    """The greatest (sign 1) or smallest (sign -1) instance of a template, None without answers."""
    found: Term | None = None
    mark = len(ctx.trail)
    for _ in ctx.answers(formula):
        value = rename(resolve(template))
        if found is None or sign * compare(value, found) > 0:
            found = value
    while len(ctx.trail) > mark:
        ctx.trail.pop().ref = None
    return found


@internal_action(".perceive", arity=0)
def perceive(ctx: Context) -> None:
    """Look at the environment at once: nothing is left unseen between two cycles anyway."""
    del ctx
