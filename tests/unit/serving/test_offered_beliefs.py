"""Beliefs that callers may see, questions that they may ask, and limits of what they may send."""

import asyncio
from contextlib import suppress
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from serving_lab import Lab, run

from jacaros.agents.language.offers import Offer, Parameter
from jacaros.serving.arguments import data_of, terms_of
from jacaros.serving.callers import Allowance, RequestError


def test_beliefs_are_watched() -> None:
    async def test(lab: Lab) -> None:
        eve, seen = lab.session("eve", "observer"), list[object]()
        assert eve.beliefs("bob", "battery") == [{"level": 80}]
        stop = eve.watch("bob", "battery", seen.append)
        await lab.session().achieve("bob", "deliver", ["p", "office"]).wait()
        await asyncio.sleep(0.1)
        stop()
        lab.mas.agent("bob").replace_belief("battery(3)")
        await asyncio.sleep(1)
        assert seen == [[{"level": 80}], [{"level": 50}]]

    run(test)


def test_questions_are_answered_in_a_view_that_changes_nothing() -> None:
    async def test(lab: Lab) -> None:
        eve = lab.session("eve", "observer")
        assert eve.ask("bob", "double", {"x": 4}) == [{"y": 8}]
        assert eve.ask("bob", "double(4, Y)") == [{"Y": 8}]
        assert eve.ask("bob", "battery(L)") == [{"L": 80}]
        with pytest.raises(RequestError, match=r"takes longer than 0\.1 s"):
            eve.ask("bob", "endless(X)")
        assert eve.ask("bob", "saying(3)") == [{}], "what it prints is not printed"

    assert run(test) == []


def test_a_watched_belief_that_cannot_be_looked_at_keeps_its_last_value() -> None:
    program = "{ offer(belief, b(x)) } n(1). b(X) :- n(X) & (X < 3 | X > 3 & .abolish(n(_)))."

    async def test(lab: Lab) -> None:
        heard: list[Any] = []
        lab.session("eve", "observer").watch("bob", "b", heard.append)
        for number in (5, 2):
            lab.mas.agent("bob").replace_belief(f"n({number})")
            await asyncio.sleep(1)
        assert heard == [[{"x": 1}], [{"x": 2}]]

    run(test, program)


def test_requests_are_limited() -> None:
    now = 0.0
    allowance = Allowance(lambda: now, per_second=10, burst=5)
    for _ in range(5):
        allowance.spend()
    with pytest.raises(RequestError) as error:
        allowance.spend()
    assert error.value.code == "too_many_requests"
    now = 0.1
    allowance.spend()


def test_two_runs_tell_callers_the_same() -> None:
    def told() -> list[str]:
        heard: list[str] = []

        async def test(lab: Lab) -> None:
            anna = lab.session()
            anna.listen(lambda event: heard.append(str({**event, "id": ""})))
            goals = [anna.achieve("bob", "deliver", [str(n), "office"]) for n in range(3)]
            for each in goals:
                await each.wait()

        run(test)
        return heard

    assert told() == told()


_DATA = st.recursive(
    st.none() | st.booleans() | st.integers() | st.floats() | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(max_size=9), inner, max_size=3),
    max_leaves=12,
)
_OFFER = Offer(
    "goal",
    "go",
    tuple(
        Parameter(kind, kind) for kind in ("string", "atom", "number", "integer", "boolean", "list", "any")
    ),
)


@settings(max_examples=500, deadline=None)
@given(st.dictionaries(st.sampled_from([each.name for each in _OFFER.parameters] + ["other"]), _DATA))
def test_any_data_is_an_argument_or_refused(data: dict[str, object]) -> None:
    terms = None
    with suppress(RequestError):  # any other exception is a defect
        terms = terms_of(_OFFER, data)
    if terms is None:
        return
    for name, term in zip([each.name for each in _OFFER.parameters], terms, strict=True):
        if name != "any":
            assert data_of(term) == data[name] or isinstance(data[name], list)
