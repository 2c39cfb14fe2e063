"""Values of terms, and how they are written in full or in part."""

import copy
import pickle
import re
import sys
import threading
import weakref

import pytest

from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import Variables, lower
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.operators import BINARY
from jacaros.agents.terms.plans import BODY_TERM, NO_LABEL, PLAN, make_body, step, trigger
from jacaros.agents.terms.text import display, double_text, excerpt, number_text, text
from jacaros.agents.terms.unifier import Trail, unify
from jacaros.agents.terms.values import (
    CONS,
    NIL,
    PLAIN,
    TRUE,
    Annotated,
    Reference,
    String,
    Term,
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


def bound(value: Term) -> Var:
    variable = Var("V")
    variable.ref = value
    return variable


@pytest.mark.parametrize(
    "term",
    [
        3.0,
        atom("a"),
        String("a text"),
        Var("X"),
        bound(bound(atom("a"))),
        structure("f", bound(structure("g", atom("b"))), make_list([1.0, bound(2.0)])),
        make_list([1.0], Var("T")),
        Annotated(structure("p", bound(1.0)), (atom("a"), structure("b", bound(2.0)))),
        (BINARY["+"].functor, 1.0, bound(2.0)),
        structure("f", SetValue()),
        structure("f", make_body([step("!", atom("go"))])),
    ],
)
def test_a_small_term_is_shown_in_full(term):
    assert text(excerpt(term)) == text(term)


def test_dots_mark_omitted_parts_and_excerpts_are_finite():
    assert text(excerpt(make_list([1.0, 2.0, 3.0, 4.0, 5.0]), 4)) == "[1,2,3|...]"
    assert (
        text(excerpt(structure("f", structure("g", atom("a")), structure("h", atom("b"))), 3))
        == "f(g(a),...)"
    )
    shared: Term = atom("a")
    for _ in range(200):
        shared = structure("f", shared, shared)
    assert text(excerpt(shared)).startswith("f(f(f(f(")
    itself = Var("X")
    itself.ref = (functor("f", 1), itself)
    assert text(excerpt(itself)).startswith("f(f(f(f(")
    ring = Var("L")
    ring.ref = (CONS, 1.0, ring)
    assert text(excerpt(ring)).startswith("[1,1,1,1,")
    deep: Term = atom("a")
    for _ in range(100_000):
        deep = structure("f", deep)
    assert len(text(excerpt(deep))) < 1000


NUMBERS = """
3.0 3 | -2.0 -2 | -0.0 0 | 2.5 2.5 | -1.5 -1.5 | 0.30000000000000004 0.30000000000000004
0.3333333333333333 0.3333333333333333 | 10000000000.0 10000000000 | 9007199254740992.0 9007199254740992
9.223372036854776e+18 9223372036854775807 | -9.223372036854776e+18 -9223372036854775808 | 1e+20 1.0E20
-1e+21 -1.0E21 | 1.5e-07 1.5E-7 | 5e-324 4.9E-324 | 1e-323 9.9E-324 | 1e+23 1.0E23 | 0.001 0.001 | 0.0001 1.0E-4
0.00012 1.2E-4 | 12345678.9 1.23456789E7 | 1234567.5 1234567.5 | 1.7976931348623157e+308 1.7976931348623157E308
inf Infinity | -inf -Infinity | nan NaN
"""


@pytest.mark.parametrize("case", re.split(r" \| |\n", NUMBERS.strip()))
def test_numbers_are_written_as_jason_does(case):
    value, written = case.split()
    assert number_text(float(value)) == written


@pytest.mark.parametrize(
    ("value", "written"), [(3.0, "3.0"), (0.0, "0.0"), (-0.0, "-0.0"), (1e7, "1.0E7"), (0.5, "0.5")]
)
def test_doubles_are_written_as_java_does(value, written):
    assert double_text(value) == written


WRITTEN = """
a
'A b'
ns::a
~q
ns::~q
"x"
f(a,g(1),"s")
~p(1)
[]
[1,a,[]]
[1|T]
p(1)[a,b]
p[a|T]
X
(X+1)
(X div 2)
(-X)
(X < 1)
(a & b)
not (a)
{ -!g }
{ h :- b }
{ @l +b(X) : c <- !g; act(1) }
{ @l +!g }
{ !g; +b }
{ !g }
{ }
"""


@pytest.mark.parametrize("written", WRITTEN.strip().splitlines())
def test_terms_are_written_as_jason_does(written):
    assert text(lower(parse_term(written), Variables().__getitem__)) == written


@pytest.mark.parametrize(
    ("term", "written"),
    [
        (String('say "x"\n'), '"say "x"\n"'),
        (make_list([1.0], make_list([2.0])), "[1,2]"),
        (SetValue({atom("b"): None, atom("a"): None}), "{a,b}"),
        (MapValue({atom("b"): 1.0, atom("a"): String("s")}), '{a->"s",b->1}'),
        (QueueValue(items=(atom("b"), atom("a"))), "[b,a]"),
        ((PLAN, NO_LABEL, trigger("+!", atom("g")), TRUE, make_body([])), "{ +!g }"),
        (make_body([step("!", atom("g"))]), "!g"),
        (make_body([]), "{ }"),
        (make_body([step("!", atom("g")), step("+<", atom("b"))], symbol=BODY_TERM), "{ !g; +b }"),
        (step("if", atom("c"), make_body([step("", atom("a"))]), make_body([])), ".if_then_else(c,a,)"),
        (step("|&|", *(make_body([step("!", atom(name))]) for name in "ab")), ".fork(and,!a,!b)"),
    ],
)
def test_terms_without_a_text_of_their_own_are_written_as_jason_does(term, written):
    assert text(term) == written


def test_print_shows_top_level_strings_and_variables_in_its_own_way():
    assert display(String("x")) == "x"
    assert display(make_list([String("x")])) == '["x"]'
    assert display(Var("X")) == "X<no-value>"
    assert display(Var("_")) == "_<no-value>"
    assert display(Annotated(Var("X"), (atom("a"),))) == "X[a]<no-value>"
    assert display(structure("f", Var("X"))) == "f(X)"
    reference = Reference(object())
    assert text(reference) == f"cobj_{reference.number}"
    variable = Var("X")
    unify(variable, 2.0, Trail())
    assert text(structure("f", variable, (BINARY["+"].functor, variable, 1.0))) == "f(2,3)"
    assert text(make_list([1.0] * 5000)).count("1") == 5000
