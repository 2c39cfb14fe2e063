"""Excerpts of terms: the shown text is limited, whatever the term is."""

import pytest

from jacaros.agents.terms.collections import SetValue
from jacaros.agents.terms.operators import BINARY
from jacaros.agents.terms.plans import make_body, step
from jacaros.agents.terms.text import excerpt, text
from jacaros.agents.terms.values import (
    CONS,
    Annotated,
    String,
    Term,
    Var,
    atom,
    functor,
    make_list,
    structure,
)


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
