"""Plain values: conversion, copies, comparison and printing."""

import enum
from collections import namedtuple
from dataclasses import dataclass

import numpy as np
import pytest

from jacaros.artifacts import Atom, Out, Structure, plain, resolve_path, text
from jacaros.artifacts.env.values import UNSET, equal


@dataclass
class Pose2D:
    x: float
    y: float
    tags: list


@dataclass
class Nothing:
    pass


def test_an_atom_is_its_text_but_shows_itself_as_an_atom():
    atom = Atom("kitchen")
    assert atom == "kitchen"
    assert {atom: 1}["kitchen"] == 1
    assert repr(atom) == "Atom('kitchen')"


def test_scalars_stay_what_they_are():
    for value in (1, 1.5, True, "x", Atom("a"), None, 10**30):
        assert plain(value) is value


def test_lists_and_dictionaries_are_copied_in_depth_and_tuples_become_lists():
    inner = [1, 2]
    given = {"a": inner, "b": (inner, 3)}
    got = plain(given)
    assert got == {"a": [1, 2], "b": [[1, 2], 3]}
    inner.append(3)
    assert got["a"] == [1, 2]


def test_structures_are_converted_inside():
    assert plain(Structure("p", ((1, 2), np.int64(3)))) == Structure("p", ([1, 2], 3))


def test_dataclasses_and_named_tuples_become_structures():
    assert plain(Pose2D(1.0, 2.0, ["a"])) == Structure("pose2D", (1.0, 2.0, ["a"]))
    assert plain(namedtuple("Cell", "row column")(1, (2, 3))) == Structure("cell", (1, [2, 3]))
    assert plain(Nothing()) == Atom("nothing")
    assert isinstance(plain(Nothing()), Atom)


def test_a_dataclass_itself_is_an_opaque_reference():
    assert plain(Pose2D) is Pose2D


def test_numpy_scalars_and_arrays_become_numbers_and_lists():
    converted = [plain(np.float64(1.5)), plain(np.int8(3)), plain(np.bool_(True)), plain(np.float32(0.5))]
    assert converted == [1.5, 3, True, 0.5]
    assert [type(value) for value in converted] == [float, int, bool, float]
    assert plain(np.array([[1, 2], [3, 4]])) == [[1, 2], [3, 4]]
    assert plain(np.array(7.0)) == 7.0


def test_members_of_text_and_number_enumerations_become_texts_and_numbers():
    class Colour(enum.StrEnum):
        RED = "red"

    class Level(enum.IntEnum):
        LOW = 1

    assert type(plain(Colour.RED)) is str
    assert plain(Colour.RED) == "red"
    assert type(plain(Level.LOW)) is int


def test_subclasses_of_numbers_become_numbers():
    class Metres(float):
        pass

    assert type(plain(Metres(1.5))) is float


def test_anything_else_crosses_as_a_reference():
    thing = object()
    assert plain(thing) is thing
    assert plain([thing])[0] is thing


def test_dictionary_keys_stay_usable():
    assert plain({np.int64(1): 2, (1, 2): 3}) == {1: 2, (1, 2): 3}


def test_an_output_holds_a_plain_value_once_set():
    out = Out()
    assert (out.value, out.is_set, repr(out)) == (UNSET, False, "Out(UNSET)")
    out.set(np.array([1, 2]))
    assert (out.value, out.is_set, repr(out)) == ([1, 2], True, "Out([1, 2])")
    out.set(None)
    assert out.is_set


@pytest.mark.parametrize(
    ("left", "right", "same"),
    [
        (3, 3.0, True),
        (1, True, False),
        (True, True, True),
        (0, False, False),
        ([1, True], [1, True], True),
        ([1], [True], False),
        ([1], [1, 2], False),
        (Structure("p", (1,)), Structure("p", (1.0,)), True),
        (Structure("p", (1,)), Structure("p", (True,)), False),
        (Structure("p", (1,)), Structure("q", (1,)), False),
        ("a", Atom("a"), True),
        ("a", 1, False),
        ({"a": 1}, {"a": 1}, True),
    ],
)
def test_equality_is_that_of_agents(left, right, same):
    assert equal(left, right) is same
    assert equal(right, left) is same


def test_values_are_written_as_agents_print_them():
    assert text(3.0) == "3"
    assert text(0.5) == "0.5"
    assert text(1e20) == "1e+20"
    assert text(True) == "true"
    assert text("plain") == "plain"
    assert text(["a", Atom("b"), 1.0, [True]]) == '["a",b,1,[true]]'
    assert str(Structure("p", ("a", Atom("b"), 'say "hi"'))) == 'p("a",b,"say \\"hi\\"")'
    assert text({"a": 1}) == "{'a': 1}"


@pytest.mark.parametrize(
    ("base", "path", "full"),
    [
        ("/main", "lab", "/main/lab"),
        ("/main/lab", "../office", "/main/office"),
        ("/main/lab", "/main", "/main"),
        ("/main", ".", "/main"),
        ("/main", "a/b/./c", "/main/a/b/c"),
        ("/main", "../../..", "/"),
    ],
)
def test_paths_are_relative_to_a_workspace(base, path, full):
    assert resolve_path(base, path) == full
