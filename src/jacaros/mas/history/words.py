"""Terms in records: short, with the names that users gave."""

import re

from jacaros.agents.mind.state.triggers import EventAnnotations, Goal, literal_of
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import is_flat
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.values import Term

LONGEST = 300
"""Maximum number of characters of a recorded term."""
_UNNAMED = re.compile(r'"(?:[^"\\]|\\.)*"|\b_\w+')


def shown(term: Term) -> str:
    """Return a term as text: the beginning of a large one, and ``_`` for unnamed variables."""
    if is_flat(term):
        return cut(text(term))
    try:
        return cut(named(text(excerpt(term))))
    except (ArithmeticFault, RecursionError):
        return "..."


def shown_event(goal: Goal, annotations: EventAnnotations = ()) -> str:
    """Return a goal or event with its operator, such as ``+!go(dock)`` or ``+battery(12)``."""
    kind = goal[0]
    return f"{kind.operator}{kind.kind}{shown(literal_of(goal, annotations))}"


def named(told: str) -> str:
    """Replace unnamed variables such as ``_22`` with ``_``."""
    return _UNNAMED.sub(_name, told) if "_" in told else told


def _name(found: re.Match[str]) -> str:
    word = found.group()
    return word if word[0] == '"' else "_"


def cut(told: str) -> str:
    """Return the beginning of a long text."""
    return told if len(told) <= LONGEST else f"{told[: LONGEST - 3]}..."
