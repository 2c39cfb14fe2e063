"""Integers that no double is equal to: exact in programs, with and without generated code."""

from pathlib import Path

import pytest

from jacaros.agents.terms.values import number
from jacaros.look.records.words import json_value
from jacaros.runtime.cli.main import call

BIG = 2**53 + 1


def printed(tmp_path: Path, capsys: pytest.CaptureFixture[str], steps: str, clauses: str = "") -> list[str]:
    """What a program prints."""
    file = tmp_path / "big.asl"
    file.write_text(f"{clauses}\n!start.\n+!start <- {steps}; .stopMAS.\n")
    assert call(["run", str(file), "--clock", "fast"]) == 0
    return [line.removeprefix("[big] ") for line in capsys.readouterr().out.splitlines()]


@pytest.fixture(params=["", "1"], ids=["compiled", "plain"], autouse=True)
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("JACAROS_PLAIN", request.param)


@pytest.mark.parametrize(
    ("expression", "shown"),
    [
        ("9007199254740993", "9007199254740993"),
        ("-9007199254740993", "-9007199254740993"),
        ("9007199254740993 - 1", "9007199254740992"),
        ("9007199254740993 + 0.5", "9007199254740992"),
        ("1795904057976399127 - 1795904057976399000", "127"),
        ("9007199254740993 * 3", "27021597764222979"),
        ("1795904057976399127 mod 1000", "127"),
        ("-1795904057976399127 mod 1000", "-127"),
        ("1795904057976399127 div 1000000000", "1795904057"),
        ("9007199254740993 mod 0", "NaN"),
        ("9007199254740993 / 2", "4503599627370496"),
        ("math.max(9007199254740993, 9007199254740992)", "9007199254740993"),
        ("18446744073709551615", "18446744073709551615"),
        ("9007199254740992 + 1", "9007199254740992"),
    ],
)
def test_arithmetic_is_exact_between_integers(expression, shown, tmp_path, capsys):
    assert printed(tmp_path, capsys, f"X = {expression}; .print(X)") == [shown]


def test_neighbours_are_different_numbers(tmp_path, capsys):
    clauses = """
        id(9007199254740993). id(9007199254740992).
        +!go(9007199254740992) <- .print(even).
        +!go(9007199254740993) <- .print(odd).
    """
    steps = """
        .findall(X, id(X), Ids); .print(Ids); !go(9007199254740993); !go(9007199254740992);
        if (id(Y) & Y > 9007199254740992) { .print(bigger) };
        if (not id(9007199254740994)) { .print(absent) };
        -id(9007199254740993); .count(id(_), N); .print(N);
        .sort([9007199254740993, 9007199254740994, 9007199254740992, 3], Sorted); .print(Sorted);
        if (.number(9007199254740993)) { .print(number) };
        .term2string(Term, "a(9007199254740993)"); .print(Term)
    """
    ids = "[9007199254740993,9007199254740992]"
    order = "[3,9007199254740992,9007199254740993,9007199254740994]"
    expected = [ids, "odd", "even", "bigger", "absent", "1", order, "number", "a(9007199254740993)"]
    assert printed(tmp_path, capsys, steps, clauses) == expected


def test_products_are_limited_and_other_numbers_are_doubles(tmp_path, capsys):
    steps = "+n(9007199254740993); for (.range(_, 1, 12)) { ?n(X); -+n(X * X) }; ?n(Y); .print(Y)"
    assert printed(tmp_path, capsys, steps) == ["Infinity"]
    for each in (0, -3, 2**53, 2**60, 10**20):
        assert type(number(each)) is float
    assert (type(number(BIG)), number(BIG)) == (int, BIG)
    assert number(10**400) == float("inf")
    assert number(-(10**400)) == float("-inf")


def test_texts_and_records_keep_the_number(tmp_path):
    file = tmp_path / "ids.asl"
    file.write_text("id( 9007199254740993 ).\n")
    assert call(["fmt", str(file)]) == 0
    assert file.read_text() == "id(9007199254740993).\n"
    assert json_value(BIG) == "9007199254740993"
