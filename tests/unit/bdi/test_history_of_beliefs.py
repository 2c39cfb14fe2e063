"""Histories of beliefs: `b(X)[ago(Ms)]` by the rules and by generated code; stored minds; mistakes."""

import json
from pathlib import Path

import pytest
from recording_host import RecordingHost, mind

from jacaros.asl.diagnostics import AslError
from jacaros.asl.loader import load_program
from jacaros.bdi.mind import Mind
from jacaros.bdi.rules import deriving
from jacaros.bdi.snapshot import restore, stored
from jacaros.bdi.state.act import Percept
from jacaros.mas.checking import check_files
from jacaros.terms.values import SOURCE_PERCEPT, functor
from jacaros.testing.run import run_project


@pytest.fixture(params=["0", "1"], ids=["fast", "plain"], autouse=True)
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("JACAROS_PLAIN", request.param)


def run(folder: Path, body: str, more: str = "") -> list[str]:
    """What an agent prints that had ranges 9, 1 (from 100 ms on), 2 (from 400 ms on), at 600 ms."""
    file = folder / "a.asl"
    file.write_text(
        "{ history(range(_), within(2000)) }\nrange(9).\n!start.\n"
        "+!start <- .wait(100); -+range(1); .wait(300); -+range(2); .wait(200); "
        f"{body}.\n{more}\n-!start <- .print(failed).\n"
    )
    result = run_project(file, until_idle=True)
    assert result.errors == []
    return [line.removeprefix("[a] ") for line in result.lines]


@pytest.mark.parametrize(
    ("body", "printed"),
    [
        ("?range(X)[ago(0)]; .print(X)", ["2"]),
        ("?range(X)[ago(199)]; .print(X)", ["2"]),
        ("?range(X)[ago(200)]; .print(X)", ["2"]),
        ("?range(X)[ago(201)]; .print(X)", ["1"]),
        ("?range(X)[ago(550), source(S)]; .print(X, S)", ["9self"]),
        ("?range(X)[ago(550), source(percept)]; .print(X)", ["failed"]),
        ("T = 500; ?range(X)[ago(T - 100)]; .print(X)", ["1"]),
        ("?range(X)[ago(5000)]; .print(X)", ["failed"]),
        ("?range(X)[ago(1000)]; .print(X)", ["failed"]),
        ("?range(X)[ago(-1)]; .print(X)", ["failed"]),
        ("?range(X)[ago(Y)]; .print(X)", ["failed"]),
        ("?range(2)[ago(300)]; .print(yes)", ["failed"]),
        ("if (not range(2)[ago(300)] & range(1)[ago(300)]) { .print(yes) }", ["yes"]),
        (".findall(X, range(X)[ago(300)], L); .print(L)", ["[1]"]),
        ("for (range(X)[ago(300)]) { .print(X) }", ["1"]),
        ("+f(range(1)[ago(300)]); ?f(F); if (F) { .print(yes) }", ["yes"]),
        ("N = default; ?N::range(X)[ago(300)]; .print(X)", ["1"]),
        ("+range(7); +range(8); .wait(100); .findall(X, range(X)[ago(50)], L); .print(L)", ["[8,7,2]"]),
        ("-range(_); .wait(100); ?range(X)[ago(150)]; .print(X); ?range(_)[ago(50)]", ["2", "failed"]),
        ("+range(2)[source(bob)]; .wait(100); ?range(2)[ago(150), source(bob)]", ["failed"]),
        ("+range(2)[source(bob)]; .wait(100); ?range(X)[ago(50), source(bob)]; .print(X)", ["2"]),
        (".wait(2000); ?range(X)[ago(1999)]; .print(X)", ["2"]),
    ],
)
def test_a_belief_is_asked_for_as_it_was(tmp_path: Path, body: str, printed: list[str]) -> None:
    assert run(tmp_path, body) == printed


def test_contexts_and_rules_ask_for_the_past(tmp_path: Path) -> None:
    plans = """
        closer(D) :- range(X) & range(Y)[ago(550)] & D = Y - X.
        deep(0, X) :- range(X)[ago(300)].
        deep(N, X) :- N > 0 & deep(N - 1, X).
        +!look(W) : range(X)[ago(W)] & X < 5 <- .print(X).
        +!look(_) <- .print(none)."""
    body = "?closer(D); .print(D); ?deep(150, X); .print(X); !look(300); !look(550)"
    assert run(tmp_path, body, plans) == ["7", "1", "1", "none"]


def test_a_block_of_a_namespace_keeps_beliefs_of_its_own(tmp_path: Path) -> None:
    plans = """{ begin namespace(ns) }
        { history(h(_), within(1000)) }
        +!go <- +h(1); .wait(100); -+h(2); ?h(X)[ago(50)]; .print(X).
        { end }"""
    assert run(tmp_path, "!ns::go", plans) == ["1"]


def test_a_program_without_a_declaration_finds_nothing_and_keeps_nothing() -> None:
    host = mind("b(1). c(1)[ago(5)]. !s. +!s : not b(_)[ago(0)] & c(X)[ago(5)] <- .print(X).")
    while host.agent.run(10):
        pass
    assert host.printed == ["1"]
    assert host.agent.observers.derived is None
    assert not host.agent.observers.hear_beliefs


def run_until(host: RecordingHost, end: float) -> None:
    """Let the agent run, and its timers ring, until a moment."""
    more = True
    while more:
        while host.agent.run(10):
            pass
        more = host.ring_next(end)
    host.time = end


PROPERTY = "{ history(p(_), within(1000)) } +!ask(T) <- .findall(X, p(X)[ago(T)], L); .print(L)."


def show(host: RecordingHost, value: float, old: list[Percept]) -> list[Percept]:
    """Show a property with a new value."""
    symbol, about = functor("p", 1), (SOURCE_PERCEPT,)
    host.agent.perceive([*old, Percept("add", (symbol, value), about)])
    return [Percept("remove", (symbol, value), about)]


def ask(host: RecordingHost, milliseconds: float) -> str:
    """What the agent believed that time ago."""
    host.agent.post_goal((functor("ask", 1), milliseconds))
    run_until(host, host.time)
    return host.printed[-1]


def test_properties_have_a_history_and_signals_none() -> None:
    host = mind(PROPERTY)
    old: list[Percept] = []
    for value in (1.0, 2.0, 3.0):
        old = show(host, value, old)
        host.agent.perceive([Percept("signal", (functor("p", 1), 7.0), (SOURCE_PERCEPT,))])
        run_until(host, host.time + 0.1)
    assert [ask(host, each) for each in (50.0, 100.0, 150.0, 250.0, 350.0)] == [
        "[3]",
        "[3]",
        "[2]",
        "[1]",
        "[]",
    ]


def test_memory_is_bounded_by_the_window() -> None:
    host = mind(PROPERTY)
    old: list[Percept] = []
    for value in range(1000):
        old = show(host, float(value), old)
        run_until(host, host.time + 0.01)
    held = deriving.stored(host.agent, host.agent.program)
    assert held is not None
    [(_, spans)] = held["histories"]["kept"]
    assert 100 <= len(spans) <= 102


@pytest.mark.parametrize(("same_host", "now"), [(True, "[2]"), (False, "[]")])
def test_a_stored_mind_keeps_its_history(same_host: bool, now: str) -> None:
    host = mind(PROPERTY)
    old = show(host, 1.0, [])
    run_until(host, host.time + 0.1)
    show(host, 2.0, old)
    run_until(host, host.time + 0.1)
    data = json.loads(json.dumps(stored(host.agent)))
    before = host.agent
    host.agent = Mind(before.name, before.program, host, before.options, before.engine.actions)
    restore(host.agent, data, same_host=same_host)
    run_until(host, host.time + 0.1)
    assert [ask(host, each) for each in (0.0, 150.0, 250.0)] == [now, "[2]", "[1]"]


def test_a_history_requested_by_an_artifact_equals_one_of_a_directive() -> None:
    host = mind(PROPERTY.split("}")[1])
    old = show(host, 1.0, [])
    run_until(host, host.time + 0.1)
    assert ask(host, 50.0) == "[]"
    host.agent.keep_histories(None, {"p": 0.5, "q": 1.0})
    host.agent.keep_histories("ns", {"p": 9.0})
    for value in (2.0, 3.0):
        run_until(host, host.time + 0.1)
        old = show(host, value, old)
        run_until(host, host.time)
    assert [ask(host, each) for each in (0.0, 50.0, 150.0, 250.0, 501.0)] == ["[3]", "[2]", "[1]", "[]", "[]"]
    data = json.loads(json.dumps(stored(host.agent)))
    before = host.agent
    host.agent = Mind(before.name, before.program, host, before.options, before.engine.actions)
    restore(host.agent, data, same_host=True)
    run_until(host, host.time + 0.1)
    assert [ask(host, each) for each in (50.0, 150.0, 250.0, 501.0)] == ["[3]", "[2]", "[1]", "[]"]


def test_the_longest_of_several_windows_of_a_history_counts() -> None:
    host = mind("{ history(p(_), within(100)) }" + PROPERTY)
    host.agent.keep_histories(None, {"p": 0.5})
    old = show(host, 1.0, [])
    for value in (2.0, 3.0):
        run_until(host, host.time + 0.4)
        old = show(host, value, old)
    assert [ask(host, each) for each in (100.0, 500.0, 1000.0, 1001.0)] == ["[2]", "[1]", "[]", "[]"]
    deriving.replace(host.agent, host.agent.program, load_program("a.asl", "!s. +!s.")[0])
    assert [ask(host, each) for each in (100.0, 500.0, 501.0)] == ["[2]", "[1]", "[]"]


@pytest.mark.parametrize(
    ("declared", "message"),
    [
        ("range(_)", "`history` expects a belief and `within`"),
        ("range(_), 5", "`history` expects a belief and `within`"),
        ("range(_), within(0)", "`within` must be above zero"),
        ("range(_), within(-5)", "`within` must be above zero"),
        ("range(_), within(1e9)", "`within` is longer than a day"),
        ("range(X), within(5)", "a history keeps all values of a belief"),
        ("range(_)[source(self)], within(5)", "annotations have no effect here"),
    ],
)
def test_wrong_declarations_are_reported(declared: str, message: str) -> None:
    with pytest.raises(AslError) as caught:
        load_program("a.asl", f"{{ history({declared}) }}\n!s. +!s.")
    assert [each.message for each in caught.value.diagnostics] == [message]
    assert caught.value.diagnostics[0].help


def test_check_reports_a_history_that_is_not_kept(tmp_path: Path) -> None:
    file = tmp_path / "a.asl"
    file.write_text("{ history(a(_), within(5)) } !s. +!s : a(_)[ago(1)] & not b(_,_)[ago(1)] <- ?c[ago(2)].")
    told = [
        (each.message, each.help) for each in check_files([file]).diagnostics if each.code == "no-history"
    ]
    assert told == [
        (
            f"no history of `{each}` is kept: `ago` finds nothing",
            f"declare `{{ history({each}, within(2000)) }}`, or `history: 2` in the mapping file of a property",
        )
        for each in ("b(_, _)", "c")
    ]
