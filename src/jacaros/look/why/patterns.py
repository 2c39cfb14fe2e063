"""Literals in questions, such as ``+alarm(_)`` or ``!go(dock)``, matched against recorded texts."""

import re
from dataclasses import dataclass

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import parse_literal
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Term, bare
from jacaros.runtime.errors import UsageError

_PARTS = re.compile(r"\s*([+\-^]*)\s*([!?]?)\s*(.*)", re.DOTALL)
_NAME = re.compile(r"~?\s*(?:\w+::)?(?:'[^']*'|[\w.]+)")
_PLAIN_NAME = re.compile(r"~?(?:\w+::)?(?:'[^']*'|\w+)")


@dataclass(frozen=True, slots=True)
class Question:
    """A parsed question.

    Attributes:
        written: as it was asked.
        kind: one of `jacaros.look.why.why.KINDS`, or ``name`` (a lone word, which may be a belief, a goal or a label).
        about: its subject: a literal, a plan, a topic; empty without one.
        agent, robot: the only ones that the answer is about; empty for all.
    """

    written: str
    kind: str = "event"
    about: str = ""
    agent: str = ""
    robot: str = ""


class QuestionPattern:
    """An event, goal or belief in a question.

    Attributes:
        sign: ``+``, ``-``, ``^``, or empty for any.
        kind: ``!``, ``?``, or empty for a belief.
        written: the literal as written.
        name: name of the literal.

    Args:
        text: sign, kind and literal. A literal without brackets matches any arguments; variables match anything.

    Raises:
        UsageError: it is not an event, a goal or a belief.
    """

    def __init__(self, text: str) -> None:
        sign, self.kind, literal = _split(text)
        self.sign, self.written = sign[-1:], literal.strip()
        self.name, term = _name(self.written), _term(self.written)
        if term is None:
            raise UsageError(
                f"error: expected an event, a goal or a belief, found `{text}`\n"
                "  = help: such as `+alarm(_)` or `!go(dock)`"
            )
        self._term = None if self.name == self.written else term

    def fits(self, recorded: str) -> bool:
        """Return whether a recorded trigger, goal or belief matches."""
        sign, kind, literal = _split(recorded)
        if (
            kind != self.kind
            or (self.sign and self.sign != (sign[-1:] or "+"))
            or _name(literal) != self.name
        ):
            return False
        return self._term is None or _is_instance(self._term, literal)

    def fits_literal(self, recorded: str) -> bool:
        """Return whether the literal of a recorded trigger, goal or belief matches, whatever the signs."""
        literal = _split(recorded)[2]
        return _name(literal) == self.name and (self._term is None or _is_instance(self._term, literal))


def _split(text: str) -> tuple[str, str, str]:
    found = _PARTS.fullmatch(text)
    assert found is not None, "the last part matches everything"
    return found[1], found[2], found[3]


def name_of(text: str) -> str:
    """Return the name in a trigger, goal or belief, such as ``go`` in ``+!go(dock)``; empty if it has none."""
    return _name(_split(text)[2])


def literal_at(text: str, start: int) -> str:
    """Return the literal at a position of a text, without what follows its name and arguments."""
    name = _PLAIN_NAME.match(text, start)
    if name is None:
        return text[start:]
    if text[name.end() : name.end() + 1] != "(":
        return name[0]
    depth, quoted = 0, False
    for at in range(name.end(), len(text)):
        quoted ^= text[at] == '"'
        depth += 0 if quoted else (text[at] in "([{") - (text[at] in ")]}")
        if depth == 0:
            return text[start : at + 1]
    return text[start:]


def unsigned(text: str) -> str:
    """Return a trigger or goal without ``+`` or ``-`` before it."""
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
    """Return whether a recorded literal unifies with a wanted one. A truncated one counts, too."""
    found, trail = _term(literal), Trail()
    if found is None:
        return True
    try:
        return unify(bare(wanted), bare(found), trail)
    finally:
        undo(trail, 0)
