from fake_context import term

from jacaros.agents.terms.plans import NO_LABEL, PLAN, make_body, trigger
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import TRUE, Annotated, Term, Var, atom, structure


def annotated(value: object, *annotations: Term) -> Term:
    return Annotated(term(value), annotations)


def source(name: str, *nested: Term) -> Term:
    told = structure("source", atom(name))
    return Annotated(told, nested) if nested else told


def test_copies_have_new_variables_and_a_ground_term_is_its_copy(mind):
    first, second, copy = Var("A"), Var("B"), Var("C")
    for action in (".copy_term", ".rename_apart"):
        assert mind.succeeds(action, ("f", first, second, first, 1), copy)
        third = Var("Z")
        assert mind.unify(copy, term(("f", "x", "y", third, 1)))
        assert text(third) == "x"
        assert text(first) == "A"
        assert text(second) == "B"
        copy = Var("D")
    assert mind.result(".copy_term", ("f", 1)) == "f(1)"
    assert not mind.succeeds(".copy_term", ("f", 1), ("f", 2))


def test_add_annot_adds_to_literals_and_lists(mind):
    assert mind.result(".add_annot", "a", source("jomi")) == "a[source(jomi)]"
    assert mind.result(".add_annot", annotated("a", atom("z")), "b") == "a[b,z]"
    assert mind.result(".add_annot", annotated("a", atom("b")), "b") == "a[b]"
    assert not mind.succeeds(".add_annot", "a", source("jomi"), "b")
    pattern = Annotated(atom("a"), (), Var("T"))
    assert mind.result(".add_annot", pattern, "b") == "a[b|T]"
    assert mind.result(".add_annot", ["a", ("f", 1), [("g", 2)]], "x") == "[a[x],f(1)[x],[g(2)[x]]]"
    assert mind.result(".add_annot", [1, Var("X")], "x") == "[1,X]"
    assert not mind.succeeds(".add_annot", "a", "b", "a")
    assert mind.succeeds(".add_annot", "a", "b", annotated("a", atom("b"), atom("c")))


def test_add_nested_source_puts_the_old_sources_inside(mind):
    assert mind.result(".add_nested_source", ("p", 1), "pluto") == "p(1)[source(pluto)]"
    told = annotated(("p", 1), source("venus"))
    assert mind.result(".add_nested_source", told, "pluto") == "p(1)[source(pluto)[source(venus)]]"
    twice = annotated("p", source("a", source("b")), atom("t"))
    assert mind.result(".add_nested_source", twice, "c") == "p[source(c)[source(a)[source(b)]],t]"
    assert (
        mind.result(".add_nested_source", ["a", 1, [("b", 2)]], "c") == "[a[source(c)],1,[b(2)[source(c)]]]"
    )


def test_remove_source_annot_takes_sources_away(mind):
    told = annotated("p", source("a"), source("b", source("c")), atom("t"))
    assert mind.result(".remove_source_annot", told) == "p[t]"
    assert mind.result(".remove_source_annot", annotated("p", source("a"))) == "p"
    assert mind.result(".remove_source_annot", "p") == "p"
    assert mind.result(".remove_source_annot", [annotated("p", source("a")), 1]) == "[p,1]"
    body = make_body([])
    for label, kept in ((atom("l"), "@l "), (NO_LABEL, "")):
        plan = (PLAN, annotated(label, source("bob")), trigger("+!", atom("g")), TRUE, body)
        assert mind.result(".remove_source_annot", plan) == f"{{ {kept}+!g }}"
