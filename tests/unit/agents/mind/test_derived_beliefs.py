"""Derived beliefs of programs: end to end on the virtual clock, by the rules and by generated code; wrong directives."""

import json
import os
from pathlib import Path

import pytest
from recording_host import RecordingHost, mind, plans_of

from jacaros.agents.checks.beliefs import beliefs_of
from jacaros.agents.language import nodes
from jacaros.agents.language.derive import format_derivation
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.language.loader import load_program
from jacaros.agents.mind.actions.internal_action import STANDARD
from jacaros.agents.mind.mind import Mind
from jacaros.agents.mind.rules import deriving
from jacaros.agents.mind.state.act import Percept
from jacaros.agents.mind.storage import copy_mind, restore, stored
from jacaros.agents.terms.values import SOURCE_PERCEPT, functor
from jacaros.testing.run import run_project


@pytest.fixture(params=["0", "1"], ids=["fast", "plain"], autouse=True)
def engine(request: pytest.FixtureRequest, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("JACAROS_PLAIN", request.param)


def run(folder: Path, derived: str, body: str, plans: str = "") -> list[str]:
    """What an agent prints that does *body* and reacts to ``+d`` and ``-d``."""
    file = folder / "a.asl"
    file.write_text(
        f"{{ derive(d, {derived}) }}\n!start.\n+!start <- {body}.\n"
        f"+d[source(S)] <- .print(on, S).\n-d <- .print(off).\n+d(X) <- .print(X).\n{plans}"
    )
    result = run_project(file, until_idle=True, plain=os.environ["JACAROS_PLAIN"] == "1")
    assert result.errors == []
    return [line.removeprefix("[a] ") for line in result.lines]


@pytest.mark.parametrize(
    ("derived", "body", "printed"),
    [
        ("count(e(_), within(1000), at_least(2))", "+e(1); .wait(100); +e(2)", ["onderived", "off"]),
        ("count(e(_), within(1000), at_least(2))", "+e(1); .wait(1100); +e(2)", []),
        ("count(e(1), within(1000))", "+e(1); +e(2)", ["1"]),
        (
            "hysteresis(e(_,X), on_above(5), off_below(4))",
            "+e(1,7); .wait(10); +e(6,3)",
            ["onderived", "off"],
        ),
        (
            "hysteresis(b(X), on_below(20), off_above(30))",
            "-+b(10); .wait(1); -+b(25); .wait(1); -+b(31)",
            ["onderived", "off"],
        ),
        (
            "held(b(X), below(5), lasting(100))",
            "-+b(1); .wait(60); -+b(2); .wait(60); -+b(7)",
            ["onderived", "off"],
        ),
        ("held(door(open), lasting(100))", "+door(open); .wait(60); -door(open); .wait(60)", []),
        (
            "absent(e(_), lasting(100))",
            ".wait(50); +e(1); .wait(120); +e(2)",
            ["onderived", "off", "onderived"],
        ),
        ("sequence([p, r], within(100))", "+p; .wait(50); +r; -p; -r; +p; .wait(150); +r", ["onderived"]),
    ],
)
def test_derived_beliefs_come_and_go(tmp_path: Path, derived: str, body: str, printed: list[str]) -> None:
    assert run(tmp_path, derived, body) == printed


def test_samples_come_together(tmp_path: Path) -> None:
    plans = "+d(X,Y,Z) <- .print(X, Y, Z)."
    body = "-+scan(1); .wait(30); -+odom(2,3); .wait(500); -+scan(4); .wait(100); -+odom(5,6)"
    assert run(tmp_path, "together([scan(R), odom(X, Y)], within(50))", body, plans) == ["123"]


def test_derived_beliefs_may_be_derived_of_others(tmp_path: Path) -> None:
    plans = "{ derive(both, sequence([x, d], within(1000))) }\n+both <- .print(both)."
    assert run(tmp_path, "count(e(_), within(50), at_least(2))", "+x; +e(1); +e(2)", plans) == [
        "onderived",
        "both",
        "off",
    ]


def test_a_block_of_a_namespace_has_beliefs_and_derived_ones_of_its_own(tmp_path: Path) -> None:
    plans = """{ begin namespace(ns) }
        { derive(c, sequence([g, h::i(_)], within(100))) }
        +c <- .print(c).
        { end }"""
    assert run(tmp_path, "count(g, within(50))", "+ns::g; +h::i(1)", plans) == ["c"]


@pytest.mark.parametrize(
    ("derived", "body"),
    [
        ("count(e(_), within(1000), at_least(2))", "+e(1); .wait(700); +e(2); .wait(200); +e(3)"),
        ("count(e(X), within(1000))", "+e(1); .wait(700); +e(2); .wait(200); +e(6)"),
        ("hysteresis(e(X), on_above(4), off_below(3))", "+e(5); .wait(700); +e(2); .wait(500); +e(3)"),
        ("held(e(X), above(1), lasting(300))", "+e(2); .wait(700); -e(2)"),
        ("sequence([e, f, g], within(300))", "+e; .wait(100); +f; .wait(100); +g"),
        ("together([e(X), f(Y)], within(50))", "+e(1); .wait(10); +f(2)"),
        ("absent(e, lasting(300))", ".wait(100); +e"),
    ],
)
def test_a_mind_that_is_restored_after_each_cycle_derives_the_same(derived: str, body: str) -> None:
    found = []
    for exchanged in (False, True):
        host = mind(
            f"{{ derive(d, {derived}) }} !s. +!s <- {body}; .wait(2000); .print(end)."
            "+d <- .print(on). -d <- .print(off). +d(X) <- .print(X). +d(X,Y) <- .print(X, Y)."
        )
        more = True
        while more:
            more = host.agent.run(1)
            if exchanged:
                restored(host)
            more = more or host.ring_next(host.time + 10)
        found.append(host.printed)
    assert len(found[0]) > 1
    assert found[0] == found[1]


D = "{ derive(d, count(e(_), within(1000), at_least(2))) }"
ON_OFF = "+d <- .print(on). -d <- .print(off)."


def after_two_events(more: str = "") -> RecordingHost:
    """A host whose agent derives `d` of two events, 400 ms after the second one."""
    host = mind(f"{D} {ON_OFF} {more} !s. +!s <- +e(1); .wait(100); +e(2); .wait(5000).")
    run_until(host, host.time + 0.5)
    assert host.printed == ["on"]
    return host


def change(program: str) -> nodes.Program:
    """Another program for the agent."""
    return load_program("a.asl", f"{program} {ON_OFF} !s. +!s.")[0]


def test_a_mind_restored_for_another_program_drops_underived_beliefs() -> None:
    host = after_two_events()
    data = json.loads(json.dumps(stored(host.agent)))
    old = host.agent
    program = nodes.Program(old.program.beliefs, old.program.goals, old.program.plans)
    host.agent = Mind(old.name, program, host, old.options, plans=plans_of(program, old.engine.actions))
    restore(host.agent, data, same_host=True)
    assert len(host.agent.beliefs[functor("d", 0)]) == 0
    assert len(host.agent.beliefs[functor("e", 1)]) == 2


def test_a_restored_mind_derives_what_an_included_program_declares() -> None:
    host = after_two_events()
    program, _ = load_program(
        "b.asl", "{ derive(f, count(e(_), within(1000), at_least(3))) } +f <- .print(f)."
    )
    deriving.declare(host.agent, program)
    for value in (3.0, 4.0):
        host.agent.add_belief(functor("e", 1), (value,), ())
        run_until(host, host.time)
        restored(host)
    host.agent.add_belief(functor("e", 1), (5.0,), ())
    run_until(host, host.time + 0.1)
    assert len(host.agent.beliefs[functor("f", 0)]) == 1


@pytest.mark.parametrize(
    ("new", "until_off"),
    [(D, 0.5), ("{ derive(d, count(e(_), within(1000), at_least(1))) }", 0.0)],
    ids=["unchanged", "changed"],
)
def test_a_changed_program_keeps_the_windows_of_unchanged_declarations(new: str, until_off: float) -> None:
    host = after_two_events("{ derive(gone, count(e(_), within(1000))) }")
    deriving.replace(
        host.agent, host.agent.program, change(f"{new} {{ derive(f, count(e(_), within(10))) }}")
    )
    host.agent.program = change(new)
    end = host.time + until_off
    run_until(host, end - 0.01)
    assert host.printed == (["on"] if until_off else ["on", "off"])
    run_until(host, end + 0.01)
    assert host.printed == ["on", "off"]
    assert len(host.agent.beliefs[functor("gone", 1)]) == 0
    host.agent.add_belief(functor("e", 1), (5.0,), ())
    run_until(host, host.time)
    assert [entry for entry, _ in host.agent.beliefs[functor("f", 1)].entries()] == [(1.0,)]


def test_a_clone_continues_with_the_windows_of_the_original() -> None:
    host = after_two_events()
    other = RecordingHost()
    other.time = host.time
    clone = other.agent = Mind(
        "clone", host.agent.program, other, host.agent.options, host.agent.engine.actions
    )
    copy_mind(host.agent, clone)
    assert len(clone.beliefs[functor("d", 0)]) == 1
    run_until(other, other.time + 0.49)
    assert len(clone.beliefs[functor("d", 0)]) == 1
    run_until(other, other.time + 0.02)
    assert other.printed == ["off"]
    assert len(clone.beliefs[functor("d", 0)]) == 0
    assert host.printed == ["on"]


def test_contexts_and_waits_see_derived_beliefs(tmp_path: Path) -> None:
    body = "+e(1); .wait(d, 500); .print(seen); .wait(not d, 2000); .print(gone)"
    printed = run(tmp_path, "count(e(_), within(1000), at_least(1))", body)
    assert (printed[:2], sorted(printed[2:])) == (["onderived", "seen"], ["gone", "off"])


def run_until(host: RecordingHost, end: float) -> None:
    """Let the agent run, and its timers ring, until a moment."""
    more = True
    while more:
        while host.agent.run(10):
            pass
        more = host.ring_next(end)
    host.time = end


def test_a_property_with_a_new_value_does_not_end_in_between() -> None:
    host = mind(
        "{ derive(held, held(p(X), above(1), lasting(100))) } { derive(many, count(p(_), within(1000), at_least(3))) }"
        "+held <- .print(held). -held <- .print(over). +many <- .print(many). -many <- .print(few)."
    )
    symbol, about = functor("p", 1), (SOURCE_PERCEPT,)
    old: list[Percept] = []
    for value in (2.0, 3.0, 4.0, 0.5):
        host.agent.perceive([*old, Percept("add", (symbol, value), about)])
        old = [Percept("remove", (symbol, value), about)]
        run_until(host, host.time + 0.06)
    run_until(host, host.time + 10)
    assert host.printed == ["held", "many", "over", "few"]


def test_signals_are_events() -> None:
    host = mind("{ derive(twice, count(bump(_), within(1000), at_least(2))) } +twice <- .print(twice).")
    for value in (1.0, 2.0):
        host.agent.perceive([Percept("signal", (functor("bump", 1), value), (SOURCE_PERCEPT,))])
    while host.agent.run(10):
        pass
    assert host.printed == ["twice"]


def restored(host: RecordingHost) -> None:
    """Put a restored mind in the place of that of the host."""
    old = host.agent
    data = json.dumps(stored(old))
    for alarm in old.waits.alarms.values():
        alarm.timer.cancel()
    host.agent = Mind(
        old.name, old.program, host, old.options, plans=plans_of(old.program, old.engine.actions)
    )
    restore(host.agent, json.loads(data), same_host=True)


def test_an_agent_without_declarations_listens_to_nothing(tmp_path: Path) -> None:
    program, _ = load_program("a.asl", "!s. +!s.")
    assert program.derived == ()


@pytest.mark.parametrize(
    ("derived", "message", "help_"),
    [
        ("cuont(e(_), within(1))", "unknown operator `cuont`", "did you mean `count`?"),
        ("count(e(_), within(-1))", "`within` must be above zero", "write a positive time"),
        (
            "count(e(_))",
            "`count` needs `within`",
            "give the length of the window, so that its memory is bounded",
        ),
        (
            "count(e(_), within(1), at_least(1.5))",
            "`at_least` must be a whole number",
            "write a number such as 3",
        ),
        (
            "hysteresis(e(_), on_above(2), off_below(1))",
            "`hysteresis` expects 1 named variable in its belief",
            "make one argument a variable, and the others `_`",
        ),
        ("held(e, lastin(1))", "`held` has no option `lastin`", "options: lasting, above, below"),
        (
            "held(e, lasting(1), equals(2))",
            "option `equals` exists in mapping files only",
            "write the value into the belief, as in `door(open)`",
        ),
        (
            "together([e(X), f(Y)], within(1), lateness(1))",
            "option `lateness` exists in mapping files only",
            "remove it: an agent handles changes in order, so none is late",
        ),
        ("count(e[source(self)], within(1))", "annotations have no effect here", "remove them"),
        ("count(e(f(X)), within(1))", "variable within a term", "write `_` for the whole argument"),
        ("count(d, within(1))", "`d` is derived from itself", "derive it from other beliefs"),
        ("d", "unknown operator `d`", None),
    ],
)
def test_invalid_patterns_are_reported_with_help(derived: str, message: str, help_: str | None) -> None:
    with pytest.raises(AslError) as caught:
        load_program("a.asl", f"{{ derive(d, {derived}) }}\n!s. +!s.")
    told = {each.message: each.help for each in caught.value.diagnostics}
    assert message in told, told
    assert help_ is None or told[message] == help_


def test_directives_are_written_as_they_were_parsed() -> None:
    text = """{ derive(a, count(e(_,3,"x y"), within(100), at_least(2))) }
        { derive(b, sequence([r(_), q(z)], within(57))) }
        { derive(c, together([scan(R), pose(X,A), p(B,_,C)], within(0.1))) }
        { derive(d, hysteresis(battery(X), on_below(-1), off_above(1.5))) }
        { derive(f, held(~open(_), lasting(1234.5678))) }
        { begin namespace(ns) } { derive(g, sequence([ns::g2, h::i(_)], within(100))) } { end }"""
    program, _ = load_program("a.asl", f"{text}\n!s. +!s.")
    written = list(map(format_derivation, program.derived))
    assert written == [line.strip() for line in text.splitlines()]


def test_cycles_over_several_declarations_are_reported() -> None:
    with pytest.raises(AslError, match="`b` is derived from itself"):
        load_program("a.asl", "{ derive(a, count(b, within(1))) } { derive(b, count(a, within(1))) }")


def test_derived_names_are_made() -> None:
    program, _ = load_program("a.asl", "{ derive(stuck, held(moving(no), lasting(10))) } +stuck <- true.")
    found = beliefs_of(program, STANDARD)
    assert "stuck" in found.made
    assert "moving" in found.asked
