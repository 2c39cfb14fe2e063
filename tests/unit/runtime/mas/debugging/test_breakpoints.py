"""Breakpoints stop a run before their step, event or condition."""

import asyncio
from collections.abc import Mapping
from typing import Any

import pytest
from debugged_runs import COUNTER, debugged

from jacaros import Mas
from jacaros.agents.language.diagnostics import AslError
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.debugging import Debugger
from jacaros.runtime.mas.debugging.breakpoints import breakpoint_at


def stops(at: Mapping[str, Any], program: str = COUNTER) -> list[tuple[str, int, list[str]]]:
    """Why, at which line, and after which prints a run stopped, until bob has nothing to do."""
    found: list[tuple[str, int, list[str]]] = []
    lines: list[str] = []

    async def test(mas: Mas) -> None:
        mas.debugger.add_breakpoint(at)
        idle = asyncio.ensure_future(mas.until_idle())
        while True:
            paused = asyncio.ensure_future(mas.debugger.wait_until_paused())
            await asyncio.wait({paused, idle}, return_when=asyncio.FIRST_COMPLETED)
            if idle.done():
                paused.cancel()
                break
            state = paused.result()
            found.append((state.why, state.line, list(lines)))
            mas.debugger.resume()

    debugged(test, program, lines)
    if program is COUNTER:
        assert lines[-1] == "over", "the run continues to its end"
    return found


def at_line(line: int, file: str = "<bob>") -> dict[str, Any]:
    return {"line": {"file": file, "line": line}}


def test_a_line_stops_the_run_before_its_first_step_each_time() -> None:
    why = "breakpoint <bob>:5"
    assert stops(at_line(5)) == [
        (why, 5, ["at0"]),
        (why, 5, ["at0", "counted", "at1"]),
        (why, 5, ["at0", "counted", "at1", "counted", "at2"]),
    ]


def test_the_line_of_a_trigger_stops_the_run_before_the_first_step_of_the_plan() -> None:
    assert [line for _, line, _ in stops(at_line(3))] == [4, 4, 4]
    assert [line for _, line, _ in stops(at_line(9))] == [10]
    assert stops(at_line(4, "ob>")) == [], "another file"


async def test_a_line_without_a_step_is_refused_and_the_next_one_named(debugger: Debugger) -> None:
    with pytest.raises(UsageError, match="no step on line 2 of <bob>; the next one is on line 3"):
        debugger.add_breakpoint(at_line(2))
    with pytest.raises(UsageError, match=r"no step on line 99 of <bob>$"):
        debugger.add_breakpoint(at_line(99))


def test_lines_inside_loops_and_branches_stop_the_run() -> None:
    program = """\
!go.
+!go
   <- for (.member(X, [1, 2])) {
         if (X > 1) {
            .print(big, X)
         } else {
            .print(small, X)
         }
      };
      .print(end).
"""
    found = {line: stops(at_line(line), program) for line in (3, 4, 5, 7, 10)}
    assert {line: len(each) for line, each in found.items()} == {3: 1, 4: 2, 5: 1, 7: 1, 10: 1}
    assert found[5][0][2] == ["small1"]


def test_a_line_of_the_interpreter_stops_too(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("JACAROS_PLAIN", "1")
    assert [line for _, line, _ in stops(at_line(5))] == [5, 5, 5]
    assert [line for _, line, _ in stops(at_line(9))] == [10]


def test_a_plan_stops_the_run_before_its_first_step() -> None:
    assert stops({"plan": {"plan": "last", "agent": "bob"}}) == [
        ("breakpoint @last of bob", 10, ["at0", "counted", "at1", "counted", "at2", "counted"])
    ]
    assert stops({"plan": {"plan": "last", "agent": "ann"}}) == []


@pytest.mark.parametrize(
    ("pattern", "times"),
    [
        ("+!go", 4),
        ("+count(_)", 4),
        ("+count(2)", 1),
        ("+count(N)[source(self)]", 4),
        ("+count(_)[source(ann)]", 0),
        ("-!go", 0),
    ],
)
def test_an_event_stops_the_run_before_a_plan_is_selected(pattern: str, times: int) -> None:
    program = COUNTER + "+count(N) <- .print(noticed, N).\n"
    found = stops({"event": pattern}, program)
    assert [why for why, _, _ in found] == [f"breakpoint {pattern}"] * times
    if pattern == "+count(2)":
        assert "noticed2" not in found[0][2]


def test_a_condition_stops_the_run_when_it_becomes_true_and_not_while_it_stays_true() -> None:
    found = stops({"condition": "count(N) & N > 1", "agent": "bob"})
    assert found == [("breakpoint count(N) & N > 1 of bob with N=2", 5, ["at0", "counted", "at1"])]


@pytest.mark.program("ready.")
async def test_a_condition_becomes_true_by_a_percept_that_no_plan_handles(mas: Mas, debugger: Debugger):
    debugger.add_breakpoint({"condition": "battery(B) & B < 20", "agent": "bob"})
    bob = mas.agent("bob")
    bob.perceive("battery(50)")
    await mas.sleep(1.0)
    assert not debugger.paused
    bob.perceive("battery(10)")
    state = await debugger.wait_until_paused()
    assert state.why == "breakpoint battery(B) & B < 20 of bob with B=10"


def test_an_endless_condition_does_not_block_the_run() -> None:
    program = "p(X) :- p(X). !go. +!go <- .print(a); .print(b)."
    assert stops({"condition": "p(1)", "agent": "bob"}, program) == []


async def test_breakpoints_apply_to_agents_created_later(mas: Mas, debugger: Debugger, lines: list[str]):
    debugger.add_breakpoint({"event": "+!later(_)"})
    await mas.sleep(5.0)
    mas.add_agent("ann", "!later(1). +!later(X) <- .print(later, X).")
    state = await debugger.wait_until_paused()
    assert (state.agent, state.why) == ("ann", "breakpoint +!later(_)")
    assert "later1" not in lines
    debugger.resume()
    await mas.until_idle()
    assert "later1" in lines


async def test_a_removed_breakpoint_stops_nothing_and_costs_nothing(
    mas: Mas, debugger: Debugger, lines: list[str]
) -> None:
    at = at_line(5)
    debugger.add_breakpoint(at)
    debugger.add_breakpoint(at)
    assert [each.text for each in debugger.breakpoints] == ["<bob>:5"]
    assert debugger.state.data()["breakpoints"] == [at]
    await debugger.wait_until_paused()
    assert debugger.remove_breakpoint(at)
    assert not debugger.remove_breakpoint(at)
    assert debugger.state.breakpoints == ()
    debugger.resume()
    await mas.until_idle()
    mind = mas.agent("bob").mind
    assert mind.observers.step is None
    assert not mind.observers.hear_beliefs
    assert lines[-1] == "over"


@pytest.mark.parametrize(
    ("at", "error"),
    [
        ({}, UsageError),
        ({"line": 3}, UsageError),
        ({"line": {"file": "a.asl"}}, UsageError),
        ({"plan": "x"}, UsageError),
        ({"condition": "p"}, UsageError),
        ({"event": "+X"}, UsageError),
        ({"condition": ".send(bob, tell, x)", "agent": "bob"}, UsageError),
        ({"event": "go("}, AslError),
        ({"condition": "p(", "agent": "bob"}, AslError),
    ],
)
async def test_invalid_breakpoints_are_refused(
    debugger: Debugger, at: dict[str, Any], error: type[Exception]
) -> None:
    with pytest.raises(error):
        debugger.add_breakpoint(at)
    assert debugger.breakpoints == []


ATOMIC = "!go. @a[atomic] +!go <- .print(a); !b; .print(c). +!b <- .print(b)."


@pytest.mark.program(ATOMIC)
async def test_an_atomic_plan_is_held_too(mas: Mas, debugger: Debugger, lines: list[str]) -> None:
    states: list[str] = []
    debugger.listen(lambda state: states.append(state.state))
    debugger.add_breakpoint({"event": "+!b"})
    await debugger.wait_until_paused()
    assert lines == ["a"]
    debugger.resume()
    await mas.until_idle()
    assert lines == ["a", "b", "c"]
    # The first record lists the breakpoints.
    assert states == ["running", "paused", "running"]


async def test_records_show_the_step_before_which_an_agent_is_held(mas: Mas, debugger: Debugger) -> None:
    history = mas.system.history()
    history.start()
    debugger.add_breakpoint(at_line(6))
    await debugger.wait_until_paused()
    newest = [each.data for each in history.events if each.event == "intention"][-1]
    assert (newest["state"], newest["stack"][-1]["line"]) == ("runs", 6)
    assert newest["stack"][-1]["step"] == ".wait(100)"


@pytest.mark.parametrize(
    ("pattern", "times"), [("+count(_)", 3), ("-count(_)", 3), ("+count(2)", 1), ("-count(9)", 0)]
)
def test_a_belief_change_that_no_plan_handles_stops_the_run_before_the_next_step(pattern: str, times: int):
    found = stops({"event": pattern})
    assert [why for why, _, _ in found] == [f"breakpoint {pattern}"] * times
    if pattern == "+count(2)":
        assert (found[0][1], found[0][2][-1]) == (5, "at1"), "before the step behind the change"


@pytest.mark.parametrize("program", ["ready.", "ready. +other <- true.", "ready. +!seen(X) <- true."])
async def test_percepts_and_signals_that_no_plan_handles_stop_the_run(
    mas: Mas, debugger: Debugger, program: str
) -> None:
    debugger.add_breakpoint({"event": "+seen(key)"})
    ann = mas.add_agent("ann", program)
    for give in (ann.perceive, ann.signal):
        give("seen(door)")
        await mas.sleep(1.0)
        assert not debugger.paused
        give("seen(key)")
        assert (await debugger.wait_until_paused()).why == "breakpoint +seen(key)"
        debugger.resume()
        ann.perceive_no_more("seen(key)")
        await mas.sleep(1.0)
        assert not debugger.paused


@pytest.mark.parametrize(
    "at",
    [
        {"line": {"file": "a.asl", "line": 3}},
        {"plan": {"plan": "dock", "agent": "bob"}},
        {"event": "+!go(_)", "agent": None},
        {"condition": "battery(B) & B < 20", "agent": "bob"},
    ],
)
def test_a_breakpoint_is_described_by_the_data_that_makes_it(at: dict[str, Any]) -> None:
    assert breakpoint_at(at).data() == at
