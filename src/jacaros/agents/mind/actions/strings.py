"""Internal actions on strings. Regular expressions are those of Python."""

import re
from collections.abc import Iterator

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

_GROUP = re.compile(r"\$(\d+)")


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
    """``.replace(S, Regex, By, R)``: *R* is *S* with every match of a regular expression replaced.

    *by* may refer to groups of the match (``$1``). An *S* that is not a string is converted to text.

    Raises:
        ActionError: one of them is invalid.
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
        ValueError: the pattern or replacement is invalid.
    """
    compiled = _compiled(pattern)
    try:
        return compiled.sub(_GROUP.sub(r"\\g<\1>", by), source)
    except (re.error, IndexError) as error:
        raise ValueError(f"invalid replacement '{by}': {error}") from None


def matches_whole(pattern: str, source: str) -> bool:
    """Return whether *pattern* matches all of *source*.

    Raises:
        ValueError: the pattern is invalid.
    """
    return _compiled(pattern).fullmatch(source) is not None


def _compiled(pattern: str) -> re.Pattern[str]:
    try:
        return re.compile(pattern, re.ASCII)
    except re.error as error:
        raise ValueError(f"invalid regular expression '{pattern}': {error}") from None
