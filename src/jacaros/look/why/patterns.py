"""Literals in questions, such as ``+alarm(_)`` or ``!go(dock)``, matched against recorded texts."""

import re
from collections.abc import Callable
from dataclasses import dataclass

from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import parse_literal
from jacaros.agents.language.lowering import lower_value
from jacaros.agents.terms.operators import ArithmeticFault
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Term, bare
from jacaros.runtime.errors import UsageError

_PLAN = re.compile(r"@\w+|[\w./\\-]+\.asl:\d+")
_EVENT = re.compile(r"(?:^|(?<=[\s`'\"]))(?:[+\-]?[!?]|[+\-^])(?=~?[a-z_'])")
LITERAL = re.compile(r"~?[a-z]\w*(?=\()|(?:(?<=^belief\s)|(?<=changed\s))~?[a-z]\w*")
_PARTS = re.compile(r"\s*([+\-^]*)\s*([!?]?)\s*(.*)", re.DOTALL)
_PLAIN = re.compile(r"[a-z]\w*(?=[(\[])")
_NAME = re.compile(r"~?\s*(?:\w+::)?(?:'[^']*'|[\w.]+)")
_PLAIN_NAME = re.compile(r"~?(?:\w+::)?(?:'[^']*'|\w+)")


@dataclass(frozen=True, slots=True)
class Question:
    """A parsed question.

    Attributes:
        written: as it was asked.
        kind: ``event``, ``plan``, ``belief``, ``command``, or ``sentence`` for one in other words.
        about: its subject: a literal, a plan, a topic, or the sentence.
        agent, robot: the only ones that the answer is about; empty for all.
    """

    written: str
    kind: str = "event"
    about: str = ""
    agent: str = ""
    robot: str = ""

    @classmethod
    def read(cls, written: str, is_sentence: Callable[[str], bool]) -> "Question":
        """Return the form of a question and its subject.

        Args:
            written: the question.
            is_sentence: tells whether a question that begins with this word is a sentence, even if it names an event.

        Raises:
            UsageError: its event is not an event.
        """
        asked = written.strip(" ?.`'\"\n") if written.strip(" `'\"?") else written
        asked = f"?{asked}" if written.lstrip(" `'\"").startswith("?") else asked
        words = asked.split()
        if found := _PLAN.search(asked):
            return cls(written, "plan", found[0])
        if words and is_sentence(words[0].lower()):
            return cls(written, "sentence", asked)
        if found := _EVENT.search(asked):
            of_plan = "plan" in asked[: found.start()].split()
            event = found[0] + literal_at(asked, found.end())
            QuestionPattern(event)  # raises if it is not a literal
            return cls(written, "plan" if of_plan else "event", event)
        if words and (words[0] == "command" or (words[0] == "plan" and words[1:])):
            return cls(written, words[0], " ".join(words[1:]))
        if asked.startswith("belief(") and asked.endswith(")"):
            asked = f"belief {asked.removeprefix('belief(')[:-1]}"
        if found := LITERAL.search(asked):
            return cls(written, "belief", literal_at(asked, found.start()))
        return cls(written, "sentence", asked)


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
        sign, kind, _ = _split(recorded)
        has_sign = self.sign in ("", sign[-1:] or "+")
        return has_sign and kind == self.kind and self.fits_literal(recorded)

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
    if plain := _PLAIN.match(text):  # most beliefs, of which hours of a run have a million
        return plain[0]
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
