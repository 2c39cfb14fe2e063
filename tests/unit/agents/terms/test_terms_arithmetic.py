import math
from collections.abc import Iterator

import pytest

import jacaros.agents.terms.functions  # noqa: F401 - the functions of the language
from jacaros.agents.terms.collections import MapValue, SetValue
from jacaros.agents.terms.operators import BINARY, RUNNING, ArithmeticFault, calculated, settle
from jacaros.agents.terms.substitution import resolve
from jacaros.agents.terms.text import text
from jacaros.agents.terms.unifier import Trail, unify
from jacaros.agents.terms.values import (
    ARITHMETIC,
    FUNCTION,
    String,
    Term,
    Var,
    atom,
    functor,
    make_list,
    structure,
)

INFINITY = math.inf


class Listener:
    """An agent that keeps what it is warned of."""

    def __init__(self) -> None:
        self.told: list[str] = []

    def call_own(self, term: Term) -> Term:
        return None

    def warn_of_operand(self, what: str, value: Term) -> None:
        self.told.append(f"{what} is not a number: {text(value)}")


@pytest.fixture
def warnings() -> Iterator[list[str]]:
    listener = Listener()
    before = RUNNING.set(listener)
    yield listener.told
    RUNNING.reset(before)


@pytest.mark.parametrize(
    ("left", "operator", "right", "value"),
    [
        (2.0, "+", 3.0, 5.0),
        (2.0, "-", 3.0, -1.0),
        (2.0, "*", 3.0, 6.0),
        (10.0, "/", 4.0, 2.5),
        (1.0, "/", 0.0, INFINITY),
        (-1.0, "/", 0.0, -INFINITY),
        (1.0, "/", -0.0, -INFINITY),
        (7.0, "div", 2.0, 3.0),
        (-7.0, "div", 2.0, -3.0),
        (7.9, "div", 2.9, 3.0),
        (5e9, "div", 1.0, 2147483647.0),
        (-5e9, "div", 1.0, -2147483648.0),
        (7.0, "mod", 3.0, 1.0),
        (-7.0, "mod", 3.0, -1.0),
        (7.0, "mod", -3.0, 1.0),
        (7.5, "mod", 2.0, 1.5),
        (2.0, "**", 10.0, 1024.0),
        (2.0, "**", -1.0, 0.5),
        (0.0, "**", -1.0, INFINITY),
        (10.0, "**", 400.0, INFINITY),
        (-10.0, "**", 401.0, -INFINITY),
    ],
)
def test_operations_on_doubles(left, operator, right, value):
    assert calculated(operator, left, right) == value


@pytest.mark.parametrize(
    ("left", "operator", "right"), [(0.0, "/", 0.0), (1.0, "mod", 0.0), (-8.0, "**", 1 / 3)]
)
def test_operations_without_a_real_result_give_nan(left, operator, right):
    assert math.isnan(calculated(operator, left, right))


def test_expressions_are_evaluated_once_their_variables_have_values():
    operand, result = Var("Z"), Var("Y")
    trail = Trail()
    assert unify(result, (BINARY["+"].functor, operand, 1.0), trail)
    assert text(result) == "(Z+1)"
    unify(operand, 2.0, trail)
    assert resolve(result) == 3.0
    assert unify(structure("f", 3.0), structure("f", result), trail)
    assert not unify(structure("f", 4.0), structure("f", result), trail)
    assert calculated("-", 2.0) == -2.0
    assert text(calculated("-", Var("X"))) == "(-X)"
    product = (functor("*", 2, kind=ARITHMETIC), 2.0, 3.0)
    assert resolve(structure("f", product)) == structure("f", 6.0)
    with pytest.raises(ArithmeticFault, match="division by zero"):
        calculated("div", 1.0, 0.5)


@pytest.mark.parametrize("operand", [atom("a"), String("2"), make_list([1.0])])
def test_an_operand_that_is_not_a_number_gives_nan_and_a_warning(operand, warnings):
    assert math.isnan(calculated("+", operand, 1.0))
    assert "`+` is not a number" in warnings[0]


def call(name: str, *arguments: Term) -> Term:
    return settle((functor(name, len(arguments), kind=FUNCTION), *arguments))


def numbers(*values: float) -> Term:
    return make_list([float(value) for value in values])


@pytest.mark.parametrize(
    ("name", "arguments", "value"),
    [
        ("math.abs", (-2.0,), 2.0),
        ("math.ceil", (1.2,), 2.0),
        ("math.ceil", (-INFINITY,), -INFINITY),
        ("math.floor", (-1.2,), -2.0),
        ("math.floor", (INFINITY,), INFINITY),
        ("math.round", (2.5,), 3.0),
        ("math.round", (-2.5,), -2.0),
        ("math.round", (0.49999999999999994,), 0.0),
        ("math.round", (1e300,), 9223372036854775807.0),
        ("math.round", (-INFINITY,), -9223372036854775808.0),
        ("math.round", (math.nan,), 0.0),
        ("math.sqrt", (9.0,), 3.0),
        ("math.log", (1.0,), 0.0),
        ("math.log", (0.0,), -INFINITY),
        ("math.max", (1.0, 3.0), 3.0),
        ("math.min", (1.0, 3.0), 1.0),
        ("math.max", (make_list([3.0, atom("a"), String("s"), 5.0]),), 5.0),
        ("math.max", (numbers(-3, -2),), -2.0),
        ("math.min", (SetValue({2.0: None, 1.0: None}),), 1.0),
        ("math.sum", (numbers(),), 0.0),
        ("math.sum", (numbers(0.1, 0.2, 0.3),), 0.1 + 0.2 + 0.3),
        ("math.sum", (make_list([3.0, atom("a"), 5.0]),), 8.0),
        ("math.average", (numbers(1, 2, 6),), 3.0),
        ("math.mean", (1.0, 3.0), 2.0),
        ("math.median", (numbers(3, 1, 2),), 2.0),
        ("math.median", (numbers(4, 1, 2, 3),), 2.5),
        ("math.std_dev", (numbers(1, 2, 3),), 1.0),
        ("math.std_dev", (numbers(),), 0.0),
        (".length", (String("hello"),), 5.0),
        (".length", (numbers(1, 2),), 2.0),
        (".length", (MapValue({1.0: 2.0}),), 1.0),
    ],
)
def test_functions_of_known_arguments(name, arguments, value):
    assert call(name, *arguments) == value


@pytest.mark.parametrize(
    ("name", "arguments"),
    [
        ("math.sqrt", (-1.0,)),
        ("math.log", (-1.0,)),
        ("math.acos", (2.0,)),
        ("math.std_dev", (numbers(1),)),
        (".length", (1.0,)),
    ],
)
def test_functions_without_a_value_give_nan(name, arguments):
    assert math.isnan(call(name, *arguments))


@pytest.mark.parametrize("name", ["math.max", "math.min", "math.average", "math.mean", "math.median"])
def test_some_functions_need_numbers(name):
    with pytest.raises(ArithmeticFault):
        call(name, make_list([atom("a")]))


@pytest.mark.parametrize("name", ["math.abs", "math.max", ".length"])
def test_functions_wait_for_their_arguments(name):
    waiting = call(name, Var("X"))
    assert text(waiting) == f"{name}(X)"


def test_unknown_functions_stay_terms_and_non_numbers_warn(warnings):
    assert text(call("math.unknown", 1.0)) == "math.unknown(1)"
    assert math.isnan(call("math.abs", atom("a")))
    assert "is not a number" in warnings[0]


def test_a_function_of_the_running_agent_is_called():
    class Doubling:
        def call_own(self, term: Term) -> Term:
            return settle(term[1]) * 2

        def warn_of_operand(self, what: str, value: Term) -> None:
            raise AssertionError(what)

    before = RUNNING.set(Doubling())
    try:
        assert call("my.double", 4.0) == 8.0
        assert calculated("+", (functor("my.double", 1, kind=FUNCTION), 4.0), 1.0) == 9.0
    finally:
        RUNNING.reset(before)
