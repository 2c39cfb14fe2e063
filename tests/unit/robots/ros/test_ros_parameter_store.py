"""Declared parameters: types, ranges, refusals, news."""

import math
from collections.abc import Mapping
from typing import Any

import pytest

from jacaros.robots.ros.errors import ParameterRefused, ParameterUnknown
from jacaros.robots.ros.parameter import (
    DeclaredParameter,
    DeclaredParameters,
    GivenParameters,
    ParameterValue,
    checked_value,
    kind_of,
)


class Store:
    """A store with what it told."""

    def __init__(self, **given: ParameterValue) -> None:
        self.news: list[Mapping[str, ParameterValue]] = []
        self.given = GivenParameters(given)
        self.parameters = DeclaredParameters("/node", self.given, self.news.append)

    def declare(self, name: str, default: ParameterValue, **more: Any) -> ParameterValue:
        return self.parameters.declare(name, DeclaredParameter(default, **more))

    def refuses(self, name: str, value: Any, why: str) -> None:
        """Assert that a value is not taken."""
        with pytest.raises(ParameterRefused, match=why):
            self.parameters.set(name, value)


@pytest.fixture
def store() -> Store:
    """An empty store."""
    return Store()


def test_every_declaration_and_change_is_reported(store: Store) -> None:
    store.declare("a", 1)
    store.parameters.set("a", 2)
    store.refuses("a", "two", "of type int")
    assert store.news == [{"a": 1}, {"a": 2}]


def test_a_given_value_takes_the_place_of_the_default() -> None:
    store = Store(speed=0.25)
    assert store.declare("speed", 0.5) == 0.25
    assert store.parameters.get("speed") == 0.25


def test_given_but_undeclared_values_are_known() -> None:
    store = Store(speed=0.25, spede=1)
    store.declare("speed", 0.5)
    store.declare("turn", 2)
    assert store.given.untaken() == ["spede"]
    assert store.given.known() == ["speed", "turn"]
    assert "spede" not in store.parameters.names()


def test_the_error_for_an_integer_says_what_to_write() -> None:
    store = Store(speed=1)
    with pytest.raises(ParameterRefused, match=r"of type float; 1 is of type int; write 1\.0"):
        store.declare("speed", 0.5)


def test_an_empty_list_is_one_of_texts_and_a_list_of_anything(store: Store) -> None:
    store.declare("places", [])
    store.parameters.set("places", ["hall"])
    store.refuses("places", [1], "of type empty list")
    store.declare("names", ["a"])
    store.parameters.set("names", [])
    store.parameters.set("names", ["b"])
    assert store.parameters.get("names") == ["b"]


def test_a_given_value_has_to_fit_the_declaration() -> None:
    store = Store(speed="fast", rate=100)
    with pytest.raises(ParameterRefused, match="speed of /node is of type float; 'fast' is of type text"):
        store.declare("speed", 0.5)
    with pytest.raises(ParameterRefused, match="rate of /node is at most 50, not 100"):
        store.declare("rate", 10, maximum=50)
    assert store.parameters.names() == []


@pytest.mark.parametrize(
    ("default", "other"),
    [(1, 1.0), (1.0, 1), (True, 1), (1, True), ("a", b"a"), ([1], [1.0]), (["a"], "a"), (1, [1])],
)
def test_a_type_stays(store: Store, default: ParameterValue, other: ParameterValue) -> None:
    store.declare("p", default)
    store.refuses("p", other, "p of /node is of type")
    assert store.parameters.get("p") == default


@pytest.mark.parametrize(
    ("low", "high", "bad", "text"),
    [
        (0, None, -1, "at least 0"),
        (None, 5, 6, "at most 5"),
        (0, 5, 9, "from 0 to 5"),
        (0, 5, -0.5, "from 0 to 5"),
    ],
)
def test_ranges_may_be_open(
    store: Store, low: float | None, high: float | None, bad: float, text: str
) -> None:
    store.declare("p", type(bad)(1), minimum=low, maximum=high)
    store.refuses("p", bad, f"p of /node is {text}, not {bad}")


def test_read_only_values(store: Store) -> None:
    store.declare("model", "waffle", read_only=True)
    store.refuses("model", "burger", "model of /node is read-only")


def test_unknown_names_are_reported_with_the_known_ones() -> None:
    store = Store()
    with pytest.raises(ParameterUnknown, match="/node has no parameter a; it has none"):
        store.parameters.get("a")
    store.declare("b", 1)
    with pytest.raises(ParameterUnknown, match="no parameter a; it has b"):
        store.parameters.set("a", 1)


@pytest.mark.parametrize("value", [None, {"a": 1}, [1, "a"], [[1]], [b"a"], math.nan, object()])
def test_other_values_are_refused_as_parameters(value: Any) -> None:
    with pytest.raises(ParameterRefused, match="expected a bool, a number"):
        checked_value(value)


def test_values_become_plain() -> None:
    class Atom(str):
        pass

    assert type(checked_value(Atom("a"))) is str
    assert checked_value((1, 2)) == [1, 2]
    assert checked_value(bytearray(b"a")) == b"a"
    assert [kind_of(value) for value in (True, 1, 1.0, "a", b"a", [], [True], [1], [1.0], ["a"])] == [
        *("bool", "int", "float", "text", "bytes", "empty list"),
        *("list of bool", "list of int", "list of float", "list of text"),
    ]


def test_an_integer_that_python_does_not_write_is_refused_by_its_size() -> None:
    with pytest.raises(ParameterRefused, match="an integer of 20001 bits is too large for a parameter"):
        checked_value(1 << 20_000)
