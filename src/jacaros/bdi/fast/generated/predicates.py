"""Code that answers questions for a predicate with rules: one generator for its facts and rules in their order.

What a generator is made for is a *pattern of use*: which arguments are given.  ``search(agent, t, d, *given)`` yields a
row for each answer, whose other arguments are computed and never go through a variable.  Rules call the generators of
other predicates directly, as loops, down to ``NESTED`` of them inside one another (*d* counts down).  What lies deeper is
searched by `jacaros.bdi.rules.searching.run` without Python recursion, and so is what goes on while beliefs change: for
both there is a second function, which does not call, but yields the generators that it wants to have run.
"""

from collections.abc import Sequence

from jacaros.asl import nodes
from jacaros.bdi.fast.generated.building import build, tuple_of
from jacaros.bdi.fast.generated.conditions import condition
from jacaros.bdi.fast.generated.function import FunctionBuilder, Unit
from jacaros.bdi.fast.generated.matching import match_all
from jacaros.terms.values import Functor


def given_positions(pattern: int, arity: int) -> list[int]:
    """The places of the arguments that are given; *pattern* has a bit for each."""
    return [i for i in range(arity) if pattern >> i & 1]


def compile_search(
    unit: Unit,
    symbol: Functor,
    pattern: int,
    before: Sequence[nodes.Rule],
    after: Sequence[nodes.Rule],
    trampoline: bool,
) -> str:
    """Write the generator function of a predicate for one pattern of use; returns its name.

    Args:
        unit: the unit it becomes part of.
        symbol: the predicate.
        pattern: which arguments are given.
        before: the rules that answer before all facts.
        after: those that answer after them.
        trampoline: write the function that is driven by ``run``.
    """
    name = unit.fresh_function("search")
    fn = FunctionBuilder(unit, trampoline=trampoline, depth="d - 1")
    given = {i: f"a{i}" for i in given_positions(pattern, symbol.arity)}
    fn.at((*before, *after)[0])
    with fn.writer.block(f"def {name}({', '.join(['agent', 't', 'd', *given.values()])}):"):
        if not trampoline:
            fn.line("t.room -= 1")
            fn.line("if t.room < 0: too_many_open(agent.options.rule_depth)")
        for rule in before:
            _rule(fn, rule, given)
        fn.at((*before, *after)[0])
        _facts(fn, symbol, given)
        for rule in after:
            _rule(fn, rule, given)
        if not trampoline:
            fn.line("t.room += 1")
        fn.line("return")
        fn.line("yield")
    unit.add(fn.writer)
    return name


def _facts(fn: FunctionBuilder, symbol: Functor, given: dict[int, str]) -> None:
    fn.line(f"b = agent.beliefs[{fn.constant(symbol)}]")
    with fn.writer.block("if len(b.rows) > b.others:"):
        if not given:
            rows = "rows_still_held(b, list(reversed(b.rows)))" if fn.trampoline else "reversed(b.rows)"
            with fn.writer.block(f"for row in {rows}:"):
                fn.line("if row.__class__ is tuple: yield row")
            return
        known = list(given.values())
        if len(given) == symbol.arity:
            rows = f"b.exact({tuple_of(known)})"
        else:
            key = known[0] if len(known) == 1 else tuple_of(known)
            rows = f"b.find({fn.constant(tuple(given))}, {key})"
            rows = f"rows_still_held(b, list({rows}))" if fn.trampoline else rows
        arguments = tuple_of([given.get(i, "Var()") for i in range(symbol.arity)])
        test = " and ".join(f"{value}.__class__ in ATOMIC" for value in known)
        general = f"facts(b, {arguments}, t{', True' if fn.trampoline else ''})"
        fn.line(f"for row in ({rows} if {test} else {general}): yield row")


def _rule(fn: FunctionBuilder, rule: nodes.Rule, given: dict[int, str]) -> None:
    arguments = rule.head.arguments
    mark = fn.local("n")

    def answer() -> None:
        row = [given[i] if i in given else build(fn, a) for i, a in enumerate(arguments)]
        fn.line(f"yield {tuple_of(row)}" if row else "yield ()")

    with fn.branch():
        fn.at(rule)
        fn.line(f"{mark} = len(t)")
        match_all(
            fn,
            [arguments[i] for i in given],
            list(given.values()),
            lambda: condition(fn, rule.body, answer),
        )
        fn.line(f"if len(t) > {mark}: undo(t, {mark})")
