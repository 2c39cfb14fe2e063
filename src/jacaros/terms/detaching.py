"""Copies of terms for another agent: sets, maps and queues, which are shared by reference inside one, are copied too."""

from jacaros.terms.collections import MapValue, QueueValue, SetValue
from jacaros.terms.substitution import resolve
from jacaros.terms.values import ATOMIC, Annotated, List, Term, deref, is_list, list_items, make_list

_COLLECTIONS = (SetValue, MapValue, QueueValue)


def detached(term: Term) -> Term:
    """The term with collections of its own; one without collections is given back as it is."""
    return _copy(resolve(term), {}) if holds_collection(term) else term


def holds_collection(term: Term) -> bool:
    """Whether there is a set, map or queue in a term."""
    stack = [term]
    while stack:
        part = deref(stack.pop())
        kind = part.__class__
        if kind is tuple:
            stack.extend(part[1:])
        elif kind is List:
            items = part.from_bottom()
            if not ATOMIC.issuperset(map(type, items)):
                stack.extend(items)
        elif kind is Annotated:
            stack.append(part.term)
            stack.extend(part.annotations)
        elif kind in _COLLECTIONS:
            return True
    return False


def _copy(term: Term, copies: dict[int, Term]) -> Term:
    kind = term.__class__
    if kind in _COLLECTIONS:
        known = copies.get(id(term))
        return known if known is not None else _copy_collection(term, copies)
    if not holds_collection(term):
        return term
    if kind is Annotated:
        annotations = tuple(_copy(a, copies) for a in term.annotations)
        return Annotated(_copy(term.term, copies), annotations, term.tail)
    if is_list(term):
        return make_list([_copy(item, copies) for item in list_items(term)])
    return (term[0], *(_copy(argument, copies) for argument in term[1:]))


def _copy_collection(term: Term, copies: dict[int, Term]) -> Term:
    made: SetValue | MapValue | QueueValue
    if isinstance(term, SetValue):
        made = copies[id(term)] = SetValue()
        made.items.update((_copy(item, copies), None) for item in term.items)
    elif isinstance(term, MapValue):
        made = copies[id(term)] = MapValue()
        made.items.update((_copy(key, copies), _copy(value, copies)) for key, value in term.items.items())
    else:
        made = copies[id(term)] = QueueValue(term.priority)
        for item in term:
            made.add(_copy(item, copies))
    return made
