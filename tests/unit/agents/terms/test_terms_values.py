import copy
import pickle
import sys
import threading
import weakref

import pytest

from jacaros.agents.terms.collections import QueueValue, SetValue
from jacaros.agents.terms.unifier import Trail, unify
from jacaros.agents.terms.values import (
    NIL,
    PLAIN,
    Annotated,
    Reference,
    String,
    Var,
    _functors,
    annotations_of,
    arguments_of,
    atom,
    bare,
    deref,
    functor,
    functor_of,
    is_list,
    list_items,
    make_list,
    structure,
)


def test_a_name_that_is_no_longer_used_is_released():
    gone = weakref.ref(atom("seen_once"))
    used = atom("in_use")
    assert gone() is None
    assert ("seen_once", 0, False, None, PLAIN) not in _functors
    assert atom("in_use") is used


def test_there_is_one_functor_for_each_name_while_threads_make_and_release_it():
    met = []

    def make() -> None:
        for _ in range(2000):
            met.append(atom("shared") is atom("shared"))

    threads = [threading.Thread(target=make) for _ in range(4)]
    before = sys.getswitchinterval()
    sys.setswitchinterval(1e-6)
    try:
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
    finally:
        sys.setswitchinterval(before)
    assert all(met)


def test_there_is_one_functor_for_each_name_copied_or_not():
    assert functor("p", 2) is functor("p", 2)
    assert functor("p", 2) is not functor("p", 3)
    assert functor("p", 2) is not functor("p", 2, negated=True)
    assert atom("p") is not atom("p", "ns")
    symbol = functor("p", 2, True, "ns")
    assert copy.deepcopy(symbol) is symbol
    assert pickle.loads(pickle.dumps(symbol)) is symbol


def test_strings_lists_and_literals_are_read():
    with pytest.raises(TypeError, match=r"\.concat"):
        String("a") + "b"
    with pytest.raises(TypeError):
        String("a") * 2
    assert repr(String("a")) == "String('a')"
    assert list(list_items(make_list([1.0, 2.0]))) == [1.0, 2.0]
    tail = Var("T")
    assert list(list_items(make_list([1.0], tail))) == [1.0]
    unify(tail, make_list([2.0]), Trail())
    assert list(list_items(make_list([1.0], tail))) == [1.0, 2.0]
    assert make_list(iter([])) is NIL
    assert is_list(NIL)
    assert not is_list(atom("a"))
    literal = Annotated(structure("p", 1.0), (atom("x"),))
    variable = Var("X")
    unify(variable, literal, Trail())
    assert deref(variable) is literal
    assert bare(variable) == structure("p", 1.0)
    assert functor_of(variable) is functor("p", 1)
    assert arguments_of(variable) == (1.0,)
    assert annotations_of(variable) == (atom("x"),)


@pytest.mark.parametrize("term", [1.0, String("s"), NIL, make_list([1.0]), Var("X")])
def test_other_terms_have_no_functor(term):
    assert functor_of(term) is None
    assert annotations_of(term) == ()


def test_references_and_sets_are_equal_by_what_they_hold():
    thing = [1]
    assert Reference(thing) == Reference(thing)
    assert Reference(thing) != Reference([2])
    assert hash(Reference("x")) == hash(Reference("x"))
    assert hash(Reference(thing)) == hash(Reference(thing))
    first, second = SetValue({atom("a"): None}), SetValue({atom("a"): None})
    table = {(functor("p", 1), first): True}
    assert first == second
    first.items[atom("b")] = None
    assert first != second
    assert table[(functor("p", 1), first)]
    queue = QueueValue(priority=True)
    items = [Annotated(atom("a"), ()), atom("a")]
    for item in items:
        queue.add(item)
    assert [queue.remove(), queue.remove()] == items
    assert queue.remove() is None
