"""Namespaces, includes and functions."""

import pytest
from asl_lab import belief_texts, errors, places, plan_texts, program

from jacaros.agents.language import nodes
from jacaros.agents.language.loader import load_program
from jacaros.agents.language.nodes import shape


def block(clauses: str) -> str:
    return f"{{ begin namespace(m) }} {clauses} {{ end }}"


def test_a_block_gives_its_namespace_to_beliefs_goals_rules_and_plans():
    read = program(block("p(a). r(X) :- p(X) & not q(X) & X > 1. !g(b)."))
    assert belief_texts(block("p(a). r(X) :- p(X) & not q(X) & X > 1.")) == [
        "m::p(a)",
        "m::r(X) :- (m::p(X) & (not (m::q(X)) & (X > 1)))",
    ]
    assert read.goals == (nodes.Literal("g", (nodes.Literal("b"),), namespace="m"),)
    (plan,) = plan_texts(
        block(
            """@l +!g(a)[source(self)] : c(d)
               <- !h(e); ?i(j); +k(l); act(m); if (n) { -o }; .findall(X, p(X), L)."""
        )
    )
    head, body = plan.split(" <- ")
    assert head == "@m::l +!m::g(a)[source(self)] : m::c(d)"
    assert body == "!m::h(e); ?m::i(j); +m::k(l); act(m); if (m::n) { -m::o }; .findall(X,p(X),L)."


def test_some_names_stay_in_the_default_namespace():
    assert plan_texts(block("+b : p(X) = q(X) & m::c = Y <- Z = d.")) == [
        "+m::b : (p(X) = q(X)) & (m::c = Y) <- (Z = d)."
    ]
    assert plan_texts(block("+!g : default::a & ::b & this_ns::c <- !other::d.")) == [
        "+!m::g : a & (m::b & m::c) <- !other::d."
    ]
    assert belief_texts(block("percept. source(x).")) == ["percept", "source(x)"]


def test_this_ns_is_the_name_of_the_namespace():
    assert belief_texts(block("at(this_ns, [this_ns|T], f(this_ns))[in(this_ns)].") + "at(this_ns).") == [
        "m::at(m,[m|T],f(m))[in(m)]",
        "at(default)",
    ]
    assert plan_texts(block("+!g <- X = this_ns.")) == ["+!m::g <- (X = this_ns)."]
    files = {"part.asl": "at(this_ns)."}
    read = program('{ include("part.asl", m) } { include("part.asl", this_ns) }', files)
    assert [str(shape(belief)) for belief in read.beliefs] == [
        str(shape(belief)) for belief in program("m::at(m). at(default).").beliefs
    ]


def test_local_namespaces_cannot_be_named_from_outside():
    files = {"part.asl": "private::a."}
    read = program(
        '{ namespace(private, local) } { include("part.asl") } { include("part.asl", private) } private::b.',
        files,
    )
    namespaces = [belief.namespace for belief in read.beliefs if isinstance(belief, nodes.Literal)]
    assert namespaces[:2] == ["private", "private"]
    assert namespaces[2] != "private"
    files = {"part.asl": "{ namespace(private, local) } private::a. +!g : private::a <- b."}
    read = program('{ include("part.asl") } private::c.', files)
    inside, outside = read.beliefs
    assert isinstance(inside, nodes.Literal)
    assert isinstance(outside, nodes.Literal)
    assert inside.namespace != outside.namespace == "private"
    assert read.plans[0].context == inside


@pytest.mark.parametrize("kind", ["", ", local", ", global"])
def test_a_namespace_directive_without_a_block_puts_nothing_into_the_namespace(kind):
    assert belief_texts(f"{{ namespace(n{kind}) }} b. c.") == ["b", "c"]


def test_blocks_end_and_rules_become_functions():
    text = "{ begin namespace(m) } a. { begin namespace(n) } b. { end } c. { end } d."
    assert belief_texts(text) == ["m::a", "n::b", "m::c", "d"]
    read = program(
        """{ register_function("my.double", 1, "double") }
           double(X, X*2). +!g : my.double(2) > 3 <- Y = my.double(X)+1."""
    )
    assert read.functions == (nodes.RegisteredFunction("my.double", 1, "double"),)
    context = read.plans[0].context
    assert isinstance(context, nodes.Relation)
    assert isinstance(context.left, nodes.FunctionCall)


def test_an_include_stands_at_its_place_in_a_namespace():
    files = {"part.asl": "a. !g."}
    read = program('{ include("part.asl", m) } { include("part.asl", X) }', files)
    assert isinstance(read.beliefs[0], nodes.Literal)
    assert read.beliefs[0].namespace == "m"
    first, second = read.goals
    assert first.namespace == "m"
    assert isinstance(second.namespace, str)
    assert second.namespace not in ("m", "X")
    files = {"part.asl": "b. !h."}
    read = program('a. !g. { include("part.asl") } c. !i.', files)
    assert [goal.functor for goal in read.goals] == ["g", "h", "i"]
    assert belief_texts('a. { include("part.asl") } c.', files) == ["a", "b", "c"]
    asked = []

    def read(path: str, including: str) -> tuple[str, str]:
        asked.append((path, including))
        return f"lib/{path}", '{ include("two.asl") }' if path == "one.asl" else "p."

    load_program("main.asl", '{ include("one.asl") }', read)
    assert asked == [("one.asl", "main.asl"), ("two.asl", "lib/one.asl")]


def test_libraries_have_counterparts_or_give_a_warning():
    read, warnings = load_program("main.asl", '{ include("$jacamo/templates/common-cartago.asl") } p.')
    assert [getattr(each, "head", each).functor for each in read.beliefs] == ["joined", "focused", "p"]
    assert warnings == []
    read, warnings = load_program(
        "main.asl",
        """{ include("$jacamoJar/templates/common-moise.asl") }
           { include("$jacamo/templates/org-obedient.asl") } p.""",
    )
    assert len(read.beliefs) == 1
    (warning,) = warnings
    assert warning.render().startswith("main.asl:1:1: warning: nothing of `$jacamoJar/templates")
    assert "common-moise.asl" in warning.message
    _, warnings = load_program("main.asl", '{ include("$jason/asl/kqmlPlans.asl") }')
    assert warnings == []
    _, warnings = load_program("main.asl", '{ include("$jacamo/templates/mine.asl") }')
    assert [warning.message for warning in warnings] == [
        "unknown library `$jacamo/templates/mine.asl`: nothing is included"
    ]


def test_includes_are_limited_and_not_circular():
    assert places('p.\n{ include("no.asl") }') == [(2, "included file not found: `no.asl`")]
    files = {"one.asl": 'p.\n{ include("one.asl") }'}
    assert places('{ include("one.asl") }', files) == [(2, "file `one.asl` includes itself")]
    files = {f"{number}.asl": f'{{ include("{number + 1}.asl") }}' for number in range(60)}
    (wrong,) = places('{ include("0.asl") }', files)
    assert wrong[1] == "file `40.asl` is included more than 40 levels deep"
    files = {f"{number}.asl": f'{{ include("{number + 1}.asl") }}' * 2 for number in range(30)}
    files["30.asl"] = "p."
    told = {message for _, message in places('{ include("0.asl") }', files)}
    assert told == {"program includes more than 10000 files"}
    files = {"one.asl": "p(1.\n"}
    (error,) = errors('q.\nr.\n{ include("one.asl") }', files)
    assert error.place() == "one.asl:1:4: "


@pytest.mark.parametrize(
    "directive",
    [
        "include(file)",
        "include",
        "namespace",
        "namespace(X)",
        "namespace(a, b)",
        'register_function("x", 1, "y")',
        'register_function(".x", 1, "y")',
        "register_function(1)",
        "nothing(1)",
        "dg(x)",
        "begin",
    ],
)
def test_wrong_directives_are_refused(directive):
    assert len(places(f"{{ {directive} }}")) == 1
