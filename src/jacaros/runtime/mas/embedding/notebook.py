"""What notebooks show of systems and agents: tables of beliefs and intentions, as HTML."""

import html
from collections.abc import Iterable, Sequence
from itertools import islice

from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import goals
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.values import Term, annotations_of, bare

_MOST_ROWS, _LONGEST = 100, 200
"""Maximum numbers of rows in a table, and of characters in a cell."""
_CELL = "text-align:left;overflow-wrap:anywhere;min-width:8em"


def system_html(title: str, agents: Sequence[tuple[str, Mind | None]]) -> str:
    """Return a table of a system's agents, and the tables of each agent folded below it."""
    folded = (
        f"<details><summary>{html.escape(name)}</summary>{agent_html('', mind)}</details>"
        for name, mind in agents[:_MOST_ROWS]
        if mind is not None
    )
    counts = ([name, *_counts(mind)] for name, mind in agents)
    return _table(title, ["agent", "beliefs", "intentions"], counts) + "".join(folded)


def _counts(mind: Mind | None) -> list[str]:
    return (
        ["written in Python"]
        if mind is None
        else [str(len([*mind.beliefs.literals()])), str(len(mind.alive))]
    )


def agent_html(title: str, mind: Mind | None) -> str:
    """Return the tables of an agent; only its title if it is written in Python."""
    if mind is None:
        return _table(title, [], [])
    beliefs = ([_joined([bare(each)]), _joined(annotations_of(each))] for each in mind.beliefs.literals())
    intentions = (
        [str(each.id), each.state, _joined(map(bare, goals.goal_literals(each)))]
        for each in mind.alive.values()
    )
    heads = ["intention", "state", "goals, the current one first"]
    return _table(title, ["belief", "annotations"], beliefs) + _table("", heads, intentions)


def _joined(terms: Iterable[Term]) -> str:
    joined = ", ".join(text(excerpt(each)) for each in terms)
    return joined if len(joined) <= _LONGEST else f"{joined[:_LONGEST]}..."


def _table(title: str, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return a table; texts of agents are data, so all are escaped."""
    shown = list(islice(rows, _MOST_ROWS + 1))
    shown[_MOST_ROWS:] = [["..."]] * (len(shown) > _MOST_ROWS)
    lines = _row("th", heads) + "".join(_row("td", row) for row in shown)
    return f'<table><caption style="{_CELL}">{html.escape(title)}</caption>{lines}</table>'


def _row(kind: str, cells: Sequence[str]) -> str:
    shown = (f'<{kind} style="{_CELL}">{html.escape(each)}</{kind}>' for each in cells)
    return f"<tr>{''.join(shown)}</tr>"
