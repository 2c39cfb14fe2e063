from drawn_terms import any_plans, build, ground_plans, plans
from hypothesis import given

from jacaros.agents.terms.substitution import equal, free_variables, resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, undo, unify
from jacaros.agents.terms.values import Annotated, String, Var, atom, functor, make_list, structure


def unified(left: object, right: object) -> bool:
    return unify(left, right, Trail())


@given(plans, plans)
def test_terms_that_unify_become_equal(left, right):
    scope: dict[str, Var] = {}
    first, second = build(left, scope), build(right, scope)
    if unified(first, second):
        known = set(map(id, scope.values()))
        renewed = [v for v in free_variables(first) if id(v) not in known]  # in place of one inside itself
        assert equal(first, second) or (renewed and unified(first, second))


@given(plans, plans)
def test_without_annotations_unification_is_symmetric(left, right):
    one: dict[str, Var] = {}
    other: dict[str, Var] = {}
    forward = unified(build(left, one), build(right, one))
    assert forward == unified(build(right, other), build(left, other))


@given(any_plans, any_plans)
def test_undo_undoes_every_binding(left, right):
    scope: dict[str, Var] = {}
    trail = Trail()
    unify(build(left, scope), build(right, scope), trail)
    undo(trail, 0)
    assert all(variable.ref is None for variable in scope.values())


@given(any_plans)
def test_a_term_unifies_with_itself_and_binds_nothing(plan):
    scope: dict[str, Var] = {}
    trail = Trail()
    assert unify(build(plan, scope), build(plan, scope), trail)
    assert trail == []


@given(ground_plans, ground_plans)
def test_ground_terms_unify_if_and_only_if_they_are_equal(left, right):
    first, second = build(left, {}), build(right, {})
    assert unified(first, second) == equal(first, second)


@given(plans)
def test_a_variable_takes_any_term_without_it(plan):
    term, variable = build(plan, {}), Var("New")
    assert unified(variable, term)
    assert equal(variable, term)


@given(plans, plans)
def test_resolving_twice_changes_nothing(left, right):
    scope: dict[str, Var] = {}
    first = build(left, scope)
    unify(first, build(right, scope), Trail())
    assert resolve(resolve(first)) == resolve(first)


def test_numbers_and_functors_have_to_agree():
    assert unified(1.0, 1.0)
    assert not unified(String("1"), 1.0)
    assert not unified(String("a"), atom("a"))
    assert not unified(structure("p", 1.0), structure("p", 1.0, 2.0))
    assert not unified((functor("p", 1, negated=True), 1.0), structure("p", 1.0))
    assert not unified(structure("p", 1.0, namespace="n"), structure("p", 1.0))
    assert not unified(atom("p"), structure("p", 1.0))


def test_lists_unify_with_their_tails_at_any_length():
    head, tail = Var("H"), Var("T")
    assert unified(make_list([head], tail), make_list([1.0, 2.0, 3.0]))
    assert (text(head), text(tail)) == ("1", "[2,3]")
    assert not unified(make_list([Var("A"), Var("B")]), make_list([1.0]))
    assert not unified(make_list([]), atom("a"))
    items = [float(n) for n in range(50_000)]
    last = Var("L")
    assert unified(make_list([*items, last]), make_list([*items, 0.0]))
    assert equal(make_list([*items, last]), make_list([*items, 0.0]))


def test_a_variable_does_not_become_a_part_of_itself():
    """A fresh variable stands inside: Jason builds a cyclic term, which could not be searched."""
    variable = Var("X")
    for term in (
        structure("f", variable),
        structure("f", variable, 1.0),
        structure("f", 1.0, structure("g", variable), 2.0),
        make_list([1.0, variable]),
        make_list([1.0], variable),
        Annotated(structure("f", variable), (atom("a"),)),
        Annotated(atom("p"), (structure("source", variable),)),
        Annotated(atom("p"), (), variable),
        structure("f", Annotated(structure("g", variable), (atom("a"),)), 1.0),
    ):
        for left, right in ((variable, term), (term, variable)):
            trail = Trail()
            assert unify(left, right, trail)
            assert all(v is not variable for v in free_variables(variable))
            undo(trail, 0)


def test_variables_share_their_value_and_know_their_binding():
    first, second, third = Var("A"), Var("B"), Var("C")
    assert unified(structure("f", first, second, third), structure("f", second, third, 5.0))
    assert [resolve(v) for v in (first, second, third)] == [5.0, 5.0, 5.0]
    trail = Trail()
    early, late = Var("E"), Var("L")
    unify(early, 1.0, trail)
    trail.serial = 7
    unify(late, 1.0, trail)
    assert (early.at, late.at) == (0, 7)
