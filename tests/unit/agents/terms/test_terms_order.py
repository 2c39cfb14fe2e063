"""The standard order of terms, and their values once variables are bound."""

from collections.abc import Callable
from functools import cmp_to_key

import pytest
from drawn_terms import any_plans, build, ground_plans, plans
from hypothesis import given
from hypothesis import strategies as st

from jacaros.agents.terms import order
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.operators import BINARY
from jacaros.agents.terms.order import annotation_set, compare, merge_annotations, sorted_set, sorted_terms
from jacaros.agents.terms.substitution import equal, free_variables, is_ground, related, rename, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import (
    Annotated,
    Reference,
    String,
    Term,
    Var,
    atom,
    functor,
    make_list,
    structure,
)


def sign(number: int) -> int:
    return (number > 0) - (number < 0)


@given(any_plans, any_plans)
def test_the_order_is_total_and_antisymmetric(left, right):
    scope: dict[str, Var] = {}
    first, second = build(left, scope), build(right, scope)
    assert sign(compare(first, second)) == -sign(compare(second, first))
    assert (compare(first, second) == 0) == equal(first, second)


@given(any_plans, any_plans, any_plans)
def test_the_order_is_transitive(first, second, third):
    scope: dict[str, Var] = {}
    low, middle, high = sorted_terms([build(plan, scope) for plan in (first, second, third)])
    assert compare(low, middle) <= 0
    assert compare(middle, high) <= 0
    assert compare(low, high) <= 0


IN_ORDER: list[Term] = [
    float("-inf"),
    -1.0,
    2.0,
    float("inf"),
    float("nan"),
    String(""),
    String("a"),
    String("b"),
    make_list([]),
    make_list([1.0]),
    make_list([1.0, 1.0]),
    make_list([2.0]),
    atom("a"),
    Annotated(atom("a"), (atom("x"),)),
    Annotated(atom("a"), (atom("x"), atom("y"))),
    Annotated(atom("a"), (atom("y"),)),
    structure("a", 1.0),
    structure("a", 1.0, 1.0),
    structure("a", 2.0),
    functor("a", 0, negated=True),
    atom("b"),
    atom("a", "namespace"),
    MapValue(),
    QueueValue(),
    SetValue(),
    Var("X"),
    Var("Y"),
    Var("_"),
]


NAMESAKES = [
    structure("p", 2.0, String("b")),
    structure("p", 2.0, String("a")),
    structure("p", float("-inf"), String("a")),
    structure("p", float("nan"), String("a")),
    structure("p", 2.0, atom("a")),
    structure("p", 1.0),
    structure("p", 0.0),
    structure("p", -0.0),
    atom("p"),
    atom("p", "ns"),
    functor("p", 0, negated=True),
    structure("q", Var("X")),
    structure("q", make_list([])),
    structure("q", structure("p", 1.0)),
    structure("q", structure("p", 1.0)),
    (BINARY["+"].functor, 1.0, 2.0),
]


@pytest.mark.parametrize("position", range(1, len(IN_ORDER)))
def test_each_kind_of_term_has_its_place(position):
    lower, higher = IN_ORDER[position - 1], IN_ORDER[position]
    assert compare(lower, higher) < 0
    assert compare(higher, lower) > 0


def test_terms_are_sorted_by_value_and_equal_ones_kept():
    assert sorted_terms(reversed(IN_ORDER)) == IN_ORDER
    twins = [Annotated(atom("a"), ()), atom("a")]
    assert sorted_terms(twins) == twins
    nan = float("nan")
    assert [text(n) for n in sorted_terms([nan, 2.0, nan, 1.0])] == ["1", "2", "NaN", "NaN"]
    assert compare(nan, float("nan")) == 0
    assert compare((BINARY["+"].functor, 1.0, 2.0), 3.0) == 0


drawn_terms = st.lists(any_plans, max_size=6).map(lambda plans: [build(plan, {}) for plan in plans])


@given(drawn_terms | st.lists(st.sampled_from(NAMESAKES), max_size=8))
def test_terms_are_sorted_as_they_compare(terms):
    expected = sorted(terms, key=cmp_to_key(compare))
    assert list(map(id, sorted_terms(terms))) == list(map(id, expected))
    firsts = [term for place, term in enumerate(expected) if not place or compare(expected[place - 1], term)]
    assert list(map(id, sorted_set(terms))) == list(map(id, firsts))


@pytest.mark.parametrize(
    "terms",
    [
        [structure(name, atom("x")) for name in ("error", "code", "source", "code_line", "error_msg")],
        [structure("at", time, String("a")) for time in (3.0, 1.0, 2.0)],
    ],
)
def test_names_and_plain_arguments_are_sorted_without_comparing_terms(monkeypatch, terms):
    expected = sorted(terms, key=order.SortKey)
    monkeypatch.setattr(order, "SortKey", None)
    assert sorted_terms(terms) == expected


def test_variables_and_opaque_objects_keep_an_order():
    first, second = Var("X"), Var("X")
    assert compare(first, second) < 0 < compare(second, first)
    assert compare(first, first) == 0
    first, second = Reference(object()), Reference(object())
    assert compare(first, second) < 0 < compare(second, first)
    assert compare(first, Reference(first.value)) == 0
    items = [float(n) for n in range(50_000)]
    assert compare(make_list(items), make_list([*items, 1.0])) < 0


def test_collections_are_compared_by_what_they_hold():
    def queue(*items: float) -> QueueValue:
        made = QueueValue()
        for item in items:
            made.add(item)
        return made

    makers: list[Callable[[float], Term]] = [
        lambda n: SetValue({n: None}),
        lambda n: MapValue({atom("k"): n}),
        lambda n: MapValue({n: atom("v")}),
        queue,
    ]
    for make in makers:
        assert compare(make(1.0), make(2.0)) < 0 < compare(make(2.0), make(1.0))
        assert compare(make(1.0), make(1.0)) == 0


@given(st.lists(any_plans, max_size=6), st.lists(any_plans, max_size=3))
def test_merged_annotations_are_those_of_one_set(held, added):
    scope: dict[str, Var] = {}
    before = annotation_set(tuple(build(plan, scope) for plan in held))
    more = tuple(build(plan, scope) for plan in added)
    merged, new = merge_annotations(before, more)
    assert merged == annotation_set(before + more)
    assert annotation_set(before + new) == merged
    assert len(merged) == len(before) + len(new)


def test_one_more_annotation_is_compared_with_few_of_the_others(calls_of):
    def work(held: int) -> int:
        before = tuple(structure("time", float(number)) for number in range(held))
        return calls_of(lambda: merge_annotations(before, (structure("time", held / 2 + 0.5),)))

    assert work(4096) < 3 * work(16)


@pytest.mark.parametrize("symbol", ["<", "<=", ">", ">=", "=="])
def test_only_unequal_holds_for_nan(symbol):
    assert not related(symbol, float("nan"), 3.0)
    assert not related(symbol, 3.0, float("nan"))


@pytest.mark.parametrize(
    ("symbol", "left", "right"),
    [
        ("<", 3.0, atom("a")),
        (">", String("b"), String("a")),
        (">=", make_list([]), 7.0),
        ("<=", structure("p", 1.0), structure("p", 1.0)),
        ("==", structure("p", 1.0), structure("p", 1.0)),
        ("\\==", structure("p", 1.0), structure("p", 2.0)),
        ("\\==", 1.0, atom("a")),
        ("<", (BINARY["+"].functor, 1.0, 1.0), 3.0),
    ],
)
def test_relations_of_terms_follow_their_order_and_equality(symbol, left, right):
    assert related(symbol, left, right)


@given(ground_plans)
def test_resolving_a_ground_term_gives_the_same_object(plan):
    term = build(plan, {})
    assert resolve(term) is term
    assert is_ground(term)


@given(plans)
def test_resolving_without_bindings_gives_the_same_object(plan):
    term = build(plan, {})
    assert resolve(term) is term


def test_resolve_puts_values_and_annotations_in_place():
    first, rest = Var("X"), Var("T")
    term = structure("f", first, make_list([1.0], rest))
    trail = Trail()
    unify(first, structure("g", Var("Y")), trail)
    unify(rest, make_list([2.0, first]), trail)
    assert text(resolve(term)) == "f(g(Y),[1,2,g(Y)])"
    undo(trail, 0)
    assert text(term) == "f(X,[1|T])"
    whole, rest = Var("X"), Var("R")
    trail = Trail()
    unify(whole, Annotated(atom("p"), (atom("b"),)), trail)
    unify(rest, make_list([atom("a"), atom("b")]), trail)
    assert text(resolve(Annotated(whole, (atom("c"),), rest))) == "p[a,b,c]"
    rest = Var("R")
    unify(rest, make_list([]), Trail())
    assert resolve(Annotated(atom("p"), (), rest)) is atom("p")
    first = Var("X")
    assert not equal(structure("f", first), structure("f", 1.0))
    unify(first, 1.0, Trail())
    assert equal(structure("f", first), structure("f", 1.0))
    assert not equal(first, atom("a"))


@given(any_plans)
def test_a_renamed_term_shares_no_variable_and_is_otherwise_the_same(plan):
    scope: dict[str, Var] = {}
    term = build(plan, scope)
    copy = rename(term)
    fresh, old = free_variables(copy), free_variables(term)
    assert not set(map(id, fresh)) & set(map(id, old))
    assert [v.name for v in fresh] == [v.name for v in old]
    if not old:
        assert equal(copy, term)
    assert unify(copy, term, Trail())
    assert equal(copy, term)


@given(ground_plans)
def test_a_ground_term_is_not_copied(plan):
    term = build(plan, {})
    assert rename(term) is term


def test_copies_keep_equal_variables_equal():
    first, second = Var("X"), Var("Y")
    copy = rename(structure("f", first, second, first, make_list([second], first)))
    unify(copy[1], 1.0, Trail())
    assert text(copy) == "f(1,Y,1,[Y|1])"
    assert first.ref is None
    first = Var("X")
    names: dict[Var, Var] = {}
    one, other = rename(structure("f", first), names), rename(structure("g", first), names)
    assert one[1] is other[1]
    first, second, bound = Var("X"), Var("Y"), Var("Z")
    unify(bound, structure("g", second), Trail())
    term = structure("f", make_list([second, bound]), Annotated(atom("p"), (first,), Var("T")))
    assert [variable.name for variable in free_variables(term)] == ["Y", "X", "T"]
    assert not is_ground(term)
