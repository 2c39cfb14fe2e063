"""Warnings about programs that can be run."""

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
    ".wait": Declaration(arity=(1, 3), awaits=True),
    ".findall": Declaration(arity=3),
    ".length": Declaration(arity=2),
    ".add_plan": Declaration(arity=(1, 3), brings_in=True, changes_plans=True),
    ".puts": Declaration(arity=(1, 2)),
    ".fail": Declaration(suspends=True),
    ".drop_desire": Declaration(arity=1, suspends=True),
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


def test_an_unknown_internal_action_is_reported_wherever_it_is():
    (warning,) = warnings("+!g <- .prnt(a).")
    assert warning.message == "unknown internal action `.prnt`"
    assert warning.help == "did you mean `.print`?"
    assert (
        len(
            messages(
                "r(X) :- .one(X). +!g : .two <- .findall(X, .three(X), L); .print(L); if (.four) { .five }."
            )
        )
        == 5
    )
    assert messages("p(my.Type). +!g <- .print(my.own).") == []
    assert messages("+!g <- my.own(1).") == ["unknown internal action `my.own`"]
    (warning,) = warnings("+!g <- my.act(1).")
    assert warning.help == "write my.act"


def test_a_goal_without_a_plan_is_reported_once_with_a_suggestion():
    found = warnings("!paterol. +!patrol <- !paterol; !go(1,2). +!go(X) <- .print(X).")
    assert [(warning.message, warning.help) for warning in found] == [
        ("no plan for `!paterol/0`", "did you mean `!patrol`?"),
        ("no plan for `!go/2`", "did you mean `!go/1`?"),
    ]
    (warning,) = warnings("!m::g. +!g.")
    assert (warning.message, warning.help) == ("no plan for `!m::g/0`", "did you mean `!g`?")
    local = "{ begin namespace(own, local) } +!show. !own::shw. { end }"
    inside, outside = warnings(f"{local} !m::show.")
    assert (inside.message, inside.help) == ("no plan for `!own::shw/0`", "did you mean `!own::show`?")
    assert (outside.message, outside.help) == ("no plan for `!m::show/0`", "write a plan for it: `+!m::show`")


def test_a_failure_plan_alone_is_not_enough_beside_a_plan_for_other_arguments():
    (warning,) = warnings("!go. +!go(_) <- .print(a). -!go <- .print(b).")
    assert (warning.message, warning.help) == ("no plan for `!go/0`", "did you mean `!go/1`?")


def test_every_kind_of_plan_silences_the_check_of_goals():
    assert messages("!g. -!g.") == []
    assert messages("+!g <- !h. { +!h. }") == []
    assert messages("!g. +!h <- +{ +!g }.") == []
    assert messages("!g. +!X <- !X.") == []
    assert messages('!g. +!h <- .add_plan("+!g").') == []
    assert messages("+!h <- !N::g(N).") == []
    assert messages("@t[test] +!t <- !assert_true(p); !fake_action(go, done); !assert_tru(q).") == [
        "no plan for `!assert_tru/1`"
    ]
    assert messages("+!t <- !assert_true(p).  !t.") == ["no plan for `!assert_true/1`"]


def test_a_variable_that_occurs_once_in_a_text_may_be_a_slip():
    (warning,) = warnings("+!go(Room) <- move(Rom).")
    assert warning.message == "variable `Rom` occurs only once in this plan"
    assert warning.help == "did you mean `Room`? Otherwise write `_Rom`"
    assert {each.help for each in warnings("+!go : at(HomeX, HomeY, X1, X2).")} == {
        f"if this is intended, write `_{name}`" for name in ("HomeX", "HomeY", "X1", "X2")
    }
    assert messages("r(X) :- q(Y).") == ["variable `Y` occurs only once in this rule"]
    assert messages("+!go(Room)[source(S)] <- move(_Rom, _).") == []
    assert messages('+!g <- p(X); .puts("#{X}").') == []
    assert messages("+!g(X) <- .print(X). { +e(X). +f(Y) <- .print(Y). }") == []
    for pattern in ("dg(at(_))", "ebdg(at(_))", "smc(at(_),f(_))", "omc(at(_),f(_),m(_))", "bc(at(_))"):
        text = f"!at(1). {{ begin {pattern} }} +!at(X) <- go(X). {{ end }}"
        assert [m for m in messages(text) if "internal action" not in m] == []
    assert [w.span.line for w in warnings("+!a <- .x.\n+!b <- p(X).\n+!c <- !d.") if w.span] == [1, 2, 3]
    assert messages("!g. +!g : p(X) <- .print(X); !h(X). +!h(X). -!h(Y) <- .print(Y). p(1).") == []


@pytest.mark.parametrize(
    ("text", "message", "help"),
    [
        ("+!g <- .findall(a, b).", "internal action `.findall` expects 3 arguments, found 2", None),
        ("+!g <- .add_plan.", "internal action `.add_plan` expects 1 to 3 arguments, found none", None),
        ("+!g <- .length(L, N, L, N).", "internal action `.length` expects 2 arguments, found 4", None),
        ("+!g(X) : math.sin(X, X) <- a.", "function `math.sin` expects 1 argument, found 2", None),
    ],
)
def test_wrong_numbers_of_arguments(text, message, help):
    (found,) = [each for each in warnings(text) if each.code == "wrong-arguments"]
    assert (found.message, found.help) == (message, help)


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


def test_misspelt_performatives_and_annotations_are_reported():
    assert codes("+!g <- .send(bob, tel, p); .send(bob, tell, p); .send(bob, propose, p).") == [
        "unknown-performative"
    ]
    assert warnings("+!g <- .send(bob, askone, p).")[0].help == "did you mean `askOne`?"
    assert codes("@a[atomc] +!g. @b[atomic, weight(2), tests] +!h.") == ["misspelt-annotation"]
    wrong = ["urgency", "urgency(high)", "urgency(1.5)", "urgency(-1)", "urgency(_)", "urgency(1, 2)"]
    assert [codes(f"@a[{each}] +b.") for each in wrong] == [["wrong-urgency"]] * len(wrong)
    assert codes("@a[urgency(0)] +b. @c[urgency(10), atomic] +d. @e[urgency(2 * 3)] +f.") == []
    assert codes("@a[urgensy(3)] +b.") == ["misspelt-annotation"]


@pytest.mark.parametrize(
    "text",
    [
        "+!g(X) <- a(X). +!g(1) <- b.",
        "+!g(_, Y) : true <- a(Y). +!g(Y, Y) : p <- b(Y).",
        "+p(1). +p(1) : q.",
        "@a[atomic] +!g <- a. @b[weight(3)] +!g <- b.",
        "+!h <- a. { +e <- a. +e <- b. }",
        "+!g(X) : p(X) <- a(X). +!g(Y) : p(Y) & q <- b(Y).",
        "+!g : p(X) & X > 3 <- a(X). +!g : p(X) & X >= 5 <- b(X).",
        "+!g(X) : X > 3 <- a(X). +!g(Y) : 5 == Y <- b(Y).",
        "+!g : p(_) & not q(_) <- a. +!g : not q(_) & p(X) & r <- b(X).",
        "+!g : p | q <- a. +!g : q & r <- b.",
        "+!g : p <- a. +!g : p & q | p & r <- b.",
        "+b(X) : p(Y) & not q(X, Y) <- a(X, Y). +b(Z) : p(Y) & not q(Z, Y) & r <- b(Z).",
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
        "+!g : p & q <- a. +!g : p <- b.",
        "+!g(X) : p(X) <- a(X). +!g(Y) : p(X) <- b(X, Y).",
        "+!g : p(X) & X > 3 <- a(X). +!g : p(X) & X > 2 <- b(X).",
        "+!g : not p(Y) <- a. +!g : q(Y) & not p(Y) <- b.",
        "+!g(X) : not p(X) <- a(X). +!g(home) : not p(home) <- b.",
        "+!g : .random(X) & X < 3 <- a. +!g : .random(X) & X < 3 <- b.",
        "+!g(X, X) : p <- a(X). +!g(X, Y) : p <- b(X, Y).",
        "+!g[source(S)] : p(S) <- a. +!g[source(S)] : p(S) & q <- b.",
        "+!g : p <- a. +!g : q(X) & X \\== p <- b.",
    ],
)
def test_plans_that_may_be_selected(text):
    assert "plan-never-selected" not in codes(text)


@pytest.mark.parametrize(
    "context",
    [
        "false",
        "p & false",
        "not true",
        "2 > 3",
        "p(X) & q & not p(X)",
        "not p & p",
        "p(X) & X == a & X == b",
        'p(X) & X = 1 & X == "1"',
        "p(X) & X < 3 & X > 5",
        "p(X) & 3 > X & X >= 3",
        "p(X) & X == 3 & X > 5",
        "p(X) & X == a & X \\== a",
        "p(X) & X < 3 & not X < 4",
        "p(X) & q(Y) & X == Y & X \\== Y",
        "home == dock",
        "p(X) & X \\== X",
        "p & not p | q & false",
    ],
)
def test_conditions_that_contradict_themselves(context):
    assert "context-never-true" in codes(f"+!g : {context} <- a.")


@pytest.mark.parametrize(
    "context",
    [
        "p(_) & not p(_)",
        "p & (not p | q)",
        "p(X) & not p(Y) & q(Y)",
        "p(X) & not q(X)",
        "p(X) & X \\== a & X \\== b",
        "p(X) & X >= 3 & X <= 3",
        "p(X) & X > 3 & not X > 5",
        "p(X) & X > 3 & X > 5 & X \\== 7 & X \\== 8",
        "p(X) & X == a & X > 5",
        "p & not p | q",
        "p(X)[source(S)] & not p(X) & q(S)",
        "not false",
    ],
)
def test_conditions_that_may_hold(context):
    assert "context-never-true" not in codes(f"+!g : {context} <- a.")


def test_conditions_of_rules_and_statements_that_contradict_themselves_are_reported():
    assert codes("low :- p(X) & X < 3 & X > 5.") == ["context-never-true"]
    assert (
        codes("+!g : p(X) <- while (X > 3 & X < 3) { a }; if (X == a & X == b) { c }.")
        == ["context-never-true"] * 2
    )
    assert codes("never :- false. +!g <- if (false) { a }; if (1 > 2) { a }; while (true) { b }.") == []


def test_comparing_an_atom_or_a_variable_without_a_value_is_reported():
    assert codes("+!g <- X == 3; a(X).") == ["comparison-without-value"]
    assert codes("+!g : X == 3 & p(X) <- a.") == ["comparison-without-value"]
    assert codes("+!g : x > 3 <- a.") == ["ordered-atom"]
    assert codes("+!g : p(X) <- if (2*X <= limit) { a }.") == ["ordered-atom"]
    assert codes("+!g : p(X) & X > a & x == X <- a.") == []
    assert codes("+!g(X) <- X == 3. +!h <- ?p(X); X == 3. +!i <- .findall(X, p(X) & X == 2, _).") == []
    assert codes("+!g <- F = (X == 2); X = 1; ?F.") == []
    assert codes("+!g(X) <- X = X + 1; a(X).") == ["changed-variable"]
    assert codes("+!g(X) <- Y = X + 1; a(Y).") == []


def test_capitalised_names_and_constants_of_python_are_reported():
    text = "place(Kitchen, 2). same(X, X). any(_, _Y). !go(Hall). +!go(_) : place(_, _) & same(1, 1) & any(1, 2)."
    assert [(each.span.column, each.code) for each in warnings(text) if each.span] == [
        (7, "singleton-variable"),
        (text.index("Hall") + 1, "singleton-variable"),
    ]
    assert "`kitchen`? If any value is meant, write `_Kitchen`" in warnings(text)[0].help
    (found,) = warnings("+!g <- a(True).")
    assert (found.code, found.help) == ("capital-constant", "write `true` in lower case")


def test_an_atom_in_the_place_of_an_unused_variable_is_reported():
    (found,) = warnings("+!say(Text) <- .print(text).")
    assert (found.code, found.help) == ("singleton-variable", "did you mean `Text`?")
    assert warnings("+!say(Text) <- .print(Text, text).") == []
    assert warnings("+state(State) <- .print(state).") == []


def test_a_text_in_the_place_of_a_goal_is_reported():
    text = '+!g <- .drop_desire("watch").'
    (found,) = warnings(text)
    assert (found.code, found.help) == ("wrong-arguments", "write `watch` without quotes")
    assert found.span is not None
    assert found.span.column == text.index('"') + 1
    assert warnings("+!g <- .drop_desire(watch).") == []


def test_errors_are_skipped_and_a_run_leaves_out_matters_of_style():
    text = "+!a <- b(; .prnt(x); c(Y).\n+!d <- .prnt(Z).\n!missing."
    file = SourceFile("main.asl", text)
    tree, diagnostics = read_program(file)
    found = check(tree, KNOWN, [each for each in diagnostics if each.severity == "error"])
    assert [(each.span.line, each.code) for each in found if each.span] == [
        (2, "unknown-internal-action"),
        (2, "singleton-variable"),
    ]
    text = "+!g <- .prnt(X). -!g : p <- a. +!h <- b(True)."
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


def test_only_known_warnings_can_be_switched_off_and_narrow_handlers_are_noted():
    diagnostics = list(wanted(errors("// jacaros: ignore-file missing-body\n+!g <- .")))
    assert [each.code for each in diagnostics] == ["missing-body"]
    (found,) = Suppressions(SourceFile("x", "p. // jacaros: ignore singletons")).unknown
    assert (found.code, found.message) == ("unknown-code", "unknown code `singletons`")
    (found,) = warnings("+!g <- a. -!g : p <- a. -!g : q <- a.")
    assert (found.severity, found.code) == ("note", "narrow-handler")
    assert codes("+!g <- a. -!g : p <- a. -!g <- b.") == []
    assert codes("+!g <- a. -!g : p <- a. -!G <- b(G).") == []


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
        ("+!g <- !g[while(g)].", "write it in the label of a plan: `@p[while(g)] +!g <- ...`"),
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


@pytest.mark.parametrize(
    ("text", "help_"),
    [
        ("@a[urgent(10)] +b.", "did you mean `urgency(10)`?"),
        ("@a[need(wheels)] +b.", "did you mean `needs(wheels)`?"),
        ("@a[timeout(500)] +!g.", "did you mean `within(500)`?"),
        ("@a[retries(3)] +!g.", "write it at the goal: `!g[retry(3)]`"),
        ("!g[timeout(500)]. +!g.", "did you mean `within(500)`?"),
        ("+!g <- !g[resources(a, b)].", "did you mean `needs(a,b)`?"),
        ("+!g <- !g[urgent(3)].", "write it in the label of a plan: `@p[urgency(3)] +!g <- ...`"),
    ],
)
def test_other_words_for_annotations_are_reported(text, help_):
    (found,) = [each for each in warnings(text) if each.code != "loop-without-wait"]
    assert (found.code, found.help) == ("misspelt-annotation", help_)


@pytest.mark.parametrize(
    ("text", "help_"),
    [
        ("+!go[sender(S)] <- .print(S).", "did you mean `source(S)`?"),
        ("-!go[failure_reason(R)] <- .print(R). +!go.", "did you mean `env_failure_reason(R)`?"),
        ("-!go[error_message(T)] <- .print(T). +!go.", "did you mean `error_msg(T)`?"),
        ("+!go <- open[artifact(door)].", "did you mean `artifact_name(door)`?"),
    ],
)
def test_other_words_for_annotations_of_events_and_actions_are_reported(text, help_):
    (found,) = warnings(text)
    assert (found.code, found.help) == ("misspelt-annotation", help_)
    assert codes(f"!go[sender(1), failure_reason(2), error_message(3)]. artifact(door). {text}") == []


@pytest.mark.parametrize(
    "text",
    [
        "!g[deadline(3)]. +!g[deadline(P)] <- .print(P).",
        "@a[deadline(2)] +!g. select__option(_, _, P, _) :- P = 1.",
        "@a[urgent] +b. @c[deadline] +d.",
        "@t[test, timeout(500)] +!t.",
    ],
)
def test_annotations_that_the_program_reads_may_have_any_name(text):
    assert codes(text) == []


def test_labels_are_looked_at_and_valid_annotations_that_act_are_not_reported():
    assert codes("!g(1)[every(1000)]. +!g(T) <- !g(3)[within(T), retry(3, 0.5), hard_deadline(T * 2)].") == []
    assert codes("@p[while(ok & not b(3)), within(10), cleanup(g)] +!g.") == []
    assert codes("@p[while(a & not a)] +!g.") == ["context-never-true"]
    assert codes("@p[while(a), cleanup(park)] +!g.") == ["unknown-goal"]
    assert codes("@p[while(at(Room))] +!g(Room).") == []
    assert codes("@p[achieves(at(R) & not b(3), 100)] +!g(R) <- !g(3)[achieves(ok | b(T), T)].") == []
    assert codes("!g[achieves(a & not a)]. +!g <- !g[achieves(false)].") == ["context-never-true"] * 2
    assert codes("+!g <- !g[achives(ok)].") == codes("@p[achives(ok)] +!g.") == ["misspelt-annotation"]


@pytest.mark.parametrize(
    ("step", "message", "help"),
    [
        (".wait(2)", "`.wait(2)` waits for 2 ms", "for 2 s write `.wait(2000)`"),
        (".wait(0.5)", "`.wait(0.5)` waits for 0.5 ms", "for 0.5 s write `.wait(500)`"),
        (
            ".print('at home')",
            "`'at home'` is an atom, which is printed with its quotes",
            'write a text as `"at home"`',
        ),
    ],
)
def test_a_value_that_was_probably_meant_otherwise_is_noted(step, message, help):
    [note] = warnings(f"+!g <- {step}.")
    assert (note.severity, note.message, note.help) == ("note", message, help)
    assert check_for_run(program(f"+!g <- {step}."), KNOWN) == []


@pytest.mark.parametrize(
    "step", [".wait(10)", ".wait(0)", ".wait(done)", '.print("at home")', "go('at home')"]
)
def test_other_values_are_not_noted(step):
    assert warnings(f"+!g <- {step}.") == []


@pytest.mark.parametrize(
    "text",
    [
        "+!go <- +fetched; .wait({+fetched}).",
        "+!go <- !fetch; .wait({+done(_)}, 500). +!fetch <- -+done(3).",
        "+!go <- !fetch; .wait({+fetched}). +!fetch <- !lift. +!lift : p <- +fetched. +!lift <- +fetched.",
        "+!go <- if (p) { +fetched }; .wait({+fetched}). +far : fetched <- .print(a).",
    ],
)
def test_a_wait_for_an_event_that_the_plan_has_caused_is_reported(text):
    assert codes(text) == ["event-never-happens"]


@pytest.mark.parametrize(
    "text",
    [
        "+!go <- !!fetch; .wait({+fetched}). +!fetch <- +fetched.",
        "+!go <- .wait({+fetched}); +fetched.",
        "+!go <- +fetched; .wait({+fetched}). +far <- +fetched.",
        "+!go <- !fetch; .wait({+fetched}). +far <- !fetch. +!fetch <- +fetched.",
        "+!go <- +fetched; .send(bob, tell, fetched); .wait({+fetched}).",
        "+!go <- +fetched; .wait({-fetched}).",
        "+!go <- +fetched; .wait(fetched).",
        "+!go <- .wait({+fetched}).",
    ],
)
def test_waits_for_events_that_may_come_are_not_reported(text):
    assert "event-never-happens" not in codes(text)
