"""The tree as text."""

import pytest
from asl_lab import parse_plan

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import parse_term
from jacaros.agents.language.lowering import format_body, format_plan, format_term

TERMS = [
    "p",
    "~p(1,X)[a,b|T]",
    "ns::p(a)",
    "N::~p",
    '"a\\nb\\"c"',
    "'an atom'(x)",
    "[a,[],[b|T]]",
    "((1+X)*(2**Y))",
    "(7 mod 2)",
    "(-X)",
    "(X > 3)",
    "(X \\== Y)",
    "((a & b) | not (c))",
    "math.max(1,X)",
    ".length(L,N)",
    "{ }",
    "{ .print(h); !g }",
    "{ +!g }",
    "{ @l +!g(X) : (X > 3) & a <- .print(X) }".replace("(X > 3) & a", "(X > 3) & a"),
    "{ h(X) :- (b(X) & (X > 1)) }",
    "{ ((!a) |&| (!b; c)) }",
    "{ if (a & b) { c } else { d } }",
    "{ for (X = 1) { while (a) { } } }",
    "{ +b; -b; -+b; ++b; --b; +<b; +>b; ?q; !!g; X }",
    "{ +{ +!g <- a }; -{ h :- b } }",
]


@pytest.mark.parametrize("text", TERMS)
def test_terms_are_written_as_they_print(text):
    assert format_term(parse_term(text)) == text


@pytest.mark.parametrize("text", TERMS)
def test_terms_read_back_as_the_same_tree(text):
    term = parse_term(text)
    assert parse_term(format_term(term)) == term


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (3.0, "3"),
        (-0.5, "-0.5"),
        (1e10, "10000000000"),
        (1e20, "1.0E20"),
        (1.5e-7, "1.5E-7"),
        (0.1 + 0.2, "0.30000000000000004"),
    ],
)
def test_numbers_print_as_in_the_language(value, text):
    assert format_term(nodes.Number(value)) == text


def test_plans_with_all_parts_have_a_text_and_other_values_none():
    text = "@l[atomic] +!g(X)[source(S)] : a(X) & (X > 1) <: done <- b; !c. { +e <- f. }"
    assert format_plan(parse_plan(text.removesuffix(" { +e <- f. }"))) == text.removesuffix(" { +e <- f. }")
    plan = parse_plan("+!g")
    assert format_plan(plan) == "+!g."
    assert format_body(plan.body) == ""
    with pytest.raises(TypeError):
        format_term(nodes.Node())
