from drawn_terms import any_plans, build, ground_plans, plans
from hypothesis import given

from jacaros.agents.terms.substitution import equal, free_variables, is_ground, rename, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Annotated, Var, atom, make_list, structure


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
