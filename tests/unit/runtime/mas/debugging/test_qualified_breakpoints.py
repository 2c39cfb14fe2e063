"""Breakpoints on lines with conditions, hit counts and log messages; breakpoints for failures; steps of one intention."""

import pytest
from debugged_runs import COUNTER
from test_breakpoints import stops

from jacaros import Mas
from jacaros.agents.language.diagnostics import AslError
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.debugging import Debugger


def line(number: int, **qualified: str) -> dict[str, object]:
    return {"line": {"file": "<bob>", "line": number, **qualified}}


def test_a_condition_of_a_line_sees_the_variables_of_the_plan_and_the_beliefs() -> None:
    assert [said[-1] for _, _, said in stops(line(5, condition="N = 1"))] == ["at1"]
    assert [said[-1] for _, _, said in stops(line(5, condition="count(C) & C > N - 1 & N > 0"))] == [
        "at1",
        "at2",
    ]
    assert stops(line(5, condition="unknown(N)")) == []


@pytest.mark.parametrize(
    ("hits", "expected"),
    [
        ("2", ["at1"]),
        ("= 1", ["at0"]),
        (">= 2", ["at1", "at2"]),
        ("< 2", ["at0"]),
        ("%2", ["at1"]),
        ("%0", []),
    ],
)
def test_a_hit_count_selects_visits(hits: str, expected: list[str]) -> None:
    assert [said[-1] for _, _, said in stops(line(5, hits=hits))] == expected


@pytest.mark.parametrize(
    "wrong", [{"hits": "often"}, {"condition": ".print(a)"}, {"log": "{.send(a,tell,b)}"}]
)
async def test_what_a_breakpoint_must_not_do_is_refused(wrong: dict[str, str], debugger: Debugger) -> None:
    with pytest.raises(UsageError):
        debugger.add_breakpoint(line(5, **wrong))


async def test_a_condition_with_an_error_is_refused(debugger: Debugger) -> None:
    with pytest.raises(AslError):
        debugger.add_breakpoint(line(5, condition="N >"))


async def test_a_log_message_is_logged_with_values_and_does_not_stop(mas: Mas, debugger: Debugger) -> None:
    logged: list[str] = []
    mas.system.listen_to_log(lambda text, level: logged.append(text))
    debugger.add_breakpoint(line(5, log="at {N}, {N + 1}; {count(X)}, {gone(_)}", hits="<= 2"))
    await mas.until_idle()
    assert not debugger.paused
    assert logged == ["[bob] at 0, 1; count(0), no", "[bob] at 1, 2; count(1), no"]


FAILING = """\
!go.
+!go
   <- .print(a);
      !missing;
      .print(never).
-!go
   <- .print(handled);
      ?nothing.
"""


def test_a_failure_stops_the_run_whether_or_not_it_is_handled() -> None:
    found = stops({"failure": "goal"}, FAILING)
    assert [(why.partition(" (")[0], said) for why, _, said in found] == [
        ("breakpoint goal fails: no_relevant, no relevant plan for !missing", ["a"]),
        ("breakpoint goal fails: test_goal_failed, a test found no answer", ["a", "handled"]),
    ]


def test_each_kind_of_failure_has_its_breakpoint() -> None:
    assert len(stops({"failure": "plan"}, FAILING)) == 1
    assert stops({"failure": "operation"}, FAILING) == []
    program = "!go. +!go <- unknownOperation(3)."
    assert len(stops({"failure": "operation"}, program)) == 1
    assert stops({"failure": "plan"}, program) == []


@pytest.mark.program(FAILING)
async def test_the_stack_of_a_failure_is_kept(mas: Mas, debugger: Debugger) -> None:
    debugger.add_breakpoint({"failure": "plan"})
    await debugger.wait_until_paused()
    failure = debugger.failure
    assert failure is not None
    assert (failure.agent, failure.error, failure.line, len(failure.frames)) == ("bob", "no_relevant", 4, 1)
    debugger.resume()
    assert debugger.failure is None


NESTED = """\
!go.
+!go
   <- .print(a);
      !inner;
      .print(b);
      .print(c).
+!inner
   <- .print(x);
      .print(y).
"""


async def stepped(debugger: Debugger, *kinds: str) -> list[int]:
    """The lines before which the run is paused after steps of these kinds."""
    lines = []
    for kind in kinds:
        debugger.step(kind)  # type: ignore[arg-type]
        lines.append((await debugger.wait_until_paused()).line)
    return lines


@pytest.mark.program(NESTED)
async def test_over_stays_in_the_plan_and_out_leaves_it(mas: Mas, debugger: Debugger) -> None:
    debugger.add_breakpoint(line(3))
    assert (await debugger.wait_until_paused()).line == 3
    assert await stepped(debugger, "over", "over", "over") == [4, 5, 6]


@pytest.mark.program(NESTED)
async def test_a_step_enters_the_subgoal_and_out_leaves_it(mas: Mas, debugger: Debugger) -> None:
    debugger.add_breakpoint(line(3))
    await debugger.wait_until_paused()
    assert await stepped(debugger, "step", "step", "out") == [4, 8, 5]


@pytest.mark.program(NESTED + "!other. +!other <- .print(o1); .print(o2); .print(o3); .print(o4).")
async def test_over_does_not_stop_in_another_intention(mas: Mas, debugger: Debugger) -> None:
    debugger.add_breakpoint(line(3))
    await debugger.wait_until_paused()
    assert await stepped(debugger, "over", "over", "over") == [4, 5, 6]


@pytest.mark.program(NESTED + "+next <- .print(n).")
async def test_after_the_end_of_the_intention_the_next_step_of_the_agent_stops(mas: Mas, debugger: Debugger):
    debugger.add_breakpoint(line(6))
    await debugger.wait_until_paused()
    debugger.step("out")
    mas.agent("bob").perceive("next")
    assert (await debugger.wait_until_paused()).line == 10


@pytest.mark.program("idle.")
async def test_over_needs_an_intention(debugger: Debugger) -> None:
    debugger.pause()
    with pytest.raises(UsageError, match="no intention is held"):
        debugger.step("over")


def test_all_kinds_can_be_written_as_data(lines: list[str]) -> None:
    from jacaros.runtime.mas.debugging.breakpoints import breakpoint_at

    for data in ({"failure": "plan"}, line(5, condition="N = 1", hits="2", log="x {N}"), line(5)):
        assert breakpoint_at(data).data() == data
    assert breakpoint_at(line(5, condition="N = 1")).text == "<bob>:5 if N = 1"
    assert COUNTER
    with pytest.raises(UsageError, match="unknown failure"):
        breakpoint_at({"failure": "robot"})
