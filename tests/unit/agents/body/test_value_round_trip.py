"""What crosses from Python to an agent and back, or the other way round, is what it was."""

import datetime
import math
from collections import deque
from pathlib import PurePath
from types import MappingProxyType

import pytest
from hypothesis import given

from drawn_values import VALUES, same
from jacaros.agents.body.values import References, atom_of, to_term, to_value
from jacaros.agents.language.loader import parse_literal
from jacaros.agents.language.lowering import Variables, lower_value
from jacaros.agents.terms.collections import MapValue, SetValue
from jacaros.agents.terms.substitution import equal
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import Reference, Term, atom, functor, list_items, make_list
from jacaros.artifacts.env.values import Atom, Structure, plain


def term(value: object) -> Term:
    return to_term(plain(value), References())


@given(VALUES)
def test_a_value_comes_back_from_the_agent(value):
    assert same(to_value(term(value)), value)


@given(VALUES)
def test_a_term_comes_back_from_the_artifact(value):
    there = term(value)
    back = term(to_value(there))
    assert text(back) == text(there)
    if not _has_map(value):  # maps are equal only to themselves
        assert equal(back, there)


def _has_map(value: object) -> bool:
    if isinstance(value, dict):
        return True
    items = value.arguments if isinstance(value, Structure) else value if isinstance(value, list) else ()
    return any(map(_has_map, items))


@pytest.mark.parametrize(
    "name", ["~neg", "ns::at", "ns::~at", "a b", "Upper", "not", "'quoted'", "[]", "~", "x::"]
)
def test_names_of_any_kind_come_back(name):
    for value in (Atom(name), Structure(name, (1, Atom(name)))):
        assert same(to_value(term(value)), value)


@pytest.mark.parametrize(
    ("value", "written"),
    [
        ((1, (2, "a")), '[1,[2,"a"]]'),
        (range(3), "[0,1,2]"),
        (deque([1]), "[1]"),
        ({2, 1}, "{1,2}"),
        (frozenset([(1, 2)]), "{[1,2]}"),
        (MappingProxyType({"a": {1}}), '{"a"->{1}}'),
        (math.inf, "Infinity"),
        (10**400, "Infinity"),
        (-0.0, "0"),
        (None, "_"),
        ([None, True], "[_,true]"),
        (Atom("true"), "true"),
    ],
)
def test_what_has_a_counterpart_crosses_by_content(value, written):
    assert text(term(value)) == written


@pytest.mark.parametrize(
    "value",
    [b"bytes", datetime.datetime(2026, 1, 1), PurePath("/"), 1j, object(), len, memoryview(b"x")],
    ids=repr,
)
def test_anything_else_is_a_reference_and_comes_back_as_the_same_object(value):
    reference = term(value)
    assert reference.__class__ is Reference
    assert to_value(reference) is value
    assert next(list_items(term([value]))) is reference
    assert text(reference).startswith("cobj_")


def test_references_sets_and_keys_of_maps():
    assert term(datetime.date(2026, 1, 1)) == term(datetime.date(2026, 1, 1))
    assert term(datetime.date(2026, 1, 1)) != term(datetime.date(2026, 1, 2))
    assert term(bytearray(b"a")) != term(bytearray(b"a")), "it may change"
    one, other = Rude(), Rude()
    first, second = Reference(one), Reference(one)
    assert first == second
    assert hash(first) == hash(second)
    assert first != Reference(other)
    assert to_value(SetValue({3.0: None, 1.0: None, 2.0: None})) == [1, 2, 3]
    keys = (make_list([1.0]), (functor("p", 1), make_list([2.0])), MapValue({atom("a"): 1.0}))
    value = to_value(MapValue(dict.fromkeys(keys, 0.0)))
    assert value == {(1,): 0, Structure("p", ((2,),)): 0, ((Atom("a"), 1),): 0}


class Rude:
    """Cannot be compared or hashed."""

    def __eq__(self, other: object) -> bool:
        raise RuntimeError("no")

    def __hash__(self) -> int:
        raise RuntimeError("no")


def test_what_contains_itself_is_refused():
    ring: list[object] = []
    ring += [ring, ring]
    with pytest.raises(ValueError, match="contains itself, or is nested deeper than 200 levels"):
        plain(ring)
    nested: object = 1
    for _ in range(200):
        nested = [nested]
    plain(nested)
    with pytest.raises(ValueError, match="contains itself"):
        plain([nested])


def test_names_are_plain_texts_and_annotations_come_back():
    assert type(term(Atom("neverNamedBefore")).name) is str
    assert type(term(Structure(Atom("norThis"), (1,)))[0].name) is str
    assert type(atom_of(Atom("andThis")).name) is str
    value = to_value(lower_value(parse_literal("ns(1, q(2)[b])[a(2), c]"), Variables()))
    assert value == Structure("ns", (1, Structure("q", (2,))))
    assert str(value) == "ns(1,q(2)[b])[a(2),c]"
    assert text(to_term(plain([value]), References())) == "[ns(1,q(2)[b])[a(2),c]]"
