"""Internal actions on lists, and on sets, maps and queues, which are changed in place and shared by reference.

The first argument is the collection; an unbound variable becomes an empty one. All raise `WrongArguments` for any other
term. Backtracking does not undo changes.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import Any, Final

from jacaros.agents.mind.actions.internal_action import (
    ActionError,
    WrongArguments,
    characters,
    elements,
    internal_action,
    members,
    whole,
)
from jacaros.agents.mind.actions.terms import replace_all
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.order import compare, ordered_by_python, sorted_set, sorted_terms
from jacaros.agents.terms.substitution import ATOMIC, as_key, equal, is_ground
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import (
    NIL,
    Functor,
    List,
    String,
    Term,
    Var,
    is_list,
    list_items,
    list_length,
    make_list,
    parted,
)

Collection = SetValue | MapValue | QueueValue
_NAMES: Final[dict[type[Collection], str]] = {SetValue: "set", MapValue: "map", QueueValue: "queue"}


def _find(kind: type[Collection], ctx: Context, term: Term) -> Any:
    """Return the collection in an argument; an unbound variable becomes an empty one."""
    if isinstance(term, kind):
        return term
    if term.__class__ is not Var:
        raise WrongArguments(f"the first argument must be a {_NAMES[kind]}, not {text(term)}")
    made = kind()
    ctx.unify(term, made)
    return made


def _items(collection: Term) -> list[Term]:
    return members(collection, "the second argument")


def _create(name: str, kind: type[Collection]) -> None:
    """Declare ``.set.create(S)``: the unbound variable becomes an empty collection; fails if it has a value.

    A queue may be made with ``priority``: its smallest element is the next one, not the oldest.
    """

    def create(ctx: Context, variable: Term, order: Term = None) -> bool:
        priority = isinstance(order, Functor) and order.name == "priority"
        return variable.__class__ is Var and ctx.unify(variable, QueueValue(True) if priority else kind())

    internal_action(f".{name}.create", arity=(1, 2) if kind is QueueValue else 1)(create)


def _changes(name: str, kind: type[Collection], arity: int, change: Callable[..., object]) -> None:
    """Declare an action that changes a collection: *change* takes it and the other arguments."""

    def action(ctx: Context, collection: Term, *arguments: Term) -> None:
        change(_find(kind, ctx, collection), *arguments)

    internal_action(name, arity=arity)(action)


def _gives(
    name: str, kind: type[Collection], value: Callable[[Any], Term | None], pure: bool = False
) -> None:
    """Declare an action whose second argument is the *value* of a collection; it fails if that is None."""

    def action(ctx: Context, collection: Term, result: Term) -> bool:
        found = value(_find(kind, ctx, collection))
        return found is not None and ctx.unify(result, found)

    internal_action(name, arity=2, pure=pure)(action)


def _answers(name: str, kind: type[Collection], values: Callable[[Any], Iterable[Term]]) -> None:
    """Declare an action with an answer for each of the *values* of a collection that unifies with its second argument."""

    def action(ctx: Context, collection: Term, pattern: Term) -> Iterator[None]:
        for value in list(values(_find(kind, ctx, collection))):
            if ctx.unify(pattern, value):
                yield

    internal_action(name, arity=2, backtracks=True, pure=True)(action)


for _kind, _name in _NAMES.items():
    _create(_name, _kind)
    _gives(f".{_name}.copy", _kind, _kind.copy)
    _changes(f".{_name}.clear", _kind, 1, _kind.clear)
_changes(".set.add", SetValue, 2, SetValue.add)
for _name in (".set.add_all", ".set.union"):
    _changes(_name, SetValue, 2, lambda target, others: target.items.update(_keys(others)))
_changes(".set.intersection", SetValue, 2, lambda target, others: target.keep(_keys(others)))
_changes(".set.difference", SetValue, 2, lambda target, others: list(map(target.remove, _items(others))))
_changes(".set.remove", SetValue, 2, SetValue.remove)
_gives(".set.to_list", SetValue, SetValue.as_list, pure=True)
_changes(".map.put", MapValue, 3, lambda target, key, value: target.items.update({as_key(key): value}))
_answers(".map.key", MapValue, iter)
_answers(".map.value", MapValue, lambda source: [source.items[key] for key in source])
_changes(".queue.add", QueueValue, 2, QueueValue.add)
_changes(".queue.add_all", QueueValue, 2, lambda target, others: list(map(target.add, _items(others))))
_gives(".queue.head", QueueValue, QueueValue.head, pure=True)
_gives(".queue.remove", QueueValue, QueueValue.remove)
_gives(".queue.to_list", QueueValue, QueueValue.as_list, pure=True)


def _keys(collection: Term) -> dict[Term, None]:
    return dict.fromkeys(map(as_key, _items(collection)))


@internal_action(".map.get", arity=(3, 4), pure=True)
def get(ctx: Context, collection: Term, key: Term, value: Term, *default: Term) -> bool:
    """``.map.get(M, K, V[, Default])``: *V* is the value of *K*, or the default. Fails without either."""
    found = _find(MapValue, ctx, collection).items.get(as_key(key), *default)
    return found is not None and ctx.unify(value, found)


@internal_action(".map.remove", arity=(2, 3))
def remove_from_map(ctx: Context, collection: Term, key: Term, value: Term = None) -> bool:
    """``.map.remove(M, K[, V])`` removes a key with the value *V*. Fails if the key is not in the map."""
    removed = _find(MapValue, ctx, collection).items.pop(as_key(key), None)
    return removed is not None and (value is None or ctx.unify(value, removed))


# Internal actions on lists; several of them also accept strings, sets and queues.


@internal_action(".length", arity=2, pure=True)
def length(ctx: Context, collection: Term, result: Term) -> bool:
    """``.length(C, N)``: *N* is the number of elements of a list, set, map or queue, or of characters.

    Fails for any other term.
    """
    size = _size(collection)
    return size is not None and ctx.unify(result, float(size))


@internal_action(".empty", arity=1, pure=True)
def empty(_ctx: Context, collection: Term) -> bool:
    """``.empty(C)``: the list, string, set, map or queue has no elements.  Fails for any other term."""
    return collection is NIL or _size(collection) == 0


def _size(collection: Term) -> int | None:
    if isinstance(collection, (String, SetValue, MapValue, QueueValue)):
        return len(collection)
    return list_length(collection) if is_list(collection) else None


@internal_action(".member", arity=2, backtracks=True, pure=True)
def member(ctx: Context, item: Term, collection: Term) -> Iterator[None]:
    """``.member(X, C)``: *X* is an element of a list, set or queue; one answer for each element that unifies.

    A ground *X* matches an element of a set or queue at most once; annotations are compared as well.
    """
    if isinstance(collection, (SetValue, QueueValue)) and is_ground(item):
        if _holds(collection, item):
            yield
        return
    if (
        collection.__class__ is List
        and item.__class__ in ATOMIC
        and item == item  # NaN is not in any list
        and collection.is_settled()  # pyright: ignore[reportAttributeAccessIssue]
        and collection.depth == 1  # pyright: ignore[reportAttributeAccessIssue]
    ):
        for _ in range(collection.from_bottom().count(item)):  # pyright: ignore[reportAttributeAccessIssue]
            yield
        return
    for candidate in members(collection, "the second argument of .member"):
        if ctx.unify(item, candidate):
            yield


def _holds(collection: SetValue | QueueValue, item: Term) -> bool:
    if isinstance(collection, SetValue):
        return as_key(item) in collection.items
    return any(equal(item, other) for other in collection)


@internal_action(".nth", arity=3, backtracks=True, pure=True)
def nth(ctx: Context, index: Term, collection: Term, item: Term) -> Iterator[None]:
    """``.nth(I, L, X)``: the element at position *I* (from 0) of a list, or character of a string, is *X*.

    With *I* unbound, there is an answer for each position whose element unifies with *X*.

    Raises:
        ActionError: the position does not exist.
    """
    if collection.__class__ is List and index.__class__ is float and 0 <= index < collection.size:
        if ctx.unify(item, collection.stack[collection.size - 1 - int(index)]):
            yield
        return
    if collection.__class__ is String:
        values: list[Term] = [String(character) for character in collection]
    else:
        values = elements(collection, "the second argument of .nth")
    if index.__class__ is Var:
        for position, value in enumerate(values):
            if ctx.unify(make_list((item, index)), make_list((value, float(position)))):
                yield
        return
    position = whole(index, "the first argument of .nth")
    if not 0 <= position < len(values):
        raise ActionError(f".nth: position {position} is outside the {len(values)} elements")
    if ctx.unify(item, values[position]):
        yield


@internal_action(".concat", arity=(2, None), pure=True)
def concat(ctx: Context, *arguments: Term) -> bool:
    """``.concat(A, ..., R)``: *R* is the concatenation of the other arguments, lists or strings.

    The first argument decides which. For a string, other terms are converted to text, quoted atoms without their quotes.

    Raises:
        ActionError: *R* is bound to something other than a list when a list is needed, or a list has an open tail.
    """
    *parts, result = arguments
    if not is_list(parts[0]):
        joined = String("".join(map(_unquoted, parts)))
        known = result.__class__ is String or result.__class__ is Var
        return ctx.unify(joined, result if known else String(text(result)))
    if result.__class__ is not Var and not is_list(result):
        raise ActionError(f".concat: the last argument must be a list or a variable, not {text(result)}")
    joined = parts[-1]
    for position, part in reversed(list(enumerate(parts, 1))):
        items = elements(part, f"argument {position} of .concat")
        if position < len(parts):
            if _open_end(part) is not None:
                raise ActionError(f".concat: {text(part)} has an open tail")
            both = part.__class__ is List and joined.__class__ is List
            joined = part.followed_by(joined) if both else make_list(items, joined)
    return ctx.unify(joined, result)


def _open_end(collection: Term) -> Term | None:
    """Return the tail of a list that is not closed."""
    end = parted(collection)[1]
    return None if end is NIL else end


def _unquoted(term: Term) -> str:
    if isinstance(term, Functor) and not term.negated and term.namespace is None:
        name = term.name
        return name[1:-1] if len(name) > 1 and name[0] == name[-1] == "'" else name
    return characters(term)


@internal_action(".delete", arity=(3, 4), pure=True)
def delete(ctx: Context, what: Term, *arguments: Term) -> bool:
    """``.delete(What, C, R)``: *R* is the list or string *C* with some elements removed.

    ==================  =====================================================================
    *What*              is removed
    ==================  =====================================================================
    number              the element or character at this position (from 0)
    two numbers A, B    ``.delete(A, B, C, R)``: positions A to B-1
    string              from the text of *C*: every match of this regular expression
    any other term      from a list: every element that unifies with it; variables keep the values that
                        they get from the first one (``f(_)`` removes ``f(1)`` and then keeps ``f(3)``)
    ==================  =====================================================================

    Positions outside the list or string remove nothing.

    Raises:
        ActionError: the regular expression is invalid.
    """
    if what.__class__ is float:
        start = whole(what, "the position")
        ranged = len(arguments) == 3 and arguments[0].__class__ is float
        end = whole(arguments[0], "the position") if ranged else start + 1
        return _delete_range(ctx, start, end, *arguments[ranged : ranged + 2])
    collection, result = arguments[:2]
    if what.__class__ is String:
        try:
            return ctx.unify(result, String(replace_all(characters(collection), what, "")))
        except ValueError as error:
            raise ActionError(f".delete: {error}") from None
    items = elements(collection, "the second argument of .delete")
    if what.__class__ is Functor and ATOMIC.issuperset(map(type, items)):
        return ctx.unify(result, make_list([item for item in items if item is not what]))
    return ctx.unify(result, make_list(_not_matching(what, items)))


def _not_matching(pattern: Term, items: list[Term]) -> list[Term]:
    """Return the items that do not unify with the pattern, whose variables are bound by its first match."""
    kept: list[Term] = []
    trail = Trail()
    matched = False
    for item in items:
        mark = len(trail)
        fits = unify(pattern, item, trail)
        if matched or not fits:
            undo(trail, mark)
        matched = matched or fits
        if not fits:
            kept.append(item)
    undo(trail, 0)
    return kept


def _delete_range(ctx: Context, start: int, end: int, collection: Term, result: Term) -> bool:
    if collection.__class__ is String:
        size = len(collection)
        if 0 <= start <= size and 0 <= end <= size:
            collection = String(collection[:start] + collection[end:])
        return ctx.unify(result, collection)
    items = elements(collection, "the list or string of .delete")
    start = max(start, 0)
    del items[start : max(start, end)]
    if collection.__class__ is List:
        return ctx.unify(result, collection.of_these(items[::-1]))
    return ctx.unify(result, make_list(items))


@internal_action(".reverse", arity=2, pure=True)
def reverse(ctx: Context, collection: Term, result: Term) -> bool:
    """``.reverse(C, R)``: *R* is the list or string *C* in reverse order; an open tail of a list stays at the end.

    Terms that are not lists are converted to text.
    """
    if is_list(collection):
        if result.__class__ is not Var:
            elements(result, "the second argument of .reverse")
        items = list(list_items(collection))
        if collection.__class__ is List:
            return ctx.unify(collection.of_these(items), result)
        return ctx.unify(make_list(items[::-1], _open_end(collection) or NIL), result)
    if result.__class__ not in (Var, String):
        raise WrongArguments(f"the second argument of .reverse must be a string, not {text(result)}")
    return ctx.unify(String(characters(collection)[::-1]), result)


@internal_action(".sort", arity=2, pure=True)
def sort(ctx: Context, collection: Term, result: Term) -> bool:
    """``.sort(L, R)``: *R* is the list *L* in the standard order of terms, with its duplicates."""
    items = sorted_terms(elements(collection, "the first argument of .sort"))
    if collection.__class__ is List:
        items.reverse()
        return ctx.unify(collection.of_these(items), result)
    return ctx.unify(make_list(items), result)


@internal_action(".shuffle", arity=2)
def shuffle(ctx: Context, collection: Term, result: Term) -> bool:
    """``.shuffle(L, R)``: *R* is the list *L* in random order, from the agent's own generator."""
    items = elements(collection, "the first argument of .shuffle")
    ctx.architecture.random.shuffle(items)
    return ctx.unify(result, make_list(items))


def _range(first: Term, last: Term, step: Term) -> tuple[int, int, int]:
    start, end = whole(first, "the second argument of .range"), whole(last, "the third argument of .range")
    return start, end, whole(step, "the fourth argument of .range")


def _numbers(first: Term, last: Term, step: Term = 1.0) -> Iterator[float]:
    """Yield the values of *X* in ``.range(X, First, Last[, Step])``."""
    start, end, by = _range(first, last, step)
    if by == 0:
        raise WrongArguments("the step of .range must not be 0")
    return map(float, range(start, end + (1 if by > 0 else -1), by))


@internal_action(".range", arity=(3, 4), backtracks=True, values=_numbers, pure=True)
def range_(ctx: Context, value: Term, first: Term, last: Term, step: Term = 1.0) -> Iterator[None]:
    """``.range(X, First, Last[, Step])``: *X* is each number from *First* to *Last* inclusive, in turn.

    A bound *X* is only tested to lie between the two, whatever the step. Fractions are cut off.
    """
    if value.__class__ is not Var:
        start, end, _ = _range(first, last, step)
        if start <= whole(value, "the first argument of .range") <= end:
            yield
        return
    for candidate in _numbers(first, last, step):
        if ctx.unify(value, candidate):
            yield


@internal_action(".union", arity=3, pure=True)
def union(ctx: Context, left: Term, right: Term, result: Term) -> bool:
    """``.union(A, B, R)``: *R* is the sorted list of elements of the list *A* or *B*, without duplicates."""
    first, second = _two_lists(left, right, result, ".union")
    return ctx.unify(result, make_list(sorted_set([*second, *first])))


@internal_action(".intersection", arity=3, pure=True)
def intersection(ctx: Context, left: Term, right: Term, result: Term) -> bool:
    """``.intersection(A, B, R)``: *R* is the sorted list of elements of both lists, without duplicates."""
    first, second = _two_lists(left, right, result, ".intersection")
    return ctx.unify(result, make_list(_parted(second, first)[0]))


@internal_action(".difference", arity=3, pure=True)
def difference(ctx: Context, left: Term, right: Term, result: Term) -> bool:
    """``.difference(A, B, R)``: *R* is the sorted list of elements of the list *A* that are not in *B*, without
    duplicates.
    """
    first, second = _two_lists(left, right, result, ".difference")
    return ctx.unify(result, make_list(_parted(first, second)[1]))


def _two_lists(left: Term, right: Term, result: Term, name: str) -> tuple[list[Term], list[Term]]:
    if result.__class__ is not Var:
        elements(result, f"the third argument of {name}")
    return elements(left, f"the first argument of {name}"), elements(right, f"the second argument of {name}")


def _parted(items: list[Term], others: list[Term]) -> tuple[list[Term], list[Term]]:
    """Return the items that are also in *others* and those that are not, both sorted and without duplicates."""
    if ordered_by_python(items) and ordered_by_python(others):
        among = set(others)
        ordered = sorted_set(items)
        return [item for item in ordered if item in among], [item for item in ordered if item not in among]
    shared: list[Term] = []
    own: list[Term] = []
    remaining = iter(sorted_set(others))
    other = next(remaining, None)
    for item in sorted_set(items):
        while other is not None and compare(other, item) < 0:
            other = next(remaining, None)
        (own if other is None or compare(other, item) else shared).append(item)
    return shared, own


Bounds = tuple[int, int]


@internal_action(".sublist", arity=2, backtracks=True, pure=True)
def sublist(ctx: Context, part: Term, whole: Term) -> Iterator[None]:
    """``.sublist(S, L)``: *S* is a contiguous part of the list *L*; one answer for each part that unifies.

    Parts with an earlier start come first, longer ones before shorter ones, the empty list last.
    """
    items = _whole_of(part, whole, ".sublist")
    size = len(items)
    bounds = ((start, end) for start in range(size) for end in range(size, start, -1))
    return _parts(ctx, part, items, bounds)


@internal_action(".prefix", arity=2, backtracks=True, pure=True)
def prefix(ctx: Context, part: Term, whole: Term) -> Iterator[None]:
    """``.prefix(P, L)``: the list (or string) *L* begins with *P*; longer answers come first."""
    items = _whole_of(part, whole, ".prefix", strings=True)
    return _parts(ctx, part, items, ((0, end) for end in range(len(items), 0, -1)))


@internal_action(".suffix", arity=2, backtracks=True, pure=True)
def suffix(ctx: Context, part: Term, whole: Term) -> Iterator[None]:
    """``.suffix(S, L)``: the list (or string) *L* ends with *S*; longer answers come first."""
    items = _whole_of(part, whole, ".suffix", strings=True)
    size = len(items)
    return _parts(ctx, part, items, ((start, size) for start in range(size)))


def _whole_of(part: Term, whole: Term, name: str, strings: bool = False) -> list[Term] | String:
    """Return the elements of the second argument; the first one is checked too."""
    if strings and whole.__class__ is String:
        fits = part.__class__ in (String, Var)
        items: list[Term] | String = whole
    else:
        fits = part.__class__ is Var or is_list(part)
        items = elements(whole, f"the second argument of {name}")
    if not fits:
        raise WrongArguments(f"the first argument of {name} must be a part or a variable, not {text(part)}")
    return items


def _parts(ctx: Context, part: Term, items: list[Term] | String, bounds: Iterator[Bounds]) -> Iterator[None]:
    """Yield an answer for each part that unifies, the empty one last; only parts of the right length are built."""
    length = _known_length(part)
    for start, end in bounds:
        if length in (None, end - start) and ctx.unify(part, _cut(items, start, end)):
            yield
    if ctx.unify(part, _cut(items, 0, 0)):
        yield


def _cut(items: list[Term] | String, start: int, end: int) -> Term:
    return String(items[start:end]) if isinstance(items, String) else make_list(items[start:end])


def _known_length(part: Term) -> int | None:
    """Return the length of a closed list or string; None if the length is open."""
    if part.__class__ is String:
        return len(part)
    items, end = parted(part)
    return len(items) if end is NIL else None
