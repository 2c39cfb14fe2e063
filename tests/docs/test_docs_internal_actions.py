"""Every internal action and every function has an entry, which agrees with the registry."""

import math
import re
from collections.abc import Iterator
from typing import NamedTuple

import pytest
from pages import ROOT

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.terms.functions import ARITIES

FOLDER = ROOT / "docs" / "reference" / "internal_actions"
FUNCTIONS = FOLDER / "functions.md"
SEVERAL_ANSWERS, ACTS, NOT_IN_CONTEXTS = "*several answers*", "*acts", "not in contexts*"


class Entry(NamedTuple):
    """The entry of an internal action or a function, a section or a row of a table in one.

    Attributes:
        name: the name.
        head: the forms of its call, and what else the registry says.
        text: its section.
        page: the file.
    """

    name: str
    head: str
    text: str
    page: str


def entries(pattern: str) -> Iterator[Entry]:
    for page in sorted(FOLDER.glob(pattern)):
        if page.name == "index.md":
            continue
        for part in page.read_text(encoding="utf-8").split("\n## ")[1:]:
            title, _, text = part.partition("\n")
            rows = re.findall(r"^\| (`([.\w]+).*?) \|", text, re.MULTILINE)
            if title[0].isupper():
                yield from (Entry(name, head, text, page.name) for head, name in rows)
            else:
                yield Entry(title, text.strip().partition("\n\n")[0].replace("\n", " "), text, page.name)


ACTIONS = [entry for entry in entries("*.md") if entry.page != FUNCTIONS.name]
OF_FUNCTIONS = list(entries(FUNCTIONS.name))


def calls(entry: Entry) -> list[int]:
    """How many arguments the forms of the call in an entry have; -1 for any number of them."""
    found = []
    for form in re.findall(r"`([^`]+)`", entry.head):
        assert re.fullmatch(re.escape(entry.name) + r"(\(.*\))?", form), f"{entry.name}: {form}"
        inside = form.removeprefix(entry.name).strip("()")
        words = [word.strip() for word in inside.split(",")] if inside else []
        found.append(len(words))
        if "..." in words:
            found[-1:] = [len(words) - 1, -1]
    return found


def limits(entry: Entry) -> tuple[float, float]:
    """Fewest and most arguments."""
    numbers = calls(entry)
    return min(n for n in numbers if n >= 0), math.inf if -1 in numbers else max(numbers)


def test_every_internal_action_has_one_entry() -> None:
    assert sorted(entry.name for entry in ACTIONS) == sorted(STANDARD)


def test_every_function_has_one_entry() -> None:
    assert sorted(entry.name for entry in OF_FUNCTIONS) == sorted(ARITIES)


@pytest.mark.parametrize("entry", ACTIONS, ids=lambda entry: entry.name)
def test_an_entry_says_what_the_registry_says(entry: Entry) -> None:
    action = STANDARD[entry.name]
    most = math.inf if action.maximum is None else action.maximum
    assert limits(entry) == (action.minimum, most)
    assert (SEVERAL_ANSWERS in entry.head) == action.backtracks
    assert (ACTS in entry.head) == action.suspends
    assert (NOT_IN_CONTEXTS in entry.head) == action.body_only


@pytest.mark.parametrize("entry", OF_FUNCTIONS, ids=lambda entry: entry.name)
def test_an_entry_of_a_function_has_its_arguments(entry: Entry) -> None:
    assert limits(entry) == ARITIES[entry.name]


@pytest.mark.parametrize("entry", ACTIONS + OF_FUNCTIONS, ids=lambda entry: entry.name)
def test_an_entry_has_an_example_of_it(entry: Entry) -> None:
    programs = re.findall(r"^```agentspeak .*?$(.*?)^```$", entry.text, re.MULTILINE | re.DOTALL)
    assert any(entry.name in program for program in programs)
    assert re.search(r"^```(output|errors)$", entry.text, re.MULTILINE)
