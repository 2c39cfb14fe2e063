"""Warnings about programs that can be run."""

import re

import pytest
from asl_lab import errors, program

from jacaros.agents.checks.checker import Suppressions, check, check_for_run, wanted
from jacaros.agents.checks.goals import KnownActions
from jacaros.agents.language.cursor import is_slip_of
from jacaros.agents.language.diagnostics import Diagnostic, SourceFile
from jacaros.agents.language.loader import read_program
from jacaros.agents.language.nodes import Declaration

STANDARD = {
    ".print": Declaration(),
    ".wait": Declaration(arity=(1, 3)),
    ".findall": Declaration(arity=3),
    ".length": Declaration(arity=2),
    ".add_plan": Declaration(arity=(1, 3), brings_in=True, changes_plans=True),
    ".puts": Declaration(arity=(1, 2)),
    ".fail": Declaration(suspends=True),
    ".send": Declaration(arity=(3, 5), suspends=True, body_only=True, performative=1),
    ".broadcast": Declaration(arity=2, suspends=True, body_only=True, performative=0),
    ".remove_plan": Declaration(arity=(1, 2), changes_plans=True),
}
KNOWN = KnownActions(STANDARD, lambda name: f"write {name}" if name.startswith("my.") else None)


def warnings(text: str) -> list[Diagnostic]:
    return check(program(text), KNOWN)


def codes(text: str) -> list[str]:
    return [warning.code for warning in warnings(text)]


def messages(text: str) -> list[str]:
    return [warning.message for warning in warnings(text)]


MESSAGES = """
unknown internal action `.prnt`; did you mean `.print`?
    +!g <- .prnt(a).
unknown internal action `my.act`; write my.act
    +!g <- my.act(1).
unknown internal action `my.own`; write my.own
    p(my.Type). +!g <- .print(my.own); my.own(1).
no plan for `!paterol/0`; did you mean `!patrol`? | no plan for `!go/2`; did you mean `!go/1`?
    !paterol. +!patrol <- !paterol; !go(1,2). +!go(X) <- .print(X).
no plan for `!m::g/0`; did you mean `!g`?
    !m::g. +!g.
no plan for `!own::shw/0`; did you mean `!own::show`? | no plan for `!m::show/0`; write a plan for it: `+!m::show`
    { begin namespace(own, local) } +!show. !own::shw. { end } !m::show.
no plan for `!assert_tru/1`; write a plan for it: `+!assert_tru`
    @t[test] +!t <- !assert_true(p); !fake_action(go, done); !assert_tru(q).
no plan for `!assert_true/1`; write a plan for it: `+!assert_true`
    +!t <- !assert_true(p).  !t.
variable `Rom` occurs only once in this plan; did you mean `Room`? Otherwise write `_Rom`
    +!go(Room) <- move(Rom).
variable `Y` occurs only once in this rule; if this is intended, write `_Y`
    r(X) :- q(Y).
internal action `.findall` expects 3 arguments, found 2
    +!g <- .findall(a, b).
internal action `.add_plan` expects 1 to 3 arguments, found none
    +!g <- .add_plan.
internal action `.length` expects 2 arguments, found 4
    +!g(L, N) <- .length(L, N, L, N).
function `math.sin` expects 1 argument, found 2
    +!g(X) : math.sin(X, X) <- a.
unknown performative `tel`; did you mean `tell`?
    +!g <- .send(bob, tel, p); .send(bob, tell, p); .send(bob, propose, p).
unknown performative `askone`; did you mean `askOne`?
    +!g <- .send(bob, askone, p).
label annotation `atomc` has no meaning; did you mean `atomic`?
    @a[atomc] +!g. @b[atomic, priority(2), tests] +!h.
label annotation `urgensy` has no meaning; did you mean `urgency`?
    @a[urgensy(3)] +b.
label annotation `achives` has no meaning; did you mean `achieves`?
    @p[achives(ok)] +!g.
goal annotation `achives` has no meaning; did you mean `achieves`?
    +!g <- !g[achives(ok)].
no plan for `!park/0`; write a plan for it: `+!park`
    @p[while(a), cleanup(park)] +!g.
`X` has no value here, so this comparison never holds; to give X a value, write `X = ...`
    +!g <- X == 3; a(X).
`X` has no value here, so this comparison never holds; to give X a value, write `X = ...`
    +!g : X == 3 & p(X) <- a.
`X` cannot be equal to a sum that contains it: variables keep their value; use another variable, as in `NewX = X + 1`
    +!g(X) <- X = X + 1; a(X).
`True` is a variable here, not a value; write `true` in lower case
    +!g <- a(True).
"""


def told(found: Diagnostic) -> str:
    return found.message if found.help is None else f"{found.message}; {found.help}"


@pytest.mark.parametrize(
    "case", re.split(r"\n(?=\S)", MESSAGES.strip()), ids=lambda each: each.split("\n")[1]
)
def test_what_is_reported_of_a_program(case):
    wanted, text = case.split("\n")
    assert " | ".join(map(told, warnings(text))) == wanted


@pytest.mark.parametrize(
    "text",
    [
        "!g. -!g.",
        "+!g <- !h. { +!h. }",
        "!g. +!h <- +{ +!g }.",
        "!g. +!X <- !X.",
        '!g. +!h <- .add_plan("+!g").',
        "+!h <- !N::g(N).",
        "+!go(Room)[source(S)] <- move(_Rom, _).",
        '+!g <- p(X); .puts("#{X}").',
        "+!g(X) <- .print(X). { +e(X). +f(Y) <- .print(Y). }",
        "!g. +!g : p(X) <- .print(X); !h(X). +!h(X). -!h(Y) <- .print(Y). p(1).",
        "@a[urgency(0)] +b. @c[urgency(10), atomic] +d. @e[urgency(2 * 3)] +f.",
        "+!g : p(X) & X > a & x == 3 <- a.",
        "+!g(X) <- X == 3. +!h <- ?p(X); X == 3. +!i <- .findall(X, p(X) & X == 2, _).",
        "+!g <- F = (X == 2); X = 1; ?F.",
        "+!g(X) <- Y = X + 1; a(Y).",
        "!g(1)[every(1000)]. +!g(T) <- !g(3)[within(T), retry(3, 0.5), hard_deadline(T * 2)].",
        "@p[while(ok & not b(3)), within(10), cleanup(g)] +!g.",
        "@p[while(at(Room))] +!g(Room).",
        "@p[achieves(at(R) & not b(3), 100)] +!g(R) <- !g(3)[achieves(ok | b(T), T)].",
        *(f"+!g <- {each}." for each in (".wait(10)", ".wait(0)", ".wait(done)", '.print("at home")')),
    ],
)
def test_other_programs_are_not_reported(text):
    assert messages(text) == []


@pytest.mark.parametrize(
    "text",
    [
        "+!g : not .fail <- a.",
        "+!g <- if (p & .fail) { a }.",
        "+!g <- ?(p | .fail).",
        "r(X) :- p(X) & .fail.",
        "+!g <- while (.fail) { a }.",
    ],
)
def test_actions_that_act_are_not_conditions(text):
    assert codes(text) == ["acting-condition"]


@pytest.mark.parametrize(
    "urgency", ["urgency", "urgency(high)", "urgency(1.5)", "urgency(-1)", "urgency(_)", "urgency(1, 2)"]
)
def test_an_urgency_is_a_non_negative_integer(urgency):
    assert codes(f"@a[{urgency}] +b.") == ["wrong-urgency"]


@pytest.mark.parametrize("pattern", ["dg(at(_))", "ebdg(at(_))", "smc(at(_),f(_))", "omc(at(_),f(_),m(_))"])
def test_variables_of_patterns_are_no_slips(pattern):
    assert "singleton-variable" not in codes(f"!at(1). {{ begin {pattern} }} +!at(X) <- go(X). {{ end }}")


def test_unknown_actions_are_found_wherever_they_are_and_warnings_come_in_order():
    text = "r(X) :- .one(X). +!g : .two <- .findall(X, .three(X), L); .print(L); if (.four) { .five }."
    assert len(messages(text)) == 5
    lines = [w.span.line for w in warnings("+!a <- .x.\n+!b <- p(X).\n+!c <- !d.") if w.span]
    assert lines == [1, 2, 3]


@pytest.mark.parametrize(
    "text",
    [
        "+!g(X) <- a(X). +!g(1) <- b.",
        "+!g(_, Y) : true <- a(Y). +!g(Y, Y) : p <- b(Y).",
        "+p(1). +p(1) : q.",
        "@a[atomic] +!g <- a. @b[priority(3)] +!g <- b.",
        "+!h <- a. { +e <- a. +e <- b. }",
        "+!g[source(bob)] <- a. +!g[source(bob)] <- b.",
    ],
)
def test_a_plan_after_one_for_the_same_events_is_unreachable(text):
    assert codes(text) == ["plan-never-selected"]


@pytest.mark.parametrize(
    "text",
    [
        "+!g(1) <- a. +!g(X) <- b(X).",
        "+!g(X, X) <- a. +!g(X, Y) <- b(X, Y).",
        "+!g : p <- a. +!g <- b.",
        "+!g[source(bob)] <- a. +!g <- b.",
        "+!g[source(S)] <- a(S). +!g <- b.",
        "+!g <- a. -!g <- b. +g <- c. -g <- d. +?g <- e.",
        "+!g <- a. +!m::g <- b. +!~g <- c.",
        "+!g <- a. +!g <- b. +!h <- .remove_plan(l).",
        "select__option(_, _, P, _) :- P = 1. +!g <- a. +!g <- b.",
        "+!X <- a(X). +!g <- b.",
    ],
)
def test_plans_that_may_be_selected(text):
    assert "plan-never-selected" not in codes(text)


def test_capitalised_names_of_facts_are_reported():
    text = "place(Kitchen, 2). same(X, X). any(_, _Y). !go(Hall). +!go(_) : place(_, _) & same(1, 1) & any(1, 2)."
    assert [(each.span.column, each.code) for each in warnings(text) if each.span] == [
        (7, "singleton-variable"),
        (text.index("Hall") + 1, "singleton-variable"),
    ]
    assert "`kitchen`? If any value is meant, write `_Kitchen`" in warnings(text)[0].help


def test_errors_are_skipped_and_a_run_leaves_out_matters_of_style():
    text = "+!a <- b(; .prnt(x); c(Y).\n+!d <- .prnt(Z).\n!missing."
    file = SourceFile("main.asl", text)
    tree, diagnostics = read_program(file)
    found = check(tree, KNOWN, [each for each in diagnostics if each.severity == "error"])
    assert [(each.span.line, each.code) for each in found if each.span] == [
        (2, "unknown-internal-action"),
        (2, "singleton-variable"),
    ]
    text = "+!g <- .prnt(X). +!h <- b(True)."
    assert [each.code for each in check_for_run(program(text), KNOWN)] == ["unknown-internal-action"]


@pytest.mark.parametrize(
    ("text", "left"),
    [
        ("+!g <- a(X).   // jacaros: ignore singleton-variable\n+!h <- a(Y).", ["Y"]),
        ("+!g <- a(X).\n// jacaros: ignore singleton-variable (as in the book)\n@l\n+!h\n  <- a(Y).", ["X"]),
        ("+!g\n  <- b;\n// jacaros: ignore singleton-variable\n a(X);\n c(Z).", ["Z"]),
        ("+!g <- a(X).\n/* jacaros: ignore-file singleton-variable */\n+!h <- a(Y).", []),
        ("// jacaros: ignore unknown-goal, singleton-variable\n+!g <- a(X).", []),
        ("// jacaros: ignore unknown-goal\n+!g <- a(X).", ["X"]),
        ('+!g <- a(X, "// jacaros: ignore singleton-variable").', ["X"]),
    ],
)
def test_comments_switch_warnings_off(text, left):
    found = [each.message.split("`")[1] for each in wanted(warnings(text))]
    assert found == left


def test_only_known_warnings_can_be_switched_off():
    diagnostics = list(wanted(errors("// jacaros: ignore-file missing-body\n+!g <- .")))
    assert [each.code for each in diagnostics] == ["missing-body"]
    (found,) = Suppressions(SourceFile("x", "p. // jacaros: ignore singletons")).unknown
    assert (found.code, found.message) == ("unknown-code", "unknown code `singletons`")


@pytest.mark.parametrize(
    ("written", "meant", "like"),
    [
        ("whlie", "while", True),
        ("wile", "while", True),
        ("whhile", "while", True),
        ("whale", "while", True),
        ("while", "while", False),
        ("which", "while", False),
        ("", "a", True),
    ],
)
def test_slips_are_recognised(written, meant, like):
    assert is_slip_of(written, meant) is like


RETRY = "write the number of retries and a delay in milliseconds, such as `retry(3)` or `retry(3, 500)`"
ACHIEVES = (
    "write a condition and a time in milliseconds, such as `achieves(docked(true))` or "
    "`achieves(docked(true), 2000)`"
)


@pytest.mark.parametrize(
    ("text", "help_"),
    [
        ("!g[every(0)]. +!g.", "write a number of milliseconds, such as `every(1000)`"),
        ("+!g <- !!g[every(-5)].", "write a number of milliseconds, such as `every(1000)`"),
        ("+!g <- !g[within(abc)].", "write a number of milliseconds, such as `within(5000)`"),
        ("+!g <- !g[within(1, 2)].", "write a number of milliseconds, such as `within(5000)`"),
        ("@p[within(-1)] +!g.", "write a number of milliseconds, such as `within(5000)`"),
        ("+!g <- !g[retry(0)].", RETRY),
        ("+!g <- !g[retry(3, -1)].", RETRY),
        ("+!g <- ?g[every(100)].", "write it at a goal that asks: `!ask[within(5000)]`"),
        ("@p[retry(3)] +!g.", "write it at the goal: `!g[retry(3)]`"),
        ("+!g <- !g[while(g)].", "write it in the label of a plan: `@p[while(ready)] +!g <- ...`"),
        ("@p[cleanup(3)] +!g.", "write one goal, such as `cleanup(park)`"),
        ("@p[while(a, b)] +!g.", "write one condition, such as `while(battery(B) & B > 20)`"),
        ("+!g <- !g[achieves].", ACHIEVES),
        ("+!g <- !g[achieves(ok, soon)].", ACHIEVES),
        ("+!g <- !!g[achieves(ok, -1)].", ACHIEVES),
        ("@p[achieves(5)] +!g.", ACHIEVES),
        ("+!g <- ?g[achieves(ok)].", "write it at a goal that asks: `!ask[within(5000)]`"),
    ],
)
def test_annotations_that_act_are_valid_and_at_their_places(text, help_):
    (found,) = warnings(text)
    assert (found.code, found.help) == ("wrong-supervision", help_)


@pytest.mark.parametrize(("time", "more"), [("2", "2000"), ("0.5", "500")])
def test_a_wait_that_was_probably_meant_in_seconds_is_noted(time, more):
    [note] = warnings(f"+!g <- .wait({time}).")
    assert (note.severity, note.message) == ("note", f"`.wait({time})` waits for {time} ms")
    assert note.help == f"for {time} s write `.wait({more})`"
    assert check_for_run(program(f"+!g <- .wait({time})."), KNOWN) == []
