"""Internal actions that look for parts of lists: ``.sublist .prefix .suffix``."""

from collections.abc import Iterator

from jacaros.bdi.actions.arguments import elements
from jacaros.bdi.actions.internal_action import WrongArguments, internal_action
from jacaros.bdi.rules.context import Context
from jacaros.terms.text import text
from jacaros.terms.values import NIL, String, Term, Var, is_list, make_list, parted

Bounds = tuple[int, int]


@internal_action(".sublist", arity=2, backtracks=True, repeatable=True)
def sublist(ctx: Context, part: Term, whole: Term) -> Iterator[None]:
    """``.sublist(S, L)``: *S* is a contiguous part of the list *L*; one answer for each that unifies.

    Parts that begin further left come first, longer ones before shorter ones, the empty list last.

    Raises:
        WrongArguments: *S* is neither a list nor unbound, or *L* is no list.
    """
    items = _checked(part, whole, ".sublist")
    size = len(items)
    bounds = ((start, end) for start in range(size) for end in range(size, start, -1))
    return _answers(ctx, part, items, bounds)


@internal_action(".prefix", arity=2, backtracks=True, repeatable=True)
def prefix(ctx: Context, part: Term, whole: Term) -> Iterator[None]:
    """``.prefix(P, L)``: the list (or string) *L* begins with *P*; longer answers come first.

    Raises:
        WrongArguments: *P* is neither such a value nor unbound, or *L* is neither list nor string.
    """
    items = _checked(part, whole, ".prefix", strings=True)
    return _answers(ctx, part, items, ((0, end) for end in range(len(items), 0, -1)))


@internal_action(".suffix", arity=2, backtracks=True, repeatable=True)
def suffix(ctx: Context, part: Term, whole: Term) -> Iterator[None]:
    """``.suffix(S, L)``: the list (or string) *L* ends with *S*; longer answers come first.

    Raises:
        WrongArguments: *S* is neither such a value nor unbound, or *L* is neither list nor string.
    """
    items = _checked(part, whole, ".suffix", strings=True)
    size = len(items)
    return _answers(ctx, part, items, ((start, size) for start in range(size)))


def _checked(part: Term, whole: Term, name: str, strings: bool = False) -> list[Term] | String:
    """The elements of the second argument; the first one is checked too."""
    if strings and whole.__class__ is String:
        fits = part.__class__ in (String, Var)
        items: list[Term] | String = whole
    else:
        fits = part.__class__ is Var or is_list(part)
        items = elements(whole, f"the second argument of {name}")
    if not fits:
        raise WrongArguments(f"the first argument of {name} must be a part or a variable, not {text(part)}")
    return items


def _answers(
    ctx: Context, part: Term, items: list[Term] | String, bounds: Iterator[Bounds]
) -> Iterator[None]:
    """The parts that unify, the empty one after all others; only those of the right length are built."""
    length = _known_length(part)
    for start, end in bounds:
        if length in (None, end - start) and ctx.unify(part, _cut(items, start, end)):
            yield
    if ctx.unify(part, _cut(items, 0, 0)):
        yield


def _cut(items: list[Term] | String, start: int, end: int) -> Term:
    return String(items[start:end]) if isinstance(items, String) else make_list(items[start:end])


def _known_length(part: Term) -> int | None:
    """The length of a closed list or string, None when it may have any."""
    if part.__class__ is String:
        return len(part)
    items, end = parted(part)
    return len(items) if end is NIL else None
