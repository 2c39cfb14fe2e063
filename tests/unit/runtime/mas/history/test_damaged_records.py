"""Questions of any text, and records with any fields missing or wrong: an answer or a refusal, never a defect."""

from contextlib import suppress
from random import Random
from typing import Any

import pytest
from guard_story import RECORDS

from jacaros.look.records.records import Record, is_well_formed
from jacaros.look.why.why import explain
from jacaros.runtime.errors import UsageError

QUESTIONS = (
    "stopped", "command", "operation", "+battery(_)", "+alarm", "!patrol(_)", "plan @low", "plan guard.asl:8",
    "belief battery(_)", "waiting", "nothing", "go",
)  # fmt: skip
PIECES = (
    "why", "plan", "belief", "changed", "@low", "+", "-", "!", "?", "alarm(_)", "battery(X", "go(dock)", "(", ")",
    "robot.asl:14", ":", "stopped", "'", '"', "[", "]", "{", "~", "^", "X", "1", "p::q(1)", "+!", "-?", "'a b'(1)",
)  # fmt: skip
WRONG: tuple[Any, ...] = (None, 1, "x", "(", [], {}, [1], {"a": 1}, -1, 1e9)


def damaged(random: Random) -> list[Record]:
    """The records of the story; one in ten has a field less, or another value in it."""
    found: list[Record] = []
    for t, event, data in RECORDS:
        changed = dict(data)
        if random.random() < 0.1:
            name = random.choice(list(changed))
            changed[name] = random.choice(WRONG)
            if random.random() < 0.3:
                del changed[name]
        found.append((t, event, changed))
    return found


@pytest.mark.parametrize("seed", range(5))
def test_damaged_records_are_skipped(seed: int) -> None:
    random = Random(seed)
    for _ in range(20):
        records = damaged(random)
        for question in QUESTIONS:
            with suppress(UsageError):
                assert explain(records, question).text()


def test_any_question_is_answered_or_refused() -> None:
    random = Random(1)
    answered = refused = 0
    for _ in range(1000):
        question = random.choice(("", " ")).join(random.choices(PIECES, k=random.randint(0, 5)))
        try:
            explain(RECORDS, question).text()
            answered += 1
        except UsageError:
            refused += 1
    assert answered > 100
    assert refused > 100


def test_the_records_of_the_story_are_well_formed() -> None:
    assert [record for record in RECORDS if not is_well_formed(record[1], record[2])] == []
