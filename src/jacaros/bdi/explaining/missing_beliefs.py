"""Beliefs that a condition asks for and an agent lacks entirely: no fact and no rule has that name."""

from collections.abc import Iterator, Mapping

from jacaros.bdi.state.belief_base import Table
from jacaros.suggestions import close_matches, did_you_mean
from jacaros.terms.values import Functor


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
