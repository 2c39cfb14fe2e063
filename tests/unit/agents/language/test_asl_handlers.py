"""Plans of goals that nothing posts, and actions without the mark of a goal or internal action."""

import pytest
from asl_lab import program

import jacaros.agents.mind.actions.standard  # noqa: F401 - fills the table of internal actions
from jacaros.agents.checks.checker import check
from jacaros.agents.checks.goals import KnownActions
from jacaros.agents.checks.handlers import missing_marks, never_posted
from jacaros.agents.mind.actions.internal_action import STANDARD

KNOWN = KnownActions(STANDARD)


def unused(text: str) -> list[str | None]:
    """Return the help of each failure plan that handles nothing."""
    return [each.help for each in check(program(text), KNOWN) if each.code == "unused-handler"]


@pytest.mark.parametrize(
    ("text", "help_"),
    [
        ("!go_to(3). +!go_to(X) <- drive(X). -!goto(X) <- stop(X).", "did you mean `-!go_to/1`?"),
        ("!go(3). +!go(X) <- drive(X). -!go <- stop.", "did you mean `-!go/1`?"),
        ("!go. +!go <- drive. -!recharge <- stop.", None),
        ("!go. +!go <- drive. -?place(_) <- stop.", None),
    ],
)
def test_a_failure_plan_of_a_goal_that_nothing_posts_is_reported(text, help_):
    assert unused(text) == [help_]


@pytest.mark.parametrize(
    "text",
    [
        "!go. -!go <- stop.",
        "+!begin <- !go. -!go <- stop.",
        "+!go <- drive. -!go <- stop.",
        "+?place(X) <- look(X). -?place(_) <- stop.",
        "+!begin <- ?place(X); drive(X). -?place(_) <- stop.",
        "+!begin <- .send(bob, achieve, go). -!go <- stop.",
        '+!begin <- .term2string(T, "go"); .print(T). -!go <- stop.',
        "+far(G) <- !G. -!go <- stop.",
        "+!begin(G) <- !G. +far <- !begin(go). -!go <- stop.",
        "+!G <- print(G). -!go <- stop.",
        '+!begin <- .add_plan("+!go"). -!go <- stop.',
        "-!m::go <- stop.",
    ],
)
def test_failure_plans_of_goals_that_may_be_posted_are_not_reported(text):
    assert unused(text) == []


def test_a_misspelt_plan_beside_a_right_one_is_reported():
    right = "!start. +!start <- !forward(3). +!forward(N) : N > 3 <- .print(N)."
    assert unused(f"{right} +!forawrd(N) <- .print(N).") == ["did you mean `+!forward`?"]
    failing = right.replace("+!forward(N) : N > 3", "-!forward(N)")
    assert unused(f"{failing} +!forawrd(N) <- .print(N).") == ["did you mean `+!forward`?"]
    assert unused(f"{right} +!backward(N) <- .print(N).") == []
    assert unused(f"{right} +!forawrd(N) <- .print(N). +far <- !forawrd(1).") == []


def test_a_plan_of_another_size_than_the_goal_that_is_posted_is_reported():
    right = "!day(1). +!day(N) <- .wait(10); !day(N + 1)."
    assert unused(f"{right} +!day <- .stopMAS.") == ["did you mean `+!day/1`?"]
    assert unused(f"{right} +!day <- !day(1).") == []
    assert unused(f"{right} +!day <- .stopMAS. +late <- !day.") == []


def test_a_fact_that_is_a_goal_is_reported():
    def facts(text: str) -> list[str | None]:
        return [each.help for each in check(program(text), KNOWN) if each.code == "missing-mark"]

    assert facts("start.\n+!start <- .print(a).") == ["did you mean `!start`?"]
    assert facts("go(1). go(2). +!go(N) <- .print(N).") == ["did you mean `!go`?"]
    assert facts("go(1). +!go(N) : go(N) <- .print(N).") == []
    assert facts("go(1). +go(N) <- .print(N). +!go(N).") == []
    assert facts("go(1). !go(2). +!go(N).") == []
    assert facts("go(1). +!go.") == []
    assert facts("go(1). +!go(N) <- .print(N); !go(N + 1).") == ["did you mean `!go`?"]
    assert facts("go(1). +!go(N) <- .print(N). +far <- !go(2).") == []
    assert facts("go. +!go <- .print(a). +far <- .drop_desire(go).") == ["did you mean `!go`?"]


def test_goals_that_no_agent_posts_are_noted():
    def noted(*texts: str) -> list[str]:
        programs = [program(text) for text in texts]
        return [each.message.split("`")[1] for each in never_posted(programs, KNOWN, lambda _: True)]

    assert noted("!go. +!go. +!rest. +?far(X).", "+!rest(N).") == ["!rest/0", "?far/1", "!rest/1"]
    assert noted("!go. +!go <- .send(bob, achieve, rest).", "+!rest.") == []
    assert noted("!go. +!go. +far(G) <- !G. +!rest.") == []
    assert noted("+!kqml_received(S, tell, C, I). @t[test] +!t. +!m::g.") == []
    assert list(never_posted([program("+!rest.")], KNOWN, lambda _: False)) == []


@pytest.mark.parametrize(
    ("text", "help_"),
    [
        ("!start. +!start <- go. +!go <- .print(go).", "did you mean `!go`?"),
        ("+bumped <- go(3). +!go(N) <- .print(N).", "did you mean `!go`?"),
        ('{ include("$jacaros/a.asl") } +!start <- !use(a); use(b).', "did you mean `!use`?"),
        ("+!start <- wait(3).", "did you mean `.wait`?"),
        ("+!start <- send(bob, tell, ready).", "did you mean `.send`?"),
    ],
)
def test_an_action_that_is_a_goal_or_an_internal_action_is_reported(text, help_):
    library = {"$jacaros/a.asl": "+!use(N) <- !use(N, []). +!use(N, L) <- !use(N)."}
    assert [each.help for each in missing_marks(program(text, library), KNOWN)] == [help_]


@pytest.mark.parametrize(
    "text",
    [
        "!start. +!start <- go.",
        "!go. +!start <- go. +!go <- .print(go).",
        "+!go <- go. -!go <- go.",
        "+!start <- go(3). +!go <- .print(go).",
        "+!start <- .send(bob, achieve, go); go. +!go <- .print(go).",
        '+!start <- send(1); print("x"); time(T); .print(T).',
    ],
)
def test_actions_that_artifacts_may_have_are_not_reported(text):
    assert list(missing_marks(program(text), KNOWN)) == []


def test_an_internal_action_that_is_a_goal_is_one_with_another_mark():
    (found,) = check(program("!start. +!start <- .go(3). +!go(X) <- .print(X)."), KNOWN)
    assert (found.code, found.help) == ("unknown-internal-action", "did you mean `!go`?")


def test_a_number_of_arguments_with_a_failure_plan_of_its_own_is_meant():
    text = "!go. +!go <- !make. +!make <- act. +!make(X) <- act(X)."
    assert unused(text) == ["did you mean `+!make/0`?"]
    assert unused(f"{text} -!make(_) <- stop.") == []
