"""Similarity of words, and mistakes known from other languages, for better messages than "expected X, found Y"."""

from collections.abc import Iterable, Iterator, Sequence
from typing import Final, NamedTuple

from jacaros.asl.lexer import RESERVED, Token
from jacaros.suggestions import did_you_mean
from jacaros.terms.operators import WORDS, symbols_of
from jacaros.terms.values import ARITHMETIC

_FUSED: Final = {
    "&&": "write one `&` for 'and', one `|` for 'or'",
    "||": "write one `&` for 'and', one `|` for 'or'",
    "=<": "write `<=`",
    "=>": "write >=",
    "->": "begin the body of a plan with `<-`",
    "!=": r"write `\==` for 'not equal'",
    "!==": r"write `\==` for 'not equal'",
    "~=": r"write `\==` for 'not equal'",
    "<>": r"write `\==` for 'not equal'",
    ":=": "bind a variable with `=`, as in `X = 3`",
    "=:=": "write `==` for 'equal'",
    "===": "write `==` for 'equal'",
    "+=": "variables keep their value: write `Y = X + 1`, or change a belief with `-+b(Y)`",
    "-=": "variables keep their value: write `Y = X - 1`, or change a belief with `-+b(Y)`",
    "*=": "variables keep their value: write `Y = X * 2`",
    "/=": "variables keep their value: write `Y = X / 2`",
}
"""Operators of other languages, which the lexer reads as several tokens."""

_WORDS: Final = {
    "and": "write `&` for 'and'",
    "or": "write `|` for 'or'",
    "is": "bind a variable with `=`, as in `X = Y + 1`",
    "in": "find elements of a list with `.member`, as in `for (.member(X, L)) { steps }`",
    "then": "put the steps in braces: `if (condition) { steps }`",
    "do": "put the steps in braces: `while (condition) { steps }`",
    "elsif": "write `elif (condition) { steps }`",
    "elseif": "write `elif (condition) { steps }`",
}
"""Keywords of other languages."""

_PYTHON: Final = frozenset({"class", "def", "from", "import"})
_CONTROL: Final = ("if", "while", "for", "elif")
_ENDS_OPERAND: Final = frozenset({"atom", "variable", "number", "string", ")", "]", "}"})
_BEGINS_OPERAND: Final = frozenset({"atom", "variable", "number", "string", "(", "[", "~", "-"})


class Slip(NamedTuple):
    """A likely mistake; ``token`` is the one at fault, None for the current one."""

    code: str
    message: str
    help: str
    token: Token | None = None


def known_slip(tokens: Sequence[Token], index: int) -> Slip | None:
    """Return the likely mistake where the token at *index* does not fit, if it is a known one."""
    return (
        _misspelt(tokens, index)
        or _bare_goal(tokens, index)
        or _prefixed_string(tokens, index)
        or _foreign_word(tokens, index)
        or _python(tokens, index)
        or _open_block(tokens, index)
        or _reserved(tokens[index])
        or _cut(tokens, index)
        or _counting(tokens, index)
        or _fused(tokens, index)
        or _missing_blank(tokens, index)
    )


def _bare_goal(tokens: Sequence[Token], index: int) -> Slip | None:
    """``!start <- steps.``: a plan without the `+` of its trigger."""
    if tokens[index].kind not in ("<-", ":"):
        return None
    start = next((at for at in range(index, 0, -1) if tokens[at - 1].kind == "."), 0)
    if tokens[start].kind not in ("!", "?") or tokens[start + 1].kind != "atom":
        return None
    goal = f"{tokens[start].kind}{tokens[start + 1].text}"
    return Slip(
        "missing-trigger", f"`{goal}` is a goal, not the trigger of a plan", f"write `+{goal}`", tokens[start]
    )


def _prefixed_string(tokens: Sequence[Token], index: int) -> Slip | None:
    """``f"at {X}"``."""
    token, before = tokens[index], tokens[max(index - 1, 0)]
    if (
        token.kind != "string"
        or not _joined(before, token)
        or before.text.lower() not in ("f", "r", "b", "u")
    ):
        return None
    help = (
        'write values between strings, as in `.print("at ", X)`, or join them with `.concat("at ", X, Text)`'
    )
    return Slip("foreign-word", f"strings have no prefix such as `{before.text}` in Python", help, before)


def _reserved(token: Token) -> Slip | None:
    if token.kind not in RESERVED:
        return None
    return Slip(
        "reserved-word",
        f"reserved word `{token.text}` used as a name",
        f"quote it as an atom: '{token.text}'",
    )


def _fused(tokens: Sequence[Token], index: int) -> Slip | None:
    """Find the longest run of adjacent signs around *index* that is an operator of another language."""
    for length in (3, 2, 1):
        for start in range(max(index - length + 1, 0), index + 1):
            run = tokens[start : start + length]
            text = "".join(token.text for token in run)
            if text in _FUSED and len(run) == length and all(map(_joined, run, run[1:])):
                return Slip("wrong-operator", f"unknown operator `{text}`", _FUSED[text])
    return None


def _joined(one: Token, other: Token) -> bool:
    """Return whether nothing is between two tokens."""
    return one.line == other.line and one.end == other.column


def _cut(tokens: Sequence[Token], index: int) -> Slip | None:
    """``p :- q & !``."""
    if tokens[index].kind != "!" or index == 0 or tokens[index - 1].kind not in ("&", ":-"):
        return None
    return Slip(
        "wrong-operator",
        "unknown operator `!` (cut)",
        "a plan takes the first solution of its context; give rules conditions that exclude each other",
    )


def _counting(tokens: Sequence[Token], index: int) -> Slip | None:
    """``X++``."""
    run = tokens[max(index - 3, 0) : index]
    if len(run) < 3 or run[0].kind != "variable" or run[1].kind not in ("+", "-"):
        return None
    if run[2].kind != run[1].kind or run[1].end != run[2].column:
        return None
    sign = run[1].kind
    help = f"variables keep their value: write `Y = X {sign} 1`, or change a belief with `-+b(Y)`"
    return Slip("wrong-operator", f"unknown operator `{sign}{sign}`", help, run[1])


def _missing_blank(tokens: Sequence[Token], index: int) -> Slip | None:
    """``p.q``: the final dot of a clause and the next word, read as one."""
    token, before = tokens[index], tokens[max(index - 1, 0)]
    if (
        _joined(before, token)
        and token.kind == "atom"
        and token.text.startswith(".")
        and before.kind in (")", "]", "atom")
    ):
        return Slip(
            "missing-blank",
            f"`{token.text}` is read as one word",
            "put a blank or a line end after the final `.`",
        )
    return None


def _foreign_word(tokens: Sequence[Token], index: int) -> Slip | None:
    """``a and b``, ``X is 1``, ``if (c) then``."""
    token = tokens[index]
    if index == 0 or token.kind != "atom" or token.text not in _WORDS:
        return None
    if tokens[index - 1].kind not in _ENDS_OPERAND:
        return None
    return Slip("foreign-word", f"unknown keyword `{token.text}`", _WORDS[token.text])


def _python(tokens: Sequence[Token], index: int) -> Slip | None:
    """``def go(): pass`` in place of a clause."""
    before = tokens[index - 1] if index else None
    if before is None or before.text not in _PYTHON or tokens[index].kind not in ("atom", "variable"):
        return None
    if index > 1 and tokens[index - 2].kind not in (".", "}"):
        return None
    help = "this is an agent program; put Python code into a .py file, such as artifacts.py"
    return Slip("foreign-word", f"Python keyword `{before.text}` in an agent program", help, before)


def _open_block(tokens: Sequence[Token], index: int) -> Slip | None:
    """``if (c) { a else { b }``."""
    if tokens[index].kind not in ("else", "elif"):
        return None
    depth = 0
    for token in reversed(tokens[:index]):
        depth += (token.kind == "}") - (token.kind == "{")
        if depth < 0:
            word = tokens[index].text
            help = f"close the block that was opened at line {token.line}, column {token.column}"
            return Slip("unclosed-bracket", f"missing `}}` before `{word}`", help)
        if token.kind == ".":
            break
    return None


def _misspelt(tokens: Sequence[Token], index: int) -> Slip | None:
    token = tokens[index]
    if index == 0:
        return None
    before = tokens[index - 1]
    if token.kind == "{":
        if before.kind == ")":
            return _meant(tokens[max(_opening(tokens, index - 1) - 1, 0)], _CONTROL)
        return _meant(before, ("else",))
    if before.kind == "atom" and token.kind in ("atom", "variable", "~") and before.line == token.line:
        slip = _meant(before, ("not",))
        if slip is not None:
            return slip
    if (
        token.kind == "atom"
        and before.kind in _ENDS_OPERAND
        and tokens[index + 1 : index + 2]
        and tokens[index + 1].kind in _BEGINS_OPERAND
        and tokens[index + 1].line == token.line
    ):
        return _meant(token, [word for word in symbols_of(ARITHMETIC) if word in WORDS])
    return None


def _meant(word: Token, wanted: Sequence[str]) -> Slip | None:
    if word.kind != "atom":
        return None
    for each in wanted:
        if is_slip_of(word.text, each):
            return Slip("misspelt-word", f"unexpected `{word.text}`", did_you_mean([each]), word)
    return None


def _opening(tokens: Sequence[Token], index: int) -> int:
    """Return the index of the bracket that the ``)`` at *index* closes."""
    depth = 0
    while index > 0:
        depth += (tokens[index].kind == ")") - (tokens[index].kind == "(")
        if depth == 0:
            break
        index -= 1
    return index


MOST_ASKED: Final = 25
"""Mistakes of one kind for which a similar word is searched: comparing words is slow."""


class Slips:
    """An index of words that finds those one slip away, without comparing every pair of words."""

    def __init__(self, words: Iterable[str]) -> None:
        self._words: dict[str, list[str]] = {}
        for word in words:
            for part in _shortened(word):
                self._words.setdefault(part, []).append(word)

    def of(self, written: str) -> list[str]:
        """Return the words of which *written* may be a slip (see `is_slip_of`), each once."""
        return list(dict.fromkeys(word for part in _shortened(written) for word in self._words.get(part, ())))


def _shortened(word: str) -> Iterator[str]:
    """Yield a word and its forms without one letter; words that differ by a slip share one of these."""
    yield word
    for place in range(min(len(word), _LONGEST)):
        yield word[:place] + word[place + 1 :]


_LONGEST: Final = 60
"""Words longer than this number of letters are not checked for slips."""


def is_slip_of(written: str, meant: str) -> bool:
    """Return whether *written* is *meant* with one letter added, missing, wrong or swapped (not *meant* itself)."""
    if written == meant or abs(len(written) - len(meant)) > 1:
        return False
    at = next(
        (i for i, (one, two) in enumerate(zip(written, meant, strict=False)) if one != two),
        min(len(written), len(meant)),
    )
    rest, wanted = written[at:], meant[at:]
    return (
        rest[1:] == wanted[1:]
        or rest[1:] == wanted
        or rest == wanted[1:]
        or (rest[:2] == wanted[:2][::-1] and rest[2:] == wanted[2:])
    )
