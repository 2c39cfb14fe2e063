"""Warnings about programs that can be run."""

from typing import NamedTuple

from asl_lab import program

from jacaros.asl.checker import check
from jacaros.asl.checks.actions import KnownActions
from jacaros.asl.diagnostics import Diagnostic


class Signature(NamedTuple):
    minimum: int = 0
    maximum: int | None = None
    suspends: bool = False


STANDARD = {
    ".print": Signature(),
    ".findall": Signature(3, 3),
    ".length": Signature(2, 2),
    ".add_plan": Signature(1, 3),
    ".puts": Signature(1, 2),
    ".fail": Signature(suspends=True),
    ".send": Signature(3, 5, True),
    ".remove_plan": Signature(1, 2),
}
KNOWN = KnownActions(STANDARD, lambda name: name.startswith("own."))


def warnings(text: str) -> list[Diagnostic]:
    return check(program(text), KNOWN)


def codes(text: str) -> list[str]:
    return [warning.code for warning in warnings(text)]


def messages(text: str) -> list[str]:
    return [warning.message for warning in warnings(text)]


def test_a_good_program_has_no_warning():
    assert messages("!g. +!g : p(X) <- .print(X); !h(X). +!h(X). -!h(Y) <- .print(Y). p(1).") == []


def test_an_unknown_internal_action_is_named_with_what_may_be_meant():
    (warning,) = warnings("+!g <- .prnt(a).")
    assert warning.message == "there is no internal action .prnt"
    assert warning.hint == "did you mean .print?"


def test_internal_actions_are_checked_in_rules_terms_and_conditions():
    assert (
        len(
            messages(
                "r(X) :- .one(X). +!g : .two <- .findall(X, .three(X), L); .print(L); if (.four) { .five }."
            )
        )
        == 5
    )


def test_an_atom_with_a_dot_is_no_internal_action():
    assert messages("p(my.Type). +!g <- .print(my.own).") == []
    assert messages("+!g <- my.own(1).") == ["there is no internal action my.own"]


def test_a_goal_without_a_plan_is_named_once_with_what_may_be_meant():
    found = warnings("!paterol. +!patrol <- !paterol; !go(1,2). +!go(X) <- .print(X).")
    assert [(warning.message, warning.hint) for warning in found] == [
        ("no plan for !paterol/0", "did you mean !patrol?"),
        ("no plan for !go/2", "did you mean !go/1?"),
    ]


def test_goals_in_another_namespace_are_other_goals():
    (warning,) = warnings("!m::g. +!g.")
    assert (warning.message, warning.hint) == ("no plan for !m::g/0", "did you mean !g?")


def test_a_handler_or_a_plan_inside_a_plan_counts_as_a_plan():
    assert messages("!g. -!g.") == []
    assert messages("+!g <- !h. { +!h. }") == []
    assert messages("!g. +!h <- +{ +!g }.") == []


def test_plans_for_all_goals_and_added_plans_silence_the_check_of_goals():
    assert messages("!g. +!X <- !X.") == []
    assert messages('!g. +!h <- .add_plan("+!g").') == []
    assert messages("+!h <- !N::g(N).") == []


def test_a_variable_that_occurs_once_may_be_a_slip():
    (warning,) = warnings("+!go(Room) <- move(Rom).")
    assert warning.message == "the variable Rom occurs only once in this plan"
    assert warning.hint == "did you mean Room? Otherwise write _Rom"
    assert messages("r(X) :- q(Y).") == ["the variable Y occurs only once in this rule"]


def test_variables_of_triggers_unnamed_ones_and_those_in_texts_are_left_alone():
    assert messages("+!go(Room)[source(S)] <- move(_Rom, _).") == []
    assert messages('+!g <- p(X); .puts("#{X}").') == []
    assert messages("+!g(X) <- .print(X). { +e(X). +f(Y) <- .print(Y). }") == []


def test_patterns_give_no_warnings():
    for pattern in ("dg(at(_))", "ebdg(at(_))", "smc(at(_),f(_))", "omc(at(_),f(_),m(_))", "bc(at(_))"):
        text = f"!at(1). {{ begin {pattern} }} +!at(X) <- go(X). {{ end }}"
        assert [m for m in messages(text) if "internal action" not in m] == []


def test_warnings_come_in_the_order_of_the_text():
    assert [w.span.line for w in warnings("+!a <- .x.\n+!b <- p(X).\n+!c <- !d.") if w.span] == [1, 2, 3]
