import pytest
from fake_context import term

from jacaros.agents.terms.collections import MapValue, QueueValue, SetValue
from jacaros.agents.terms.plans import RULE, make_body, step
from jacaros.agents.terms.values import (
    ACTION,
    ARITHMETIC,
    Annotated,
    String,
    Term,
    Var,
    atom,
    functor,
    make_list,
)

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


def test_the_empty_list_is_not_an_atom_and_unknown_types_have_no_members(mind):
    assert not mind.succeeds(".type", 1, "integer")
    assert not mind.succeeds(".atom", [])
    assert not mind.succeeds(".literal", [])


def test_internal_action_knows_calls(mind):
    assert mind.succeeds(".internal_action", CALL)
    assert not mind.succeeds(".internal_action", ("print", "a"))
    assert not mind.succeeds(".internal_action", Var("X"))
