"""Entries of users' files, declared at the fields of dataclasses."""

from dataclasses import dataclass
from typing import Annotated

import pytest

from jacaros.runtime.files.entries import either, flag, number, read, section, text, whole
from jacaros.runtime.files.yaml import Problem, YamlFileError, read_document


@dataclass(frozen=True)
class Wheel:
    radius: Annotated[float, number(0.01, 0.5, "m", "of the tyre")] = 0.03
    width: Annotated[float, number(0.0, 100.0, "cm", "of the tyre", "width_cm", lambda cm: cm / 100)] = 0.02
    driven: Annotated[bool, either("by a motor", "drive", "free", "driven")] = False
    serial: int = 7


@dataclass(frozen=True)
class Cart:
    name: Annotated[str, text("on its door")]
    seats: Annotated[int, whole(1, "with belts")] = 2
    closed: Annotated[bool, flag("whether it has a roof")] = False
    wheel: Annotated[Wheel, section("all four")] = Wheel(0.2, 0.1)


def cart(content: str) -> Cart:
    problems: list[Problem] = []
    found = read(read_document(content, problems, "a cart"), Cart(""))
    if problems:
        raise YamlFileError("cart.yaml", content, problems)
    return found


def test_given_values_replace_the_defaults() -> None:
    assert cart("name: a\nwheel: {width_cm: 5, drive: driven}") == Cart("a", wheel=Wheel(0.2, 0.05, True))
    assert cart("{name: b, seats: 4, closed: true}") == Cart("b", 4, True)


def test_all_mistakes_are_reported_in_one_pass() -> None:
    with pytest.raises(YamlFileError) as told:
        cart("seets: 3\nseats: 0\nclosed: 1\nwheel:\n  radius: 9\n  drive: half\n  serial: 8\n")
    assert str(told.value).splitlines()[:4] == [
        "cart.yaml:1:1: error: a cart has no key 'seets'",
        "    1 | seets: 3",
        "        ^",
        "  = help: did you mean `seats`?",
    ]
    assert [(problem.line, problem.message) for problem in told.value.problems[1:]] == [
        (1, "a cart lacks the key 'name'"),
        (2, "'seats' must be a whole number of at least 1, not 0"),
        (3, "'closed' must be true or false, not 1"),
        (5, "'radius' is 9, but must lie between 0.01 and 0.5"),
        (6, "'drive' is 'half'"),
        (7, "'wheel' has no key 'serial'"),
    ]
