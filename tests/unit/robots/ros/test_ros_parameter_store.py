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
        self.log: list[str] = []
        self.given = GivenParameters(given)
        self.parameters = DeclaredParameters("/node", self.given, self.news.append, self.log.append)

    def declare(self, name: str, default: ParameterValue, **more: Any) -> ParameterValue:
        return self.parameters.declare(name, DeclaredParameter(default, **more))


def test_every_declaration_and_change_is_reported() -> None:
    store = Store()
    store.declare("a", 1)
    store.parameters.set("a", 2)
    with pytest.raises(ParameterRefused):
        store.parameters.set("a", "two")
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


def test_an_empty_list_is_one_of_texts() -> None:
    store = Store()
    store.declare("places", [])
    store.parameters.set("places", ["hall"])
    with pytest.raises(ParameterRefused, match="of type empty list"):
        store.parameters.set("places", [1])


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
def test_a_type_stays(default: ParameterValue, other: ParameterValue) -> None:
    store = Store()
    store.declare("p", default)
    with pytest.raises(ParameterRefused, match="p of /node is of type"):
        store.parameters.set("p", other)
    assert store.parameters.get("p") == default


def test_an_empty_list_is_a_list_of_anything() -> None:
    store = Store()
    store.declare("names", ["a"])
    store.parameters.set("names", [])
    store.parameters.set("names", ["b"])
    assert store.parameters.get("names") == ["b"]


@pytest.mark.parametrize(
    ("low", "high", "bad", "text"),
    [
        (0, None, -1, "at least 0"),
        (None, 5, 6, "at most 5"),
        (0, 5, 9, "from 0 to 5"),
        (0, 5, -0.5, "from 0 to 5"),
    ],
)
def test_ranges_may_be_open(low: float | None, high: float | None, bad: float, text: str) -> None:
    store = Store()
    store.declare("p", type(bad)(1), minimum=low, maximum=high)
    with pytest.raises(ParameterRefused, match=f"p of /node is {text}, not {bad}"):
        store.parameters.set("p", bad)


def test_read_only_and_judged_values() -> None:
    store = Store()
    store.declare("model", "waffle", read_only=True)
    with pytest.raises(ParameterRefused, match="model of /node is read-only"):
        store.parameters.set("model", "burger")
    store.declare("even", 2, accept=lambda value: "odd" if value % 2 else None)
    with pytest.raises(ParameterRefused, match="even of /node cannot be 3: odd"):
        store.parameters.set("even", 3)


def test_a_judgement_that_fails_refuses() -> None:
    store = Store()
    allowed = {1: None}
    store.declare("p", 1, accept=lambda value: allowed[value])
    with pytest.raises(ParameterRefused, match="KeyError: 2"):
        store.parameters.set("p", 2)
    assert store.log == ["the check of a parameter of /node failed: KeyError: 2"]


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
