"""Internal actions on sets, maps and queues, which are changed in place and shared by reference.

The first argument is the collection; an unbound variable becomes an empty one. All raise `WrongArguments` for any other
term. Backtracking does not undo changes.
"""

from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

from jacaros.agents.mind.actions.internal_action import WrongArguments, internal_action, members
from jacaros.agents.mind.rules.context import Context
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.substitution import as_key
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Functor, Term, Var

Collection = TypeVar("Collection", SetValue, MapValue, QueueValue)


def _of_kind(kind: type[Collection], name: str) -> Callable[[Context, Term], Collection]:
    """Return a function that finds a collection in an argument; an unbound variable becomes an empty one."""

    def find(ctx: Context, term: Term) -> Collection:
        if isinstance(term, kind):
            return term
        if term.__class__ is not Var:
            raise WrongArguments(f"the first argument must be a {name}, not {text(term)}")
        made = kind()
        ctx.unify(term, made)
        return made

    return find


_set, _map, _queue = _of_kind(SetValue, "set"), _of_kind(MapValue, "map"), _of_kind(QueueValue, "queue")


def _each(ctx: Context, pattern: Term, values: Iterable[Term]) -> Iterator[None]:
    """Yield an answer for each of the values that unifies."""
    for value in values:
        if ctx.unify(pattern, value):
            yield


@internal_action(".set.create", arity=1)
def create_set(ctx: Context, variable: Term) -> bool:
    """``.set.create(S)``: the unbound variable *S* becomes an empty set; fails if it has a value."""
    return variable.__class__ is Var and ctx.unify(variable, SetValue())


@internal_action(".set.add", arity=2)
def add_to_set(ctx: Context, collection: Term, item: Term) -> None:
    """``.set.add(S, X)`` adds an element."""
    _set(ctx, collection).items[as_key(item)] = None


@internal_action(".set.add_all", arity=2)
@internal_action(".set.union", arity=2)
def add_all_to_set(ctx: Context, collection: Term, items: Term) -> None:
    """``.set.add_all(S, C)`` and ``.set.union(S, C)`` add the elements of a list, set or queue."""
    _set(ctx, collection).items.update(dict.fromkeys(map(as_key, _items(items))))


@internal_action(".set.intersection", arity=2)
def intersection_of_sets(ctx: Context, collection: Term, items: Term) -> None:
    """``.set.intersection(S, C)`` keeps in *S* only the elements of the list, set or queue *C*."""
    target, kept = _set(ctx, collection), dict.fromkeys(map(as_key, _items(items)))
    target.items = {item: None for item in target.items if item in kept}


@internal_action(".set.difference", arity=2)
def difference_of_sets(ctx: Context, collection: Term, items: Term) -> None:
    """``.set.difference(S, C)`` removes from *S* the elements of the list, set or queue *C*."""
    target = _set(ctx, collection)
    for item in _items(items):
        target.items.pop(as_key(item), None)


@internal_action(".set.remove", arity=2)
def remove_from_set(ctx: Context, collection: Term, item: Term) -> None:
    """``.set.remove(S, X)`` removes an element, if it is in the set."""
    _set(ctx, collection).items.pop(as_key(item), None)


@internal_action(".set.to_list", arity=2, pure=True)
def list_of_set(ctx: Context, collection: Term, result: Term) -> bool:
    """``.set.to_list(S, L)``: *L* is the sorted list of the elements."""
    return ctx.unify(result, _set(ctx, collection).as_list())


@internal_action(".set.copy", arity=2)
def copy_set(ctx: Context, collection: Term, copy: Term) -> bool:
    """``.set.copy(S, C)``: *C* is a new set with the same elements."""
    return ctx.unify(copy, SetValue(dict(_set(ctx, collection).items)))


@internal_action(".set.clear", arity=1)
def clear_set(ctx: Context, collection: Term) -> None:
    """``.set.clear(S)`` removes all elements."""
    _set(ctx, collection).items.clear()


@internal_action(".map.create", arity=1)
def create_map(ctx: Context, variable: Term) -> bool:
    """``.map.create(M)``: the unbound variable *M* becomes an empty map; fails if it has a value."""
    return variable.__class__ is Var and ctx.unify(variable, MapValue())


@internal_action(".map.put", arity=3)
def put(ctx: Context, collection: Term, key: Term, value: Term) -> None:
    """``.map.put(M, K, V)`` sets the value of the key *K* to *V*."""
    _map(ctx, collection).items[as_key(key)] = value


@internal_action(".map.get", arity=(3, 4), pure=True)
def get(ctx: Context, collection: Term, key: Term, value: Term, *default: Term) -> bool:
    """``.map.get(M, K, V[, Default])``: *V* is the value of *K*, or the default. Fails without either."""
    found = _map(ctx, collection).items.get(as_key(key), *default)
    return found is not None and ctx.unify(value, found)


@internal_action(".map.remove", arity=(2, 3))
def remove_from_map(ctx: Context, collection: Term, key: Term, value: Term = None) -> bool:
    """``.map.remove(M, K[, V])`` removes a key with the value *V*. Fails if the key is not in the map."""
    removed = _map(ctx, collection).items.pop(as_key(key), None)
    return removed is not None and (value is None or ctx.unify(value, removed))


@internal_action(".map.key", arity=2, backtracks=True, pure=True)
def key_of_map(ctx: Context, collection: Term, key: Term) -> Iterator[None]:
    """``.map.key(M, K)``: *K* is a key; one answer for each that unifies, in the standard order."""
    return _each(ctx, key, list(_map(ctx, collection)))


@internal_action(".map.value", arity=2, backtracks=True, pure=True)
def value_of_map(ctx: Context, collection: Term, value: Term) -> Iterator[None]:
    """``.map.value(M, V)``: *V* is a value; one answer for each that unifies, in the order of the keys."""
    source = _map(ctx, collection)
    return _each(ctx, value, [source.items[key] for key in source])


@internal_action(".map.copy", arity=2)
def copy_map(ctx: Context, collection: Term, copy: Term) -> bool:
    """``.map.copy(M, C)``: *C* is a new map with the same keys and values."""
    return ctx.unify(copy, MapValue(dict(_map(ctx, collection).items)))


@internal_action(".map.clear", arity=1)
def clear_map(ctx: Context, collection: Term) -> None:
    """``.map.clear(M)`` removes all keys."""
    _map(ctx, collection).items.clear()


@internal_action(".queue.create", arity=(1, 2))
def create_queue(ctx: Context, variable: Term, kind: Term = None) -> bool:
    """``.queue.create(Q[, priority])``: the unbound variable *Q* becomes an empty queue.

    A queue with ``priority`` returns its smallest element first, any other queue the oldest. Fails if *Q* has a value.
    """
    priority = isinstance(kind, Functor) and kind.name == "priority"
    return variable.__class__ is Var and ctx.unify(variable, QueueValue(priority))


@internal_action(".queue.add", arity=2)
def add_to_queue(ctx: Context, collection: Term, item: Term) -> None:
    """``.queue.add(Q, X)`` adds an element."""
    _queue(ctx, collection).add(item)


@internal_action(".queue.add_all", arity=2)
def add_all_to_queue(ctx: Context, collection: Term, items: Term) -> None:
    """``.queue.add_all(Q, C)`` adds the elements of a list, set or queue, in order."""
    target = _queue(ctx, collection)
    for item in _items(items):
        target.add(item)


@internal_action(".queue.head", arity=2, pure=True)
def head(ctx: Context, collection: Term, item: Term) -> bool:
    """``.queue.head(Q, X)``: *X* is the next element, which stays in the queue. Fails for an empty queue."""
    found = _queue(ctx, collection).head()
    return found is not None and ctx.unify(item, found)


@internal_action(".queue.remove", arity=2)
def remove_from_queue(ctx: Context, collection: Term, item: Term) -> bool:
    """``.queue.remove(Q, X)`` removes the next element, *X*. Fails for an empty queue."""
    found = _queue(ctx, collection).remove()
    return found is not None and ctx.unify(item, found)


@internal_action(".queue.to_list", arity=2, pure=True)
def list_of_queue(ctx: Context, collection: Term, result: Term) -> bool:
    """``.queue.to_list(Q, L)``: *L* is the list of the elements, the next one first."""
    return ctx.unify(result, _queue(ctx, collection).as_list())


@internal_action(".queue.copy", arity=2)
def copy_queue(ctx: Context, collection: Term, copy: Term) -> bool:
    """``.queue.copy(Q, C)``: *C* is a new queue with the same elements."""
    return ctx.unify(copy, _queue(ctx, collection).copy())


@internal_action(".queue.clear", arity=1)
def clear_queue(ctx: Context, collection: Term) -> None:
    """``.queue.clear(Q)`` removes all elements."""
    _queue(ctx, collection).clear()


def _items(collection: Term) -> list[Term]:
    return members(collection, "the second argument")
