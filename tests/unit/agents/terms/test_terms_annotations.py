import pytest

from jacaros.agents.terms.order import annotation_set
from jacaros.agents.terms.substitution import equal
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, each_annotation_match, unify
from jacaros.agents.terms.values import Annotated, Term, Var, atom, make_list, structure

A, B, C = atom("a"), atom("b"), atom("c")


def p(*annotations: Term, tail: Term = None) -> Term:
    """``p[annotations | tail]``."""
    if not annotations and tail is None:
        return atom("p")
    return Annotated(atom("p"), annotation_set(annotations), tail)


def unified(left: Term, right: Term) -> bool:
    return unify(left, right, Trail())


@pytest.mark.parametrize(
    ("left", "right", "holds"),
    [
        (p(), p(A), True),
        (p(A), p(), False),
        (p(A), p(A, B), True),
        (p(A, B), p(A), False),
        (p(B, A), p(A, B), True),
        (p(C), p(A, B), False),
        (p(structure("s", A)), p(structure("s", B)), False),
        (structure("f", p()), structure("f", p(A)), True),
        (structure("f", p(A)), structure("f", p()), False),
        (make_list([p()]), make_list([p(A)]), True),
        (p(A), atom("q"), False),
        (p(A), 1.0, False),
    ],
)
def test_the_annotations_of_the_left_are_looked_for_in_the_right(left, right, holds):
    assert unified(left, right) is holds


def test_annotations_are_taken_in_order():
    who = Var("W")
    assert unified(
        p(structure("source", who)), p(structure("other", A), structure("source", B), structure("source", C))
    )
    assert text(who) == "b"
    who = Var("W")
    found = (structure("source", A), structure("source", B), atom("x"))
    ways = each_annotation_match((structure("source", who),), None, found, None, Trail())
    assert [text(who) for _ in ways] == ["a", "b"]
    assert who.ref is None
    first, second = Var("A"), Var("B")
    ways = each_annotation_match((first, second), None, (A, B), None, Trail())
    assert [text(make_list([first, second])) for _ in ways] == ["[a,b]", "[b,a]"]


def test_a_tail_takes_the_rest():
    rest, who = Var("R"), Var("W")
    ways = each_annotation_match((who,), rest, (A, B, C), None, Trail())
    assert [text(make_list([who, rest])) for _ in ways] == ["[a,[b,c]]"]
    assert rest.ref is None
    assert unified(p(B, tail=rest), p(A, B, C))
    assert text(rest) == "[a,c]"
    rest = Var("R")
    assert unified(p(tail=rest), p(A, B))
    assert text(rest) == "[a,b]"
    nothing = Var("N")
    assert unified(p(tail=nothing), p())
    assert text(nothing) == "[]"
    rest = Var("R")
    pattern = p(A, tail=rest)
    assert unified(p(A, B), pattern)
    assert unified(p(A, B), pattern)
    assert (text(rest), text(pattern)) == ("[b]", "p[a,b]")
    rest = Var("R")
    assert unified(rest, make_list([C, A]))
    assert unified(p(tail=rest), p(A, B, C))
    assert not unified(p(tail=rest), p(A, B))
    assert unified(p(C), p(B, tail=rest))
    assert not unified(p(atom("d")), p(B, tail=rest))


def test_a_variable_with_annotations_has_the_bare_term_and_both():
    whole, rest = Var("X"), Var("R")
    assert unified(Annotated(whole, (A,), rest), p(A, B))
    assert (text(whole), text(rest)) == ("p", "[b]")
    whole = Var("X")
    assert unified(whole, p(A))
    assert text(Annotated(whole, (B,))) == "p[a,b]"
    assert unified(Annotated(whole, (B,)), p(A, B))
    assert not unified(Annotated(whole, (B,)), p(A))


def test_equality_compares_sorted_sets_of_annotations():
    assert equal(p(A, B), p(B, A))
    assert not equal(p(A), p())
    assert not equal(p(), p(A))
    assert annotation_set((B, A, B, structure("source", A), 1.0)) == (1.0, A, B, structure("source", A))
    assert annotation_set((B,)) == (B,)
    assert annotation_set(()) == ()
    first, second = Var("X"), Var("X")
    assert len(annotation_set((first, second, first))) == 2
    told = Annotated(structure("source", B), (structure("source", C),))
    who = Var("W")
    assert unified(p(structure("source", B)), p(told))
    assert unified(p(Annotated(structure("source", B), (structure("source", who),))), p(told))
    assert text(who) == "c"
    assert not unified(p(told), p(structure("source", B)))
