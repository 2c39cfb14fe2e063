"""What a condition asks for and an agent does not believe at all: no fact and no rule has that name."""

from collections.abc import Iterator, Mapping

from jacaros.asl.slips import close_matches
from jacaros.bdi.state.belief_base import Table
from jacaros.terms.values import Functor

LIKE = 0.75
"""How like two names are, from 0 to 1, for one to be suggested for the other."""


def missing_belief(tables: Mapping[Functor, Table], wanted: Functor) -> str:
    """Return ``no belief `ready```, with a near name if there is one; empty if facts or rules of that name are held, or if
    there is nothing to add to a name without arguments.

    Args:
        tables: facts and rules of the agent by functor.
        wanted: functor of the literal that is asked for.
    """
    if _is_held(tables.get(wanted)):
        return ""
    same = sorted(symbol.arity for symbol in _held(tables, wanted) if symbol.name == wanted.name)
    if same:
        known = ", ".join(f"`{wanted.name}/{arity}`" for arity in same)
        return f"no belief `{wanted.name}/{wanted.arity}`; there is {known}"
    near = close_matches(wanted.name, sorted({symbol.name for symbol in _held(tables, wanted)}), LIKE)
    if not near and not wanted.arity:
        return ""
    sign = "~" if wanted.negated else ""
    help = f"; did you mean `{sign}{near[0]}`?" if near else ""
    return f"no belief `{sign}{wanted.name}`{help}"


def _held(tables: Mapping[Functor, Table], wanted: Functor) -> Iterator[Functor]:
    """The functors of what is held that differ from *wanted* by name or number of arguments only."""
    for symbol, table in tables.items():
        if _is_held(table) and (symbol.namespace, symbol.negated) == (wanted.namespace, wanted.negated):
            yield symbol


def _is_held(table: Table | None) -> bool:
    return table is not None and bool(table.rows or table.late)
