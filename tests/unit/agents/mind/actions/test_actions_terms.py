"""Internal actions on terms, their types, and strings."""

import pytest
from fake_context import term

from jacaros.agents.mind.actions.internal_action import ActionError, WrongArguments
from jacaros.agents.mind.actions.terms import replace_all
from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.plans import NO_LABEL, PLAN, RULE, make_body, step, trigger
from jacaros.agents.terms.text import text
from jacaros.agents.terms.values import (
    ACTION,
    ARITHMETIC,
    TRUE,
    Annotated,
    String,
    Term,
    Var,
    atom,
    functor,
    make_list,
    structure,
)


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


ATOM = term("a")
NEGATED = functor("a", 0, negated=True)
ELSEWHERE = atom("a", namespace="ns")
ANNOTATED = Annotated(atom("a"), (atom("b"),))
STRUCTURE = term(("f", 1))
NEGATED_STRUCTURE = (functor("f", 1, negated=True), 1.0)
LIST = term([1])
SUM = (functor("+", 2, kind=ARITHMETIC), Var("X"), 1.0)
CALL = (functor(".print", 1, kind=ACTION), atom("a"))
BODY = make_body([step("!", atom("g"))])
CLAUSE = (RULE, atom("h"), atom("b"))

EXAMPLES: list[tuple[Term, str]] = [
    (1.0, "number ground"),
    (SUM, "number"),
    (ATOM, "atom literal ground"),
    (ELSEWHERE, "atom literal ground"),
    (NEGATED, "literal structure ground"),
    (ANNOTATED, "literal structure ground"),
    (STRUCTURE, "literal structure ground"),
    (NEGATED_STRUCTURE, "literal structure ground"),
    (term(("f", Var("X"))), "literal structure"),
    (CALL, "literal structure ground"),
    (String("s"), "string ground"),
    (LIST, "list structure ground"),
    (term([]), "list structure ground"),
    (make_list([1.0], Var("T")), "list structure"),
    (SetValue(), "set ground"),
    (MapValue(), "map ground"),
    (QueueValue(), "queue ground"),
    (CLAUSE, "literal structure rule ground"),
    (BODY, "literal structure plan ground"),
    (Var("X"), "free"),
]


@pytest.mark.parametrize(("value", "types"), EXAMPLES)
def test_type_gives_every_type_in_order(mind, value, types):
    kind = Var("T")
    assert mind.instances(".type", value, kind, of=kind) == types.split()


@pytest.mark.parametrize(("value", "types"), EXAMPLES)
@pytest.mark.parametrize("kind", ["number", "atom", "literal", "string", "list", "structure", "ground"])
def test_each_type_has_its_test(mind, value, types, kind):
    holds = kind in types.split()
    assert mind.succeeds(f".{kind}", value) is holds
    assert mind.succeeds(".type", value, kind) is holds


def test_the_empty_list_is_not_an_atom_and_internal_actions_are_calls(mind):
    assert not mind.succeeds(".type", 1, "integer")
    assert not mind.succeeds(".atom", [])
    assert not mind.succeeds(".literal", [])
    assert mind.succeeds(".internal_action", CALL)
    assert not mind.succeeds(".internal_action", ("print", "a"))
    assert not mind.succeeds(".internal_action", Var("X"))


# .substring


def test_substring_tests_for_a_part_and_a_given_place(mind):
    assert mind.succeeds(".substring", String("b"), String("abc"))
    assert not mind.succeeds(".substring", String("x"), String("abc"))
    assert mind.succeeds(".substring", ("a", 10), ("b", "t1", ("a", 10)))
    assert mind.succeeds(".substring", String(""), String(""))
    assert mind.succeeds(".substring", String("a"), String("bab"), 1)
    assert not mind.succeeds(".substring", String("a"), String("bab"), 0)
    assert mind.succeeds(".substring", String("an"), String("banana"), 3, 4)


def test_substring_gives_the_place_of_each_occurrence_and_cuts_out_a_part(mind):
    first, last = Var("I"), Var("J")
    assert mind.instances(".substring", String("a"), String("abbacca"), first, of=first) == ["0", "3", "6"]
    assert mind.instances(".substring", ("a", 10), ("b", "t1", ("a", 10)), first, of=first) == ["5"]
    assert mind.instances(
        ".substring", String("an"), String("banana"), first, last, of=("p", first, last)
    ) == ["p(1,2)", "p(3,4)"]
    assert mind.instances(".substring", String("aa"), String("aaa"), first, of=first) == ["0", "1"]
    assert mind.instances(".substring", String("x"), String("abc"), first, of=first) == []
    assert mind.instances(".substring", String(""), String("ab"), first, of=first) == ["0", "1"]
    part = Var("X")
    assert mind.instances(".substring", part, String("hello world"), 6, of=part) == ['"world"']
    assert mind.instances(".substring", part, String("hello world"), 0, 5, of=part) == ['"hello"']
    assert mind.instances(".substring", part, ("a", 10, 20), 5, 7, of=part) == ['"20"']
    assert mind.instances(".substring", part, String("ab"), 2, of=part) == ['""']
    assert mind.instances(".substring", String("hello"), part, 1, 3, of=part) == ['"el"']


@pytest.mark.parametrize("bounds", [(-1,), (4,), (2, 1), (0, 9)])
def test_substring_refuses_positions_outside_of_the_text(mind, bounds):
    with pytest.raises(ActionError, match="outside the 3 characters"):
        mind.succeeds(".substring", Var("X"), String("abc"), *bounds)


# .replace and the regular expressions of Java


def test_replace_changes_every_match_and_letters_change_their_case(mind):
    assert mind.result(".replace", String("a-b-c"), String("-"), String("+")) == '"a+b+c"'
    assert mind.result(".replace", String("a1b22"), String("[0-9]+"), String("#")) == '"a#b#"'
    assert mind.result(".replace", ("f", "x"), String("x"), String("y")) == '"f(y)"'
    assert not mind.succeeds(".replace", String("a"), String("a"), String("b"), String("a"))
    with pytest.raises(ActionError, match=r"\.replace"):
        mind.succeeds(".replace", String("a"), String("["), String("b"), Var("R"))
    assert mind.result(".upper_case", String("aBé1")) == '"ABÉ1"'
    assert mind.result(".lower_case", String("AbC")) == '"abc"'
    assert mind.result(".upper_case", ("f", "a")) == '"F(A)"'
    assert not mind.succeeds(".lower_case", String("A"), String("A"))


@pytest.mark.parametrize("arguments", [(String("a"), "a", String("b")), (String("a"), String("a"), 1)])
def test_replace_needs_strings(mind, arguments):
    with pytest.raises(WrongArguments):
        mind.succeeds(".replace", *arguments, Var("R"))


@pytest.mark.parametrize(
    ("source", "pattern", "by", "replaced"),
    [
        ("john smith", r"(\w+) (\w+)", "$2 $1", "smith john"),
        ("john smith", r"(\w+) (\w+)", r"\2 \1", "smith john"),
        ("ab", r"(x)?b", "[$1]", "a[]"),
        ("cost", "cost", "$", "$"),
        ("é1", r"\w", "x", "éx"),
        ("aab", "a++", "x", "xb"),
        ("ab", "(?<!a)b|(?<=a)b", "x", "ax"),
    ],
)
def test_matches_are_replaced(source, pattern, by, replaced):
    assert replace_all(source, pattern, by) == replaced


@pytest.mark.parametrize(("pattern", "by"), [("a", "$1"), ("a", "\\"), (r"\p{Greek}", ""), ("(", "")])
def test_invalid_expressions_are_refused(pattern, by):
    with pytest.raises(ValueError, match="'"):
        replace_all("a", pattern, by)


# .upper_case .lower_case .term2string


def test_term2string_writes_and_reads_terms(mind):
    assert mind.result(".term2string", ("b", [1, String("s")])) == '"b([1,"s"])"'
    assert mind.result(".term2string", String("s")) == '""s""'
    assert mind.succeeds(".term2string", "b", String("b"))
    assert not mind.succeeds(".term2string", "b", String("c"))
    mind.readable = {"f(X)": structure("f", 5.0), "10": 10.0, "b": structure("b")}
    read = Var("T")
    assert mind.instances(".term2string", read, String("10"), of=read) == ["10"]
    assert mind.succeeds(".term2string", read, String("f(X)"))
    assert text(read) == "f(5)"
    other = Var("U")
    assert mind.succeeds(".term2string", other, "b")
    assert text(other) == "b"
    read = Var("T")
    assert mind.succeeds(".term2string", read, String("not a ( term"))
    assert mind.succeeds(".atom", read)
    assert text(read) == "not a ( term"
    with pytest.raises(ActionError):
        mind.succeeds(".term2string", "b", "b")
