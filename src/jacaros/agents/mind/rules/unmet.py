"""Why nothing answers a literal: the agent lacks that belief, or has it with another name, number or kind of arguments."""

import re
from collections.abc import Iterable, Iterator, Mapping

from jacaros.agents.mind.state.belief_base import Table, literal
from jacaros.agents.mind.state.circumstance import Circumstance
from jacaros.agents.mind.state.plan import Plan
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.values import Functor, String, Term, arguments_of, bare, functor_of, is_list
from jacaros.runtime.files.texts import close_matches, did_you_mean

MOST_FACTS = 1_000
"""Of a belief with more facts, the kinds of values are not compared."""


def unmet(agent: Circumstance, wanted: Term) -> str:
    """Describe why no belief answers a literal; empty if the reason is only another value."""
    symbol = functor_of(wanted)
    if symbol is None:
        return ""
    missing = missing_belief(agent.beliefs, symbol)
    if missing or _is_held(agent.beliefs.get(symbol)):
        return missing or other_kind(agent.beliefs, symbol, arguments_of(wanted))
    return "" if is_added(symbol, agent.library.plans) else f"no belief `{symbol.name}`, and no plan adds it"


def missing_belief(tables: Mapping[Functor, Table], wanted: Functor) -> str:
    """Return ``no belief `ready```, with a similar name if there is one.

    Return an empty string if facts or rules of that name exist, or if nothing can be added to a name without arguments.

    Args:
        tables: facts and rules of the agent by functor.
        wanted: functor of the literal in the condition.
    """
    if _is_held(tables.get(wanted)):
        return ""
    same = sorted(symbol.arity for symbol in _held(tables, wanted) if symbol.name == wanted.name)
    if same:
        known = ", ".join(f"`{wanted.name}/{arity}`" for arity in same)
        return f"no belief `{wanted.name}/{wanted.arity}`; there is {known}"
    near = close_matches(wanted.name, sorted({symbol.name for symbol in _held(tables, wanted)}))
    if not near and not wanted.arity:
        return ""
    sign = "~" if wanted.negated else ""
    help = did_you_mean(f"{sign}{name}" for name in near)
    return f"no belief `{sign}{wanted.name}`{'; ' * bool(help)}{help}"


def _held(tables: Mapping[Functor, Table], wanted: Functor) -> Iterator[Functor]:
    """Yield the functors in use that differ from *wanted* only by name or number of arguments."""
    for symbol, table in tables.items():
        if _is_held(table) and (symbol.namespace, symbol.negated) == (wanted.namespace, wanted.negated):
            yield symbol


def _is_held(table: Table | None) -> bool:
    return table is not None and bool(table.rows or table.late)


def other_kind(tables: Mapping[Functor, Table], symbol: Functor, wanted: Iterable[Term]) -> str:
    """Return ``the belief is `mode("idle")`: a string, not an atom`` if no fact has a value of a wanted kind."""
    table = tables[symbol]
    if table.others or table.late or len(table.rows) > MOST_FACTS:
        return ""
    rows = list(table.rows)
    for place, value in enumerate(wanted):
        kind = kind_of(value)
        if kind and not {"", kind} & {kind_of(row[place]) for row in rows}:
            fact = text(excerpt(literal(symbol, rows[-1])))
            return f"the belief is `{fact}`: {kind_of(rows[-1][place])}, not {kind}"
    return ""


def kind_of(term: Term) -> str:
    """Return the kind of a value, such as ``a string``; empty for variables."""
    term = bare(term)
    if term.__class__ in (int, float):
        return "a number"
    if term.__class__ is String:
        return "a string"
    if is_list(term):
        return "a list"
    symbol = functor_of(term)
    return "" if symbol is None else "a structure" if symbol.arity else "an atom"


def is_added(symbol: Functor, plans: Iterable[Plan]) -> bool:
    """Return whether a plan may add a belief without arguments: whether a program with one of the plans has ``+name``."""
    files = {plan.node.span.file for plan in plans if plan.node.span is not None}
    sign = "~" if symbol.negated else ""
    return any(re.search(rf"[+<>]\s*{sign}{re.escape(symbol.name)}\b", file.text) for file in files)
