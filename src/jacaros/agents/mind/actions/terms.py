"""Internal actions that test and create terms: types, copies, annotations, and strings."""

import re
from collections.abc import Callable, Iterator

from jacaros.agents.mind.actions.internal_action import (
    ActionError,
    characters,
    internal_action,
    string,
    whole,
)
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.mind.state.belief_base import is_source, without_sources
from jacaros.agents.mind.state.intention import STEP
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.plans import PLAN, RULE, body_steps, is_body, step_parts
from jacaros.agents.terms.substitution import is_ground, rename
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    ACTION,
    ARITHMETIC,
    FUNCTION,
    NUMBERS,
    PLAIN,
    SOURCE,
    Annotated,
    Functor,
    String,
    Term,
    Var,
    annotations_of,
    atom,
    functor,
    functor_of,
    is_list,
    list_items,
    make_list,
)
from jacaros.agents.terms.values import NIL as EMPTY
from jacaros.runtime.errors import JacarosError

CODE_LINE, CODE_SRC = functor("code_line", 1), functor("code_src", 1)


@internal_action(".copy_term", arity=2, pure=True)
@internal_action(".rename_apart", arity=2, pure=True)
def copy_term(ctx: Context, term: Term, copy: Term) -> bool:
    """``.copy_term(T, C)``, ``.rename_apart(T, C)``: *C* is *T* with new variables in place of the unbound ones."""
    return ctx.unify(copy, rename(term))


@internal_action(".add_annot", arity=3, pure=True)
def add_annot(ctx: Context, term: Term, annotation: Term, result: Term) -> bool:
    """``.add_annot(L, A, R)``: *R* is the literal *L* with the annotation *A*.

    In a list (and nested lists) it is added to each literal; other elements are unchanged.
    """
    return ctx.unify(_in_lists(term, lambda literal: annotated(literal, (annotation,))), result)


@internal_action(".add_nested_source", arity=3, pure=True)
def add_nested_source(ctx: Context, term: Term, source: Term, result: Term) -> bool:
    """``.add_nested_source(L, Ag, R)``: *R* is the literal *L* with the source *Ag*, its previous sources nested inside.

    ``p[source(bob)]`` from carl gives ``p[source(carl)[source(bob)]]``. Lists are handled as by ``.add_annot``.
    """
    return ctx.unify(_in_lists(term, lambda literal: told_by(literal, source)), result)


@internal_action(".remove_source_annot", arity=2, pure=True)
def remove_source_annot(ctx: Context, term: Term, result: Term) -> bool:
    """``.remove_source_annot(L, R)``: *R* is *L* without its sources.

    *L* is a literal, a plan (whose label loses the sources), or a list of such terms.
    """
    if is_list(term):
        return ctx.unify(make_list([_without_source(item) for item in list_items(term)]), result)
    return ctx.unify(_without_source(term), result)


def _in_lists(term: Term, change: Callable[[Term], Term]) -> Term:
    """Apply *change* to a literal, or to each literal in a list."""
    if is_list(term):
        return make_list([_in_lists(item, change) for item in list_items(term)])
    return term if functor_of(term) is None else change(term)


def annotated(term: Term, annotations: tuple[Term, ...]) -> Term:
    """Return the literal with *annotations* in addition to its own."""
    if isinstance(term, Annotated):
        return Annotated(term.term, annotation_set((*term.annotations, *annotations)), term.tail)
    return Annotated(term, annotation_set(annotations)) if annotations else term


def told_by(term: Term, source: Term) -> Term:
    """Return the literal as received from *source*: its own sources are nested in the new one."""
    sources = tuple(a for a in annotations_of(term) if is_source(a))
    return annotated(without_sources(term), (annotated((SOURCE, source), sources),))


def _without_source(term: Term) -> Term:
    if term.__class__ is tuple and term[0] is PLAN:
        return (PLAN, without_sources(term[1]), *term[2:])
    return without_sources(term)


@internal_action(".get_src_info", arity=2)
def get_src_info(ctx: Context, term: Term, result: Term) -> bool:
    """``.get_src_info(L, R)``: *R* is the literal *L* with ``code_line(N)`` and ``code_src("file:…")``: the place of the
    step that asks. Fails if *L* is not a literal.
    """
    steps = list(body_steps(term)) if is_body(term) else []
    inner = (
        step_parts(steps[0])[1][0] if len(steps) == 1 else term
    )  # of a plan body with one step, its operand
    if functor_of(inner) is None:
        return False
    current = ctx.intention
    place: tuple[Term, ...] = ()
    if current is not None and current.frames:
        info = getattr(current.frames[-1][STEP], "info", None)
        if info is not None and info.node.span is not None:
            line, file = info.node.span.line, info.node.span.file.name
            place = ((CODE_LINE, float(line)), (CODE_SRC, String(f"file:{file}")))
    return ctx.unify(annotated(inner, place), result)


def _is_atom(term: Term) -> bool:
    return isinstance(term, Functor) and term.kind == PLAIN and not term.negated and term is not EMPTY


def _kind_of(term: Term) -> int | None:
    """Return the kind of the functor of an atom or structure; None for other terms."""
    symbol = functor_of(term)
    return None if symbol is None else symbol.kind


_TYPES: dict[str, Callable[[Term], bool]] = {
    # An expression with unbound variables is a number, too.
    "number": lambda term: (
        term.__class__ in NUMBERS or (term.__class__ is tuple and term[0].kind in (ARITHMETIC, FUNCTION))
    ),
    "atom": _is_atom,
    "literal": lambda term: _kind_of(term) not in (None, ARITHMETIC, FUNCTION),
    "string": lambda term: term.__class__ is String,
    "list": is_list,
    "set": lambda term: isinstance(term, SetValue),
    "map": lambda term: isinstance(term, MapValue),
    # A list, or a literal other than a plain atom, as Jason implements it.
    "structure": lambda term: is_list(term) or (_TYPES["literal"](term) and not _is_atom(term)),
    "rule": lambda term: term.__class__ is tuple and term[0] is RULE,
    "plan": is_body,
    "queue": lambda term: isinstance(term, QueueValue),
    "ground": is_ground,
    "free": lambda term: term.__class__ is Var,
}
"""The types of terms, in the order of the answers of `.type`."""


def _test(name: str, holds: Callable[[Term], bool]) -> None:
    """Declare an internal action that tests its argument."""
    internal_action(name, arity=1, pure=True)(lambda _, term: holds(term))


for _name in ("string", "list", "number", "atom", "literal", "structure", "ground"):
    _test(f".{_name}", _TYPES[_name])
_test(".internal_action", lambda term: _kind_of(term) == ACTION)


@internal_action(".type", arity=2, backtracks=True, pure=True)
def type_(ctx: Context, term: Term, kind: Term) -> Iterator[None]:
    """``.type(X, T)``: *T* is a type of *X*; with *T* unbound, each of its types in turn.

    Types are ``number atom literal string list set map structure rule plan queue ground free``, in this order (``plan``
    is a plan body; ``free`` an unbound variable).
    """
    for name, test in _TYPES.items():
        if test(term) and ctx.unify(kind, atom(name)):
            yield


# Internal actions on strings. Regular expressions are those of Python.

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
