"""Lists: shared elements, one form for each, and what is known of them."""

import itertools
import pickle
from typing import Any

from hypothesis import given
from hypothesis import strategies as st

from jacaros.agents.terms.operators import BINARY
from jacaros.agents.terms.order import compare, sorted_terms
from jacaros.agents.terms.substitution import equal, free_variables, is_ground, is_key, rename, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, unify
from jacaros.agents.terms.values import (
    CONS,
    NIL,
    Annotated,
    List,
    String,
    Term,
    Var,
    atom,
    list_items,
    list_length,
    make_list,
    structure,
)


def numbers(count: int) -> Any:
    return make_list([float(i) for i in range(count)])


def cells(items: list[Term], tail: Term = NIL) -> Term:
    for item in reversed(items):
        tail = (CONS, item, tail)
    return tail


elements = st.recursive(
    st.sampled_from(
        [1.0, 2.0, String("a"), atom("a"), structure("f", 1.0), Annotated(atom("a"), (atom("b"),))]
    ),
    lambda inner: st.lists(inner, max_size=3).map(make_list),
    max_leaves=6,
)


@given(st.lists(elements, max_size=40), st.lists(elements, max_size=20), st.integers(0, 60))
def test_a_list_in_front_of_a_tail_of_another_has_the_elements_of_both(items, more, taken):
    whole = resolve(make_list(items))
    tail = whole
    for _ in range(min(taken, len(items))):
        tail = tail.rest() if tail.__class__ is List else tail[2]
    expected = more + items[taken:]
    for made in (resolve(cells(more, tail)), resolve(make_list(more, resolve(tail)))):
        assert made == make_list(expected)
        assert hash(made) == hash(make_list(expected))
        assert list(list_items(made)) == expected
    assert list(list_items(whole)) == items


@given(st.lists(st.tuples(st.integers(0, 30), st.sampled_from([1.0, 2.0, 3.0])), max_size=120))
def test_lists_that_grow_from_the_same_list_do_not_change_each_other(steps):
    made: list[Any] = [numbers(2)]
    known = [[0.0, 1.0]]
    for which, item in steps:
        index = which % len(made)
        made.append(resolve((CONS, item, made[index])))
        known.append([item, *known[index]])
    assert [list(list_items(each)) for each in made] == known


def test_cons_tuples_that_end_in_a_list_unify_and_compare_as_the_list_does():
    whole = numbers(5)
    mixed = (CONS, 0.0, resolve(numbers(5).rest()))
    later = Var("T")
    later.ref = resolve(numbers(5).rest())
    for form in (mixed, cells([0.0, 1.0, 2.0, 3.0, 4.0]), (CONS, 0.0, later)):
        assert unify(whole, form, Trail())
        assert unify(form, whole, Trail())
        assert not unify(numbers(4), form, Trail())
        assert compare(whole, form) == compare(form, whole) == 0
        assert compare(numbers(4), form) < 0
        assert equal(whole, form)
        assert text(form) == "[0,1,2,3,4]"
        assert resolve(form).__class__ is List


def test_lists_unify_by_subsets_and_open_tails():
    plain = resolve(make_list([atom("p")]))
    annotated = resolve(make_list([Annotated(atom("p"), (atom("a"),))]))
    assert unify(plain, annotated, Trail())
    assert not unify(annotated, plain, Trail())
    assert not is_key(annotated)
    tail = Var("T")
    assert unify((CONS, 0.0, (CONS, 1.0, tail)), numbers(4), Trail())
    assert text(tail) == "[2,3]"


def test_a_long_list_is_a_key_and_survives_pickling():
    assert is_key(numbers(100_000))
    nested: Term = make_list([1.0])
    for _ in range(400):
        nested = make_list([nested])
    assert not is_key(resolve(nested))
    assert equal(nested, resolve(nested))
    made = numbers(3)
    hash(made)
    assert pickle.loads(pickle.dumps(made)) == made
    assert pickle.loads(pickle.dumps(made)).hashed is None


def test_ground_elements_are_not_checked_again_nor_found_variables():
    known = resolve(make_list([structure("f", float(i)) for i in range(50)]))
    known.stack[3] = Var("Unseen")  # what looks at it would find a variable
    longer = resolve((CONS, structure("g", 1.0), known))
    assert longer.size == 51
    assert free_variables(longer) == []
    assert is_ground(longer)
    assert is_key(longer)
    assert rename(longer) is longer
    variable = Var("X")
    open_one = resolve(make_list([1.0, variable, 2.0]))
    assert free_variables(open_one) == [variable]
    assert not is_key(open_one)
    variable.ref = 5.0
    assert is_key(resolve(open_one))
    assert text(open_one) == "[1,5,2]"
    variable.ref = None
    assert free_variables(open_one) == [variable]
    variable = Var("X")
    made = resolve(make_list([(BINARY["+"].functor, variable, 1.0), 3.0]))
    variable.ref = 1.0
    assert list(list_items(resolve(made))) == [2.0, 3.0]


def test_a_short_list_does_not_keep_longer_ones_in_memory():
    tail: Term = numbers(10_000)
    while list_length(tail) > 40:
        tail = tail.rest() if tail.__class__ is List else tail[2]
    assert len(resolve(tail).stack) < 1_000
    short = numbers(3)
    grown = short
    for i in range(10_000):
        grown = resolve((CONS, float(i), grown))
    assert grown.size == 10_003
    assert len(short.stack) < 100


@given(st.lists(elements, max_size=12))
def test_sorting_agrees_with_comparing(items):
    ordered = sorted_terms(items)
    assert all(compare(a, b) <= 0 for a, b in itertools.pairwise(ordered))
    assert sorted(map(text, ordered)) == sorted(map(text, items))
