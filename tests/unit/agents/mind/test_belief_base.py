"""The belief base against a simple model, its indexes, rules and limit."""

from unittest import mock

import pytest
from hypothesis import given
from hypothesis import strategies as st
from recording_host import RecordingHost, believed, mind, printed

from jacaros.agents.mind.state import belief_base
from jacaros.agents.mind.state.act import Percept, SpeechAct
from jacaros.agents.mind.state.belief_base import BeliefTables, Table
from jacaros.agents.mind.state.budget import Options
from jacaros.agents.mind.state.plan import OpenFact
from jacaros.agents.terms.substitution import rename
from jacaros.agents.terms.unifier import Trail, unify
from jacaros.agents.terms.values import BY_SELF, SOURCE_PERCEPT, Var, atom, functor, structure

OPERATIONS = st.lists(
    st.tuples(st.sampled_from(["add", "last", "remove"]), st.integers(0, 4), st.integers(0, 2)), max_size=40
)


class Model:
    """Rows in the order in which they answer: a plain list."""

    def __init__(self) -> None:
        self.rows: list[tuple[float, float]] = []

    def apply(self, operation: str, row: tuple[float, float]) -> None:
        if operation == "remove":
            if row in self.rows:
                self.rows.remove(row)
        elif row not in self.rows:
            self.rows.insert(0 if operation == "add" else len(self.rows), row)


@given(OPERATIONS)
def test_a_table_answers_like_a_list_after_any_changes(operations):
    table, model = Table(functor("p", 2)), Model()
    table.find((0,), 0.0)
    table.find((0, 1), (0.0, 0.0))
    for operation, a, b in operations:
        row = (float(a), float(b))
        model.apply(operation, row)
        if operation == "remove":
            if table.get(row) is not None:
                table.remove(row)
        elif table.get(row) is None:
            table.add(row, BY_SELF, last=operation == "last")
    assert [entry for entry, _ in table.entries()] == model.rows
    if table.plain:
        for a in range(5):
            assert list(table.find((0,), float(a))) == [r for r in model.rows if r[0] == a]
            assert list(table.find((0, 1), (float(a), 1.0))) == [r for r in model.rows if r == (a, 1.0)]


class Entry:
    """Represents a rule: it is not a row, and may answer any question."""

    node = "rule"


def open_fact(a: object, b: object) -> OpenFact:
    return OpenFact((functor("p", 2), a, b), BY_SELF)


@pytest.mark.parametrize("few", [0, 8])
@given(st.lists(st.tuples(st.sampled_from("arxlRLdO"), st.integers(0, 7), st.integers(0, 2)), max_size=50))
def test_candidates_of_mixed_tables_are_complete_and_in_order(few, operations):
    """With *few* the ways of large tables are taken by small ones, too."""
    table = Table(functor("p", 2))
    entries = [Entry(), Entry(), *(open_fact(a, b) for a in (1.0, 2.0, Var()) for b in (2.0, Var()))]
    model: list[object] = []
    for operation, a, b in operations:
        item: object = (float(a), float(b)) if operation in "arxl" else entries[a]
        if operation in "rd" or item in model:
            if item in model:
                model.remove(item)
                table.remove(item)
        else:
            late = operation in "lL"
            model.insert(len(model) if late else 0, item)
            table.add(item, BY_SELF, last=late)
        assert table.plain == all(i.__class__ is tuple for i in (*model, *table.late)) or table.late
        assert table.others == sum(i.__class__ is not tuple for i in table.rows)
        with mock.patch.multiple(belief_base, FEW=few):
            for question in ((1.0, Var()), (Var(), 2.0), (1.0, 2.0), (Var(), Var())):
                asked = tuple(None if a.__class__ is Var else a for a in question)
                found = [entry for entry, _ in table.candidates(question) if matches(entry, asked)]
                assert found == [entry for entry in model if matches(entry, asked)]


def matches(row: object, asked: tuple[object, ...]) -> bool:
    if isinstance(row, OpenFact):
        return unify((functor("p", 2), *(a or Var() for a in asked)), rename(row.literal), Trail())
    if not isinstance(row, tuple):
        return True
    return all(b in (None, a) for a, b in zip(row, asked, strict=True))


def test_tables_lose_their_newest_beliefs_and_rules_without_traces():
    table = Table(functor("p", 2))
    table.find((0,), 1.0)
    for i in range(1000):
        table.add((1.0, float(i)), BY_SELF)
    for i in range(999, -1, -1):
        assert next(iter(table.find((0,), 1.0))) == (1.0, float(i))
        table.remove((1.0, float(i)))
    assert list(table.find((0,), 1.0)) == []
    table.add((1.0, 5.0), BY_SELF)
    assert list(table.find_items((0,), 1.0)) == [((1.0, 5.0), BY_SELF)]
    table = Table(atom("p"))
    rule = Entry()
    table.add((), BY_SELF)
    table.add(rule, ())
    assert not table.plain
    table.remove(rule)
    assert table.plain


def test_a_search_does_not_see_changes_by_its_own_actions():
    base = BeliefTables()
    table = base[functor("p", 1)]
    for i in range(3):
        table.add((float(i),), BY_SELF)
    found = []
    for row in reversed(table.rows):
        base.searching = base.next_call()
        table.remove(row)
        table.add((row[0] + 10,), BY_SELF)
        base.searching = 0
        found.append(row)
    assert found == [(2.0,), (1.0,), (0.0,)]
    assert [row for row, _ in table.entries()] == [(10.0,), (11.0,), (12.0,)]


@pytest.mark.parametrize("belief", ["d(I)", "d(a, I)", "d(I)[b]"])
@pytest.mark.parametrize("others", ["", "d(0). d(0, 0).", "d(X) :- X < 0. d(X, Y) :- X < 0 & Y < 0."])
def test_the_cost_of_a_belief_does_not_depend_on_the_number_of_others(belief, others, calls_of):
    def work(beliefs: int) -> int:
        program = f"""{others}
            !s.
            +!s <- for (.range(I, 1, {beliefs})) {{ +{belief} }};
                   for (.range(I, 1, {beliefs})) {{ ?{belief} }};
                   for (.range(I, 1, {beliefs})) {{ -{belief} }};
                   .print(.count({belief.replace("I", "_")})).
            """
        return calls_of(lambda: printed(program))

    work(1)  # what a process makes once
    least = work(1)
    assert work(200) - least < 6 * (work(50) - least)


GROW = """
known(1). known(2).
!fill(1).
+!fill(N)
  <- +grown(N);
     !fill(N + 1).
-!fill(N)[error(E), error_msg(M), code_line(L)] <- .print(N, " ", E, " in line ", L); .print(M).
"""


def limited(program: str, limit: int) -> RecordingHost:
    host = mind(program, options=Options(belief_limit=limit))
    host.run()
    return host


def test_a_step_that_exceeds_the_limit_fails_with_the_reason():
    host = limited(GROW, 10)
    assert host.printed == [
        "9 belief_limit in line 5",
        "there are 10 beliefs (option belief_limit), most of them grown/1 (8)",
    ]
    assert len(believed(host, "grown")) == 8
    host = limited(GROW.replace("+grown(N)", "-+now(N); if (N mod 2 == 0) { +grown(N) }"), 3_000)
    assert host.printed == [
        "5996 belief_limit in line 5",
        "there are 3000 beliefs (option belief_limit), most of them grown/1 (2997)",
    ]
    program = """
    a. b.
    !s.
    +!s <- .asserta(c); .print(never).
    -!s[error(E)] <- .print(E).
    """
    assert limited(program, 2).printed == ["belief_limit"]


def test_rules_count_and_replaced_or_deleted_beliefs_make_room():
    program = """
    a(0). b(0).
    !s.
    +!s <- -+a(1); -+a(2); +a(2); -b(0); +c(X); -c(_); +c(f(Y)); .abolish(c(_)); +b(1); .print(full); +b(2).
    -!s[error(E)] <- .print(E).
    """
    assert limited(program, 2).printed == ["full", "belief_limit"]
    program = """
    a :- b.
    !s.
    +!s <- +c; +d.
    -!s[error(E)] <- .print(E).
    """
    host = limited(program, 2)
    assert host.printed == ["belief_limit"]
    assert believed(host, "c") == ["c[source(self)]"]


def test_refused_beliefs_from_outside_are_logged_once():
    host = mind("+p(X) <- .print(X).", options=Options(belief_limit=3))
    host.run()
    percepts = [Percept("add", structure("p", float(n)), (SOURCE_PERCEPT,)) for n in range(4)]
    host.agent.perceive(percepts)
    for n in range(4, 6):
        host.agent.receive(SpeechAct("tell", "bob", "tester", structure("p", float(n)), f"m{n}"))
    host.run()
    assert host.printed == ["0", "1", "2"]
    assert host.logged == [
        (
            "error",
            "refusing beliefs from outside: there are 3 beliefs (option belief_limit), most of them p/1 (3)",
        )
    ]
    host.agent.perceive([Percept("remove", structure("p", 0.0), (SOURCE_PERCEPT,))])
    host.agent.perceive([Percept("remove", structure("p", 3.0), (SOURCE_PERCEPT,))])
    host.agent.perceive([Percept("add", structure("p", 7.0), (SOURCE_PERCEPT,))])
    host.run()
    assert host.printed[3:] == ["7"]
    assert len(believed(host, "p")) == 3


def test_facts_with_variables_are_listed_as_rules():
    program = """
        a(X) :- b(X). open(Y). ~no(Z)[k]. b(1).
        !s.
        +!s <- .relevant_rules(open(3), L); .print(L); .relevant_rules(~no(_), M); .print(M);
           .relevant_rules([a], N); .print(N); .relevant_rules(b(_), O); .print(O);
           .relevant_rules(_, P); .print(.length(P)).
    """
    assert printed(program) == ["[{ open(Y) :- true }]", "[{ ~no(Z)[k] :- true }]", "[]", "[]", "3"]
    assert sorted(printed("a(X) :- b(X). open(Y)[k]. b(1). !s. +!s <- .list_rules.")) == [
        "a(X)[source(self)] :- b(X)",
        "open(Y)[k,source(self)] :- true",
    ]
