from collections.abc import Callable
from functools import cmp_to_key

import pytest
from drawn_terms import any_plans, build
from hypothesis import given
from hypothesis import strategies as st

from jacaros.agents.terms import order
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.operators import BINARY
from jacaros.agents.terms.order import annotation_set, compare, merge_annotations, sorted_set, sorted_terms
from jacaros.agents.terms.substitution import equal, related
from jacaros.agents.terms.text import text
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


def test_sorting_puts_terms_in_order_and_keeps_equal_ones_apart():
    assert sorted_terms(reversed(IN_ORDER)) == IN_ORDER
    twins = [Annotated(atom("a"), ()), atom("a")]
    assert sorted_terms(twins) == twins


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


def test_numbers_and_arithmetic_are_sorted_by_value():
    nan = float("nan")
    assert [text(n) for n in sorted_terms([nan, 2.0, nan, 1.0])] == ["1", "2", "NaN", "NaN"]
    assert compare(nan, float("nan")) == 0
    assert compare((BINARY["+"].functor, 1.0, 2.0), 3.0) == 0


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
