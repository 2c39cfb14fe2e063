"""Plans as nodes, control statements as actions, and needs."""

import pytest
from asl_lab import belief_texts, errors, parse_plan, plan_texts, program

from jacaros.agents.checks.annotations import wrong_needs
from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import load_program, parse_plans
from jacaros.agents.language.nodes import ByKind


def steps(text: str) -> tuple[nodes.Step, ...]:
    body = program(f"+!g <- {text}.").plans[0].body
    assert isinstance(body, nodes.Body)
    return body.steps


def test_a_program_mixes_clauses_of_all_parts():
    read = program("+!g. p(1). !g. r(X) :- p(X). ~q[a]. !h(2)[x].")
    assert [type(belief).__name__ for belief in read.beliefs] == ["Literal", "Rule", "Literal"]
    assert [goal.functor for goal in read.goals] == ["g", "h"]
    assert len(read.plans) == 1
    plan = program("@l[atomic,prio(2)] +!g(X)[source(S)] : a & b <: c <- d; !e.").plans[0]
    assert isinstance(plan.label, nodes.Literal)
    assert plan.label.functor == "l"
    assert isinstance(plan.context, nodes.And)
    assert plan.goal_condition == nodes.Literal("c")
    assert isinstance(plan.body, nodes.Body)
    assert len(plan.body.steps) == 2
    plan = program("+b.").plans[0]
    assert (plan.label, plan.context, plan.goal_condition) == (None, None, None)
    assert plan.body == nodes.Body()
    first, second = program("@[atomic] +!a <- b. @[atomic] +!c <- d.").plans
    assert isinstance(first.label, nodes.Literal)
    assert isinstance(second.label, nodes.Literal)
    assert first.label.functor != second.label.functor
    assert first.label.annotations is not None


def test_triggers():
    triggers = [
        plan.trigger
        for plan in program("+b. -b. +!g. -!g. +?t. -?t. ^!g[state(S)]. +~b. -!P[error(E)].").plans
    ]
    assert [trigger.operator + trigger.kind for trigger in triggers] == (
        ["+", "-", "+!", "-!", "+?", "-?", "^!", "+", "-!"]
    )
    assert isinstance(triggers[-1].literal, nodes.Variable)


def test_every_kind_of_step():
    read = steps(
        "!g; !!h; ?p(X); ?(a & b); +b; -b; -+b; ++b; --b; +<b; +>b; act(1); .print(X); X = 2; X; f.g(1)"
    )
    assert [type(step).__name__ for step in read] == [
        *["Achieve"] * 2,
        *["Test"] * 2,
        *["BeliefChange"] * 7,
        "ExternalAction",
        "Constraint",
        "Constraint",
        "ExternalAction",
        "Constraint",
    ]
    changes = [step.operator for step in read if isinstance(step, nodes.BeliefChange)]
    assert changes == ["+", "-", "-+", "++", "--", "+<", "+>"]


def test_plans_and_rules_are_added_and_removed():
    added, removed, rule = steps("+{ +!g <- a }; -{ +!g }; +>{ h(X) :- b(X) }")
    assert isinstance(added, nodes.BeliefChange)
    assert isinstance(added.operand, nodes.PlanTerm)
    assert isinstance(removed, nodes.BeliefChange)
    assert isinstance(removed.operand, nodes.PlanTerm)
    assert isinstance(rule, nodes.BeliefChange)
    assert isinstance(rule.operand, nodes.RuleTerm)


def test_control_statements_need_no_semicolon_and_long_chains_are_read():
    read = steps("if (a) { b; } elif (c) { d } else { e } while (f) { g } for (h(X)) { i } j;")
    assert [type(step).__name__ for step in read] == ["If", "While", "For", "ExternalAction"]
    first = read[0]
    assert isinstance(first, nodes.If)
    assert first.otherwise is not None
    assert isinstance(first.otherwise.steps[0], nodes.If)
    text = "if (a) { b } " + "elif (c) { d } " * 50 + "else { e }"
    assert len(steps(text)) == 1


def test_forks_and_groups_are_flat():
    (step,) = steps("!a |&| !b |&| !c ||| !d")
    assert isinstance(step, nodes.Fork)
    assert (step.operator, len(step.branches)) == ("or", 2)
    (inner,) = step.branches[0].steps
    assert isinstance(inner, nodes.Fork)
    assert (inner.operator, len(inner.branches)) == ("and", 3)
    assert len(steps("(a; b); c")) == 3
    (step,) = steps("(a; b) |&| (c; d)")
    assert isinstance(step, nodes.Fork)
    assert [len(branch.steps) for branch in step.branches] == [2, 2]
    first, second = steps("(X + 1) * 2 > 3; (X) = Y")
    assert isinstance(first, nodes.Constraint)
    assert isinstance(second, nodes.Constraint)


def test_what_is_not_a_step_and_what_is_one():
    assert steps("true") == ()
    assert len(steps("true; a; true")) == 1
    (step,) = steps("P")
    assert step == nodes.ExternalAction(nodes.Variable("P"))


def test_a_bare_condition_is_an_action_with_a_warning():
    read, warnings = load_program("main.asl", "+!g <- not a; b & c; ?(not d).")
    body = read.plans[0].body
    assert isinstance(body, nodes.Body)
    first, second, _ = body.steps
    assert isinstance(first, nodes.ExternalAction)
    assert isinstance(second, nodes.ExternalAction)
    assert first.action == nodes.Literal("not", (nodes.Literal("a"),))
    assert second.action == nodes.Literal("&", (nodes.Literal("b"), nodes.Literal("c")))
    assert [warning.help for warning in warnings] == [
        "to test the condition, write `?(not f)`",
        "to test the condition, write `?(a & b)`",
    ]


def test_functions_alone_and_in_conditions():
    (step,) = steps(".length(L)")
    assert step == nodes.Constraint(nodes.InternalAction(".length", (nodes.Variable("L"),)))
    context = program("+!g : .length(L) == 2 <- a.").plans[0].context
    assert isinstance(context, nodes.Relation)
    assert isinstance(context.left, nodes.FunctionCall)


def test_subplans_follow_or_replace_the_final_dot():
    for text in (
        "+!g <- a. { +e <- b. @l +f. }",
        "+!g <- a { +e <- b. @l +f. }",
        "+!g <- a { +e <- b. @l +f. }.",
    ):
        (plan,) = program(text).plans
        assert len(plan.subplans) == 2


def test_comments_and_line_ends_of_any_system_are_read():
    assert belief_texts('/* a\n b */ p(/* x */ 1). // q.\n// r.\ns("// no comment").') == [
        "p(1)",
        's("// no comment")',
    ]
    assert belief_texts("p.\r\nq.\r\n") == ["p", "q"]
    assert errors("p.\r\nq(\r\n")[0].render().splitlines()[1] == "  2 | q("


def test_plans_at_run_time_and_the_same_plan_twice():
    text = "@l +!g(_) : a <- b."
    assert len(plan_texts('{ include("x.asl") } { include("y.asl") }', {"x.asl": text, "y.asl": text})) == 1
    assert parse_plan("+!g <- a.") == parse_plan("+!g <- a")
    assert len(parse_plans("+!g(1) <- a. +!g(2) <- b")) == 2
    assert len(parse_plans("+!g <- a({ b })")) == 1
    assert len(parse_plans("+!g <- a. { +e. +f. }")[0].subplans) == 2


@pytest.mark.parametrize("text", ["p.", "!g.", "+!g <- ", "+!g. p", "{ +!g }"])
def test_only_plans_are_plans(text):
    with pytest.raises(AslError):
        parse_plans(text)


def step(text: str) -> object:
    body = parse_plan(f"+!g <- {text}").body
    assert isinstance(body, nodes.Body)
    (only,) = body.steps
    return only


@pytest.mark.parametrize(
    ("action", "statement"),
    [
        (".if_then_else(p(X), { .print(X) })", "if (p(X)) { .print(X) }"),
        (".if_then_else(p, { a; b }, { })", "if (p) { a; b } else { }"),
        (".foreach(p(X) & X > 1, { +q(X); !g })", "for (p(X) & X > 1) { +q(X); !g }"),
        (".loop(not p, { !g })", "while (not p) { !g }"),
        (".fork(and, { a; b }, { !c })", "(a; b) |&| !c"),
        (".fork(or, { a }, { b }, { c })", "a ||| b ||| c"),
    ],
)
def test_they_mean_the_statements(action, statement):
    assert step(action) == step(statement)


@pytest.mark.parametrize(
    "action", [".foreach(p)", ".foreach(p, q)", ".fork(xor, { a }, { b })", ".fork(and, { a })"]
)
def test_other_forms_are_plain_internal_actions(action):
    assert isinstance(step(action), nodes.Constraint)


def told(program: str) -> list[tuple[str, str | None]]:
    read, _ = load_program("test.asl", program)
    return [(each.message, each.help) for each in wrong_needs(ByKind(*read.plans))]


@pytest.mark.parametrize(
    ("needs", "message", "help"),
    [
        ("needs(lift(2))", "expected a resource", "write names"),
        ("needs(arm), policy(refusse)", "unknown policy `refusse`", "did you mean `refuse`?"),
    ],
)
def test_needs_that_can_never_be_met_are_reported(needs, message, help):
    for written in (f"@a[{needs}] +!g <- b.", f"+!f <- !g[{needs}]."):
        ((found, help),) = told(written)
        assert message in found
        assert help is not None
        assert help in help


def test_needs_that_can_be_met_are_not_reported():
    for needs in ("needs(arm,base)", 'needs("/r1/wheels")'):
        assert not told(f"@a[{needs}, policy(refuse)] +!g <- b.")
