"""Literals of questions, such as ``+alarm(_)`` or ``!go(dock)``, compared with recorded texts."""

import re

from jacaros.asl.diagnostics import AslError
from jacaros.asl.loader import parse_literal
from jacaros.asl.lowering import lower_value
from jacaros.errors import UsageError
from jacaros.terms.operators import ArithmeticFault
from jacaros.terms.substitution import rename
from jacaros.terms.unifier import Trail, undo, unify
from jacaros.terms.values import Term, bare

_PARTS = re.compile(r"\s*([+\-^]*)\s*([!?]?)\s*(.*)", re.DOTALL)
_NAME = re.compile(r"~?\s*(?:\w+::)?(?:'[^']*'|[\w.]+)")


class Pattern:
    """An event, goal or belief that a question names.

    Attributes:
        sign: ``+``, ``-``, ``^``, or empty: any.
        kind: ``!``, ``?``, or empty for a belief.
        written: the literal as it was written.
        name: of the literal.

    Args:
        text: sign, kind and literal.  A literal without brackets fits any arguments; variables fit anything.

    Raises:
        UsageError: it is not an event, a goal or a belief.
    """

    def __init__(self, text: str) -> None:
        sign, self.kind, literal = _split(text)
        self.sign, self.written = sign[-1:], literal.strip()
        self.name, term = _name(self.written), _term(self.written)
        if term is None:
            raise UsageError(
                f"error: not an event, a goal or a belief: `{text}`\n  = help: such as `+alarm(_)` or `!go(dock)`"
            )
        self._term = None if self.name == self.written else term

    def fits(self, recorded: str) -> bool:
        """Whether a recorded trigger, goal or belief is one that is asked for."""
        sign, kind, literal = _split(recorded)
        if (
            kind != self.kind
            or (self.sign and self.sign != (sign[-1:] or "+"))
            or _name(literal) != self.name
        ):
            return False
        return self._term is None or _is_instance(self._term, literal)

    def fits_literal(self, recorded: str) -> bool:
        """Whether the literal of a recorded trigger, goal or belief is one that is asked for, whatever the signs."""
        literal = _split(recorded)[2]
        return _name(literal) == self.name and (self._term is None or _is_instance(self._term, literal))


def _split(text: str) -> tuple[str, str, str]:
    found = _PARTS.fullmatch(text)
    assert found is not None, "the last part takes everything"
    return found[1], found[2], found[3]


def name_of(text: str) -> str:
    """The name in a trigger, goal or belief, such as ``go`` in ``+!go(dock)``; empty if it has none."""
    return _name(_split(text)[2])


def unsigned(text: str) -> str:
    """A trigger or goal without ``+`` or ``-`` before it."""
    return text.lstrip("+-^ ")


def _name(literal: str) -> str:
    found = _NAME.match(literal)
    return "" if found is None else found[0].replace(" ", "")


def _term(literal: str) -> Term | None:
    try:
        return rename(lower_value(parse_literal(literal)))
    except (AslError, ArithmeticFault, RecursionError, ValueError):
        return None


def _is_instance(wanted: Term, literal: str) -> bool:
    """Whether a recorded literal unifies with a wanted one; one that was cut off when it was recorded counts, too."""
    found, trail = _term(literal), Trail()
    if found is None:
        return True
    try:
        return unify(bare(wanted), bare(found), trail)
    finally:
        undo(trail, 0)
