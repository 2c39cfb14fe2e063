"""Terms nested as deeply as Python's stack allows and more deeply, and terms that contain themselves."""

from collections.abc import Callable
from contextlib import suppress

import pytest

from jacaros.agents.terms import order, substitution, unifier, values
from jacaros.agents.terms.collections import MapValue, SetValue, detached
from jacaros.agents.terms.operators import BINARY
from jacaros.agents.terms.order import annotation_set, compare, sorted_terms
from jacaros.agents.terms.substitution import (
    as_key,
    equal,
    free_variables,
    is_ground,
    is_key,
    rename,
    resolve,
)
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, unify
from jacaros.agents.terms.values import Annotated, Term, Var, atom, make_list, structure

pytestmark = pytest.mark.whole_stack

DEPTH = 150
"""Depth of any kind of nesting that has room on Python's stack, below that of a run."""
TOO_DEEP = (5_000, 100_000)
OPERATIONS: dict[str, Callable[[Term, Term], object]] = {
    "resolve": lambda term, _: resolve(term),
    "rename": lambda term, _: rename(term),
    "text": lambda term, _: text(term),
    "unify": lambda term, twin: unify(term, twin, Trail()),
    "compare": compare,
    "equal": equal,
    "sort": lambda term, twin: sorted_terms([term, twin]),
    "key": lambda term, twin: (is_key(term), as_key(term)),
    "detach": lambda term, _: detached(term),
}


def nested(innermost: Term, wrap: Callable[[Term], Term], depth: int = DEPTH) -> Term:
    term = innermost
    for _ in range(depth):
        term = wrap(term)
    return term


WRAPPERS: dict[str, Callable[[Term], Term]] = {
    "in the last argument": lambda t: structure("f", t),
    "in the first argument": lambda t: structure("f", t, 1.0),
    "in a list": lambda t: make_list([t]),
    "in the middle of a list": lambda t: make_list([1.0, t, atom("z")]),
    "with annotations": lambda t: Annotated(structure("f", t), (atom("a"),)),
    "by variables": lambda t: bound(structure("f", t, 2.0)),
}


def bound(term: Term) -> Var:
    variable = Var("B")
    variable.ref = term
    return variable


@pytest.fixture(params=WRAPPERS.values(), ids=WRAPPERS.keys())
def wrap(request: pytest.FixtureRequest) -> Callable[[Term], Term]:
    wrapper: Callable[[Term], Term] = request.param
    return wrapper


def test_deep_terms_are_written_whole_and_unify(wrap):
    written = text(nested(atom("core"), wrap))
    assert written.count("core") == 1
    assert written.count("(") + written.count("[") >= DEPTH
    variable = Var("X")
    assert unify(nested(variable, wrap), nested(atom("core"), wrap), Trail())
    assert variable.ref is atom("core")
    assert not unify(nested(atom("core"), wrap), nested(atom("other"), wrap), Trail())


def test_deep_terms_are_compared_and_sorted(wrap):
    low, high = nested(atom("a"), wrap), nested(atom("b"), wrap)
    assert compare(low, high) < 0 < compare(high, low)
    assert equal(low, nested(atom("a"), wrap))
    assert not equal(low, high)
    assert sorted_terms([high, low]) == [low, high]
    assert len(annotation_set((high, nested(atom("b"), wrap)))) == 1


def test_deep_terms_are_resolved_and_renamed(wrap):
    variable = Var("X")
    term = nested(variable, wrap)
    assert free_variables(term) == [variable]
    copy = rename(term)
    assert not is_ground(copy)
    assert unify(copy, nested(atom("core"), wrap), Trail())
    assert variable.ref is None
    variable.ref = atom("core")
    assert equal(resolve(term), nested(atom("core"), wrap))


@pytest.mark.parametrize("depth", TOO_DEEP)
@pytest.mark.parametrize("operation", OPERATIONS.values(), ids=OPERATIONS.keys())
def test_deeper_terms_are_refused_or_handled(operation, wrap, depth):
    with suppress(RecursionError):
        operation(nested(Var("X"), wrap, depth), nested(atom("core"), wrap, depth))


def test_variables_are_found_in_their_own_values():
    for name in ("in the first argument", "in a list", "in the middle of a list", "by variables"):
        variable = Var("X")
        assert unify(variable, nested(variable, WRAPPERS[name]), Trail())
        assert all(free is not variable for free in free_variables(variable))
    variable = Var("X")
    assert unify(variable, structure("f", variable), Trail())
    assert text(variable) == "f(X)"


def test_deep_arithmetic_and_many_variables_are_handled():
    plus = BINARY["+"].functor
    assert resolve(nested(1.0, lambda t: (plus, 1.0, t))) == DEPTH + 1
    variables = [Var(f"V{n}") for n in range(100_000)]
    assert free_variables(make_list([*variables, *variables])) == variables
    assert not is_key(nested(atom("core"), WRAPPERS["in the first argument"], 400))


def circle(length: int) -> Var:
    """``X = f(f(...f(X)))``: too long for the check that refuses short ones."""
    variable = Var("X")
    variable.ref = nested(variable, lambda t: structure("f", t), length)
    return variable


def ring(length: int) -> Var:
    """A list whose tail is the list itself."""
    variable = Var("L")
    variable.ref = make_list([1.0] * length, variable)
    return variable


@pytest.mark.parametrize("make", [circle, ring])
@pytest.mark.parametrize("length", [1, 100, 5000])
def test_a_term_that_contains_itself_never_blocks_a_run(make, length, monkeypatch):
    for module in (order, substitution, unifier, values):
        monkeypatch.setattr(module, "MOST_CELLS", 20_000)
    term, twin = make(length), make(length)
    for use in (resolve, text, rename, lambda t: equal(t, twin)):
        with pytest.raises(RecursionError):
            use(term)
    with pytest.raises(RecursionError):
        unify(term, twin, Trail())
    with pytest.raises(RecursionError):
        compare(term, twin)
    assert is_ground(term)
    assert not unify(term, atom("a"), Trail())


def test_a_collection_that_contains_itself_is_written_once():
    items, pairs = SetValue(), MapValue()
    items.items[structure("f", items)] = None
    pairs.items[atom("self")] = pairs
    assert text(items) == "{f(...)}"
    assert text(pairs) == "{self->...}"
    assert text(structure("g", items, items)) == "g({f(...)},{f(...)})"
