"""Facts of a program with variables are rules without conditions, as in Jason."""

from recording_host import printed


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
