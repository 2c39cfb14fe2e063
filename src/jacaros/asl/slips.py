"""Similarity of words, and mistakes known from other languages, for better messages than "expected X, found Y".

>>> is_slip_of("improt", "import"), is_slip_of("export", "import")
(True, False)
>>> Slips(["battery", "bumper"]).of("batery")
['battery']
"""

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


_START: Final = Token("end", "", 0, 0, False)
"""Stands before the first token."""


def known_slip(tokens: Sequence[Token], index: int) -> Slip | None:
    """Return the likely mistake where the token at *index* does not fit, if it is a known one."""
    before = tokens[index - 1] if index else _START
    return (
        _misspelt(tokens, index, before)
        or _bare_goal(tokens, index)
        or _by_kind(tokens, index, before)
        or _counting(tokens, index)
        or _fused(tokens, index)
        or _missing_blank(tokens[index], before)
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


def _by_kind(tokens: Sequence[Token], index: int, before: Token) -> Slip | None:
    """``f"at {X}"``, ``a and b``, ``def go(): pass``, ``if (c) { a else { b }``, ``p :- q & !``, and reserved words."""
    token = tokens[index]
    text = token.text
    match token.kind:
        case "string" if _joined(before, token) and before.text.lower() in ("f", "r", "b", "u"):
            help = 'write values between strings, as in `.print("at ", X)`, or join them with `.concat("at ", X, Text)`'
            return Slip(
                "foreign-word", f"strings have no prefix such as `{before.text}` in Python", help, before
            )
        case "atom" if text in _WORDS and before.kind in _ENDS_OPERAND:
            return Slip("foreign-word", f"unknown keyword `{text}`", _WORDS[text])
        case "atom" | "variable" if before.text in _PYTHON and (
            index < 2 or tokens[index - 2].kind in (".", "}")
        ):
            help = "this is an agent program; put Python code into a .py file, such as artifacts.py"
            return Slip("foreign-word", f"Python keyword `{before.text}` in an agent program", help, before)
        case "else" | "elif" if (opener := _open_block(tokens[:index])) is not None:
            help = f"close the block that was opened at line {opener.line}, column {opener.column}"
            return Slip("unclosed-bracket", f"missing `}}` before `{text}`", help)
        case kind if kind in RESERVED:
            return Slip(
                "reserved-word", f"reserved word `{text}` used as a name", f"quote it as an atom: '{text}'"
            )
        case "!" if before.kind in ("&", ":-"):
            help = "a plan takes the first solution of its context; give rules conditions that exclude each other"
            return Slip("wrong-operator", "unknown operator `!` (cut)", help)
    return None


def _open_block(tokens: Sequence[Token]) -> Token | None:
    """Return the ``{`` of this clause that is still open."""
    depth = 0
    for token in reversed(tokens):
        depth += (token.kind == "}") - (token.kind == "{")
        if depth < 0 or token.kind == ".":
            return token if depth < 0 else None
    return None


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


def _missing_blank(token: Token, before: Token) -> Slip | None:
    """``p.q``: the final dot of a clause and the next word, read as one."""
    is_word = token.kind == "atom" and token.text.startswith(".")
    if not is_word or not _joined(before, token) or before.kind not in (")", "]", "atom"):
        return None
    help = "put a blank or a line end after the final `.`"
    return Slip("missing-blank", f"`{token.text}` is read as one word", help)


def _misspelt(tokens: Sequence[Token], index: int, before: Token) -> Slip | None:
    token, behind = tokens[index], tokens[min(index + 1, len(tokens) - 1)]
    if token.kind == "{":
        word = tokens[max(_opening(tokens, index - 1) - 1, 0)] if before.kind == ")" else before
        return _meant(word, _CONTROL if before.kind == ")" else ("else",))
    if before.kind == "atom" and token.kind in ("atom", "variable", "~") and before.line == token.line:
        slip = _meant(before, ("not",))
        if slip is not None:
            return slip
    between = before.kind in _ENDS_OPERAND and behind.kind in _BEGINS_OPERAND and behind.line == token.line
    if token.kind != "atom" or not between:
        return None
    return _meant(token, [word for word in symbols_of(ARITHMETIC) if word in WORDS])


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
