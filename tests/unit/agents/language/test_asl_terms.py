"""Terms and expressions."""

import pytest

from jacaros.agents.language import nodes
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import (
    parse_formula,
    parse_literal,
    parse_literals,
    parse_term,
    parse_trigger,
)
from jacaros.agents.language.lowering import format_term


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("12", 12.0),
        (".5", 0.5),
        ("1.5E-3", 0.0015),
        ("1e3", 1000.0),
        ("-2.5", -2.5),
        ("- -3", 3.0),
        ("+4", 4.0),
    ],
)
def test_numbers(text, value):
    assert parse_term(text) == nodes.Number(value)


@pytest.mark.parametrize(
    ("text", "grouped"),
    [
        ("2-1-1", "((2-1)-1)"),
        ("2**3**2", "(2**(3**2))"),
        ("-X**2", "((-X)**2)"),
        ("2*-3**X", "(2*(-3**X))"),
        ("2*3+4*5 mod 6", "((2*3)+((4*5) mod 6))"),
        ("not a & b | c", "((not (a) & b) | c)"),
        ("not X < 2", "not ((X < 2))"),
        ("a & b & c", "(a & (b & c))"),
        ("a | b & c | d", "(a | ((b & c) | d))"),
        ("X+1 < Y*2 & Z", "(((X+1) < (Y*2)) & Z)"),
        ("X = (a & b)", "(X = (a & b))"),
    ],
)
def test_operators_bind_as_in_the_language(text, grouped):
    assert format_term(parse_term(text)) == grouped


def test_strings_and_quoted_atoms_keep_their_characters():
    assert parse_term(r'"a\nb\"c\td\\"') == nodes.String('a\nb"c\\td\\\\')
    assert parse_term("'my atom'(1)") == nodes.Literal("'my atom'", (nodes.Number(1.0),))
    assert isinstance(parse_term("'a.b'"), nodes.Literal)


def test_every_unnamed_variable_is_a_different_one():
    term = parse_term("f(_, _, _Any, _Any)")
    assert isinstance(term, nodes.Literal)
    names = {argument.name for argument in term.arguments if isinstance(argument, nodes.Variable)}
    assert len(names) == 4
    term = parse_term("f(_12Here, _12There)")
    assert isinstance(term, nodes.Literal)
    assert term.arguments[0] == term.arguments[1] == nodes.Variable("_12")


def test_lists_and_annotations_splice_their_tails():
    assert parse_term("[a|[b,c|T]]") == parse_term("[a,b,c|T]")
    assert parse_term("[|T]") == nodes.ListTerm((), nodes.Variable("T"))
    assert parse_term("[a|[]]") == parse_term("[a]")
    assert format_term(parse_term("p(1)[source(a)[source(b)], t|R]")) == "p(1)[source(a)[source(b)],t|R]"
    assert parse_term("X[a|R]") == nodes.Variable(
        "X", nodes.Annotations((nodes.Literal("a"),), nodes.Variable("R"))
    )


def test_functions_and_namespaces_have_names():
    assert isinstance(parse_term(".length(L)"), nodes.FunctionCall)
    assert isinstance(parse_term(".length(L,N)"), nodes.InternalAction)
    assert isinstance(parse_term("system.time"), nodes.FunctionCall)
    assert isinstance(parse_term("math.abs(1)"), nodes.FunctionCall)
    assert isinstance(parse_term("robot.turn(1)"), nodes.InternalAction)
    assert isinstance(parse_term("robot.turn(1)", functions={"robot.turn": 1}), nodes.FunctionCall)
    assert parse_term("ns::~p") == nodes.Literal("p", negated=True, namespace="ns")
    assert parse_term("N::p") == nodes.Literal("p", namespace=nodes.Variable("N"))
    assert parse_term("ns::X") == nodes.Variable("X", namespace="ns")
    assert parse_term("default::p") == parse_term("::p") == nodes.Literal("p")


@pytest.mark.parametrize(
    ("text", "node"),
    [
        ("{ }", nodes.BodyTerm),
        ("{ +b }", nodes.BodyTerm),
        ("{ +b; +c }", nodes.BodyTerm),
        ("{ -+b }", nodes.BodyTerm),
        ("{ +!g }", nodes.TriggerTerm),
        ("{ -?g(X) }", nodes.TriggerTerm),
        ("{ ^!g[state(S)] }", nodes.TriggerTerm),
        ("{ +!g <- b }", nodes.PlanTerm),
        ("{ +!g <- b. }", nodes.PlanTerm),
        ("{ +b : c }", nodes.PlanTerm),
        ("{ -b <- c }", nodes.PlanTerm),
        ("{ @l +!g }", nodes.PlanTerm),
        ("{ @l +b }", nodes.PlanTerm),
        ("{ h(X) :- b(X) }", nodes.RuleTerm),
        ("{ b(X) }", nodes.BodyTerm),
    ],
)
def test_braces_hold_bodies_triggers_plans_and_rules(text, node):
    assert isinstance(parse_term(text), node)


def test_a_plan_term_may_be_all_variables():
    term = parse_term("{ @L +!T : C <- B }")
    assert isinstance(term, nodes.PlanTerm)
    assert term.plan == nodes.Plan(
        nodes.Variable("L"),
        nodes.Trigger("+", "!", nodes.Variable("T")),
        nodes.Variable("C"),
        nodes.Variable("B"),
    )


def test_nodes_know_their_places():
    term = parse_term("f(a,\n  bc + 1 < X)".replace("bc", "Bc"), "here.asl")
    assert isinstance(term, nodes.Literal)
    relation = term.arguments[1]
    assert relation.span is not None
    assert (relation.span.line, relation.span.column, relation.span.end_column) == (2, 3, 13)
    assert relation.span.file.name == "here.asl"


def test_text_at_run_time_is_refused_with_a_message():
    with pytest.raises(AslError) as refused:
        parse_term("f(X", "<term2string>")
    assert str(refused.value).startswith("<term2string>:1:4: error: unclosed `(`")
    with pytest.raises(AslError):
        parse_term("a b")
    with pytest.raises(AslError):
        parse_term("")
    with pytest.raises(AslError):
        parse_literal("3")


def test_other_entry_points_and_long_chains():
    assert parse_literal("~p(1)[a].") == parse_term("~p(1)[a]")
    assert parse_trigger("-!g(X)[error(E)]").operator == "-"
    assert isinstance(parse_formula("a & not b"), nodes.And)
    assert [literal.functor for literal in parse_literals('p(1), ~q, r("a,b")')] == ["p", "q", "r"]
    assert parse_literals("") == ()
    parse_formula(" & ".join(["a"] * 400))
    parse_term("+".join(["1"] * 251))
    parse_term("[" + ",".join(["1"] * 5000) + "]")


@pytest.mark.whole_stack
def test_what_is_nested_too_deeply_is_refused():
    for text in (
        "(" * 5000,
        "[" * 5000,
        "f(" * 5000,
        "not " * 5000,
        "- " * 5000,
        "{" * 5000,
        "2" + "**2" * 5000,
    ):
        with pytest.raises(AslError):
            parse_term(text)
