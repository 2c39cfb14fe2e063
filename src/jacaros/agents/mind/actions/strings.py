r"""Internal actions on strings, and Java's regular expressions translated to Python's.

The two languages of regular expressions agree on most of the syntax. Translated are named groups, quoting with
``\Q…\E``, the classes ``\p{Alpha}`` and so on, ``\z`` and ``\Z``, and replacement texts with ``$1`` and
``${name}``. The classes ``\d \w \s`` are ASCII, as in Java. Nested classes and ``&&`` are rejected.
"""

import re
import warnings
from collections.abc import Iterator
from functools import lru_cache

from jacaros.agents.mind.actions.internal_action import (
    ActionError,
    characters,
    internal_action,
    string,
    whole,
)
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import String, Term, Var, atom, make_list
from jacaros.errors import JacarosError

_CLASSES = {
    "Lower": "a-z",
    "Upper": "A-Z",
    "Alpha": "a-zA-Z",
    "Digit": "0-9",
    "Alnum": "a-zA-Z0-9",
    "Punct": r"!-/:-@\[-`{-~",
    "Space": r"\s",
    "Blank": r" \t",
    "XDigit": "0-9a-fA-F",
    "ASCII": r"\x00-\x7F",
}
_DIFFERENT = re.compile(
    r"\\Q(?P<quoted>.*?)(?:\\E|$)|\\(?P<sign>[pP])\{(?P<class>\w+)\}|(?P<end>\\[zZ])|(?P<escape>\\.)"
    r"|(?P<open>\[\^?\]?)|(?P<close>\])|(?P<group>\(\?<(?![=!]))",
    re.DOTALL,
)
_REFERENCE = re.compile(r"\\(.)|\$\{(\w+)\}|\$(\d+)|(\$|\\$)", re.DOTALL)


@internal_action(".substring", arity=(2, 4), backtracks=True, pure=True)
def substring(
    ctx: Context, part: Term, whole_term: Term, start: Term = None, end: Term = None
) -> Iterator[None]:
    """``.substring(Part, S[, Start[, End]])`` finds or extracts a part of a text.

    ``.substring("b", "abc")`` tests. ``.substring("a", "banana", I, J)`` has an answer for each occurrence, with the
    positions (from 0) of the first and of the last character. ``.substring(X, "hello", 1, 3)`` extracts from a position
    up to, but not including, another one (default: the end). Terms that are not strings are converted to text.

    Raises:
        ActionError: the positions of the part to extract are outside the text.
    """
    found, searched = characters(part), characters(whole_term)
    if start is None:
        if found in searched:
            yield
    elif start.__class__ is float and Var in (part.__class__, whole_term.__class__):
        # an unbound text is bound to the part of the first argument, as Jason does for old programs
        source, target = (searched, part) if part.__class__ is Var else (found, whole_term)
        if ctx.unify(target, _cut(source, start, end)):
            yield
    else:
        for position in _places(found, searched):
            last = position + len(found) - 1
            if end is None:
                fits = ctx.unify(start, float(position))
            else:
                fits = ctx.unify(make_list((start, end)), make_list((float(position), float(last))))
            if fits:
                yield


def _places(part: str, searched: str) -> Iterator[int]:
    position = searched.find(part)
    while 0 <= position < len(searched):
        yield position
        position = searched.find(part, position + 1)


def _cut(source: str, start: Term, end: Term) -> String:
    first = whole(start, "the start")
    last = whole(end, "the end") if end.__class__ is float else len(source)
    if not 0 <= first <= last <= len(source):
        raise ActionError(f".substring: part {first} to {last} is outside the {len(source)} characters")
    return String(source[first:last])


@internal_action(".replace", arity=4, pure=True)
def replace(ctx: Context, source: Term, pattern: Term, by: Term, result: Term) -> bool:
    """``.replace(S, Regex, By, R)``: *R* is *S* with every match of a regular expression (of Java) replaced.

    *by* may refer to groups of the match (``$1``). An *S* that is not a string is converted to text.

    Raises:
        ActionError: one of them is invalid, or not supported by `replace_all`.
    """
    expression = string(pattern, "the second argument of .replace")
    replacement = string(by, "the third argument of .replace")
    try:
        replaced = replace_all(characters(source), expression, replacement)
    except ValueError as error:
        raise ActionError(f".replace: {error}") from None
    return ctx.unify(String(replaced), result)


@internal_action(".upper_case", arity=2, pure=True)
def upper_case(ctx: Context, source: Term, result: Term) -> bool:
    """``.upper_case(S, R)``: *R* is the string *S* in upper case; other terms are converted to text."""
    return ctx.unify(result, String(characters(source).upper()))


@internal_action(".lower_case", arity=2, pure=True)
def lower_case(ctx: Context, source: Term, result: Term) -> bool:
    """``.lower_case(S, R)``: *R* is the string *S* in lower case; other terms are converted to text."""
    return ctx.unify(result, String(characters(source).lower()))


@internal_action(".term2string", arity=2, pure=True, by_name=True)
def term2string(ctx: Context, term: Term, written: Term) -> bool:
    """``.term2string(T, S)``: *S* is the text of the term *T*, strings in quotes.

    With *T* unbound, *S* is parsed; its variables are those of the running plan. A text that is not a term becomes an
    atom.

    Raises:
        ActionError: *T* has a value, and *S* is neither unbound nor a string.
    """
    if term.__class__ is Var:
        source = characters(written)
        try:
            value = ctx.parse_term(source)
        except JacarosError:
            value = atom(source)
        return ctx.unify(term, value)
    if written.__class__ not in (Var, String):
        raise ActionError(f".term2string: the second argument must be a string, not {text(written)}")
    return ctx.unify(String(text(term)), written)


def replace_all(source: str, pattern: str, by: str) -> str:
    """Return *source* with every match of *pattern* replaced.

    Raises:
        ValueError: the pattern or replacement is invalid or not supported.
    """
    compiled = _compile(pattern)
    return compiled.sub(lambda match: _expand(by, match), source)


def matches_whole(pattern: str, source: str) -> bool:
    """Return whether *pattern* matches all of *source*.

    Raises:
        ValueError: the pattern is invalid or not supported.
    """
    return _compile(pattern).fullmatch(source) is not None


@lru_cache(maxsize=64)
def _compile(pattern: str) -> re.Pattern[str]:
    with warnings.catch_warnings():
        warnings.simplefilter("error", FutureWarning)
        try:
            return re.compile(_translate(pattern), re.ASCII)
        except (re.error, FutureWarning) as error:
            raise ValueError(f"invalid regular expression '{pattern}': {error}") from None


def _translate(pattern: str) -> str:
    inside = False
    result: list[str] = []
    position = 0
    for match in _DIFFERENT.finditer(pattern):
        result.append(pattern[position : match.start()])
        position = match.end()
        kind = match.lastgroup
        found = match.group()
        if kind == "open":
            if inside:
                raise ValueError(f"nested classes in '{pattern}' are not supported")
            inside = True
            result.append(found)
        elif kind == "close":
            inside = False
            result.append(found)
        elif kind == "quoted":
            result.append(re.escape(match["quoted"]))
        elif kind == "class":
            result.append(_posix_class(match["class"], match["sign"] == "P", inside, pattern))
        elif kind == "end":
            result.append(r"\Z" if found == r"\z" else r"(?=\n?\Z)")
        else:
            result.append("(?P<" if kind == "group" and not inside else found)
    result.append(pattern[position:])
    return "".join(result)


def _posix_class(name: str, negated: bool, inside: bool, pattern: str) -> str:
    characters = _CLASSES.get(name)
    if characters is None or (negated and inside):
        raise ValueError(f"class {name} in '{pattern}' is not supported")
    return characters if inside else f"[{'^' if negated else ''}{characters}]"


def _expand(replacement: str, match: re.Match[str]) -> str:
    """Return the replacement for one match, with its group references filled in."""
    result: list[str] = []
    position = 0
    for reference in _REFERENCE.finditer(replacement):
        result.append(replacement[position : reference.start()])
        position = reference.end()
        escaped, name, digits, stray = reference.groups()
        if stray is not None:
            raise ValueError(f"unescaped {stray} in '{replacement}'")
        if escaped is not None:
            result.append(escaped)
        elif name is not None:
            result.append(_group(match, name, replacement))
        else:
            used = _known_group(digits, match)
            result.append(_group(match, int(used), replacement) + digits[len(used) :])
    result.append(replacement[position:])
    return "".join(result)


def _known_group(digits: str, match: re.Match[str]) -> str:
    """Return as many of the digits as name a group, at least one."""
    used = digits[0]
    for digit in digits[1:]:
        if int(used + digit) > match.re.groups:
            break
        used += digit
    return used


def _group(match: re.Match[str], which: int | str, replacement: str) -> str:
    try:
        return match.group(which) or ""
    except IndexError:
        raise ValueError(f"unknown group {which} in '{replacement}'") from None
