"""Names in programs: their meaning, and what is done with them."""

import pytest
from edited import edited

from jacaros.agents.language.diagnostics import SourceFile
from jacaros.agents.language.loader import read_program
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.editors.symbols.occurrences import occurrences_of


def roles(text: str, kind: str = "") -> list[str]:
    """Return the occurrences in a program as ``symbol role``, in source order, without variables."""
    program, problems = read_program(SourceFile("robot.asl", text))
    assert not [each for each in problems if each.severity == "error"]
    found = [each for each in occurrences_of(program, STANDARD, "robot") if each.symbol.kind != "variable"]
    for each in found:
        line = text.split("\n")[each.span.line - 1]
        assert line[each.span.column - 1 : each.span.end_column - 1] == each.symbol.name
    found.sort(key=lambda each: each.span[1:])
    return [f"{each.symbol} {each.role}" for each in found if kind in ("", each.symbol.kind)]


@pytest.mark.parametrize(
    ("text", "expected"),
    [
        ("at(home).", ["at/1 defines"]),
        ("far(X) :- not at(X) & near(Y).", ["far/1 defines", "at/1 asks", "near/1 asks"]),
        ("!start.", ["!start/0 calls"]),
        ("@go[atomic] +!go(R).", ["@go defines", "!go/1 handles"]),
        ("-!go(R) : ~at(R).", ["!go/1 handles", "at/1 asks"]),
        (
            "+at(X) <- -+last(X); -old(_); move(X).",
            ["at/1 handles", "last/1 adds", "old/1 removes", "move/1 calls"],
        ),
        ("+!a <- !b; !!c(1); ?d(X).", ["!a/0 handles", "!b/0 calls", "!c/1 calls", "d/1 asks"]),
        (
            "+!a <- if (b & c(1)) { d } else { !e }.",
            ["!a/0 handles", "b/0 asks", "c/1 asks", "d/0 calls", "!e/0 calls"],
        ),
        ("+?a(X) <- X = 1.", ["a/1 handles"]),
    ],
)
def test_each_kind_of_step_has_its_role(text: str, expected: list[str]) -> None:
    assert roles(text) == expected


@pytest.mark.parametrize(
    ("call", "expected"),
    [
        (".send(bob, tell, at(home))", "at/1 tells"),
        (".send(bob, achieve, go(home))", "!go/1 calls"),
        (".broadcast(untell, [a, b(1)])", "a/0 removes"),
        (".send(bob, askOne, at(X), at(Y))", "at/1 asks"),
        (".findall(X, at(X), L)", "at/1 asks"),
        (".wait({+at(home)})", "at/1 handles"),
        (".wait(at(home))", "at/1 asks"),
        (".abolish(at(_))", "at/1 removes"),
        (".drop_intention(go(_))", "!go/1 asks"),
        (".remove_plan(go)", "@go mentions"),
    ],
)
def test_internal_actions_say_what_their_arguments_are(call: str, expected: str) -> None:
    assert roles(f"+!a <- {call}.")[2:3] == [expected]


def test_terms_are_not_beliefs() -> None:
    assert roles("+!a(p(1)) <- b(q(2)); .print(r(3)).") == ["!a/1 handles", "b/1 calls", ".print calls"]


def test_a_clause_with_an_error_hides_no_other() -> None:
    program, problems = read_program(SourceFile("robot.asl", "a.\n+!b <- c(.\n+!d <- e."))
    assert problems
    assert "e" in [each.symbol.name for each in occurrences_of(program, STANDARD)]


def test_an_offer_names_what_it_offers() -> None:
    text = '{ offer(goal, deliver(parcel(string)), doc("Bring it.")) }\n+!deliver(P).'
    assert roles(text) == ["!deliver/1 offers", "!deliver/1 handles"]


def test_namespaces_separate_beliefs() -> None:
    index, _, _ = edited("a. { begin namespace(n) } a. +!b : default::a <- ?a. { end }")
    found = {symbol: len(index.of(symbol)) for symbol in index.symbols("belief")}
    assert {(each.name, each.scope): count for each, count in found.items()} == {("a", ""): 2, ("a", "n"): 2}


def test_local_namespaces_belong_to_one_program() -> None:
    text = "{ namespace(n, local) } { begin namespace(n) } a. { end }"
    index, _, _ = edited(text, ("other.asl", text))
    assert [len(index.of(each)) for each in index.symbols("belief")] == [1, 1]


def test_an_included_file_counts_once() -> None:
    index, _, _ = edited('{ include("lib.asl") } +!go <- !help.', ("lib.asl", "+!help <- stop."))
    (goal,) = [each for each in index.symbols("goal") if each.name == "help"]
    assert [each.span.file.name for each in index.of(goal)] == ["lib.asl", "robot.asl"]


def test_variables_belong_to_their_clause() -> None:
    index, _, _ = edited("+!a(X) : p(X, _) <- q(X).\n+!b(X).")
    assert sorted(len(index.of(each)) for each in index.symbols("variable")) == [1, 3]
