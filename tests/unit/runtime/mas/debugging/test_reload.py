"""Reload of changed programs during a run."""

from pathlib import Path
from typing import Any

import pytest

import jacaros
from jacaros import Mas
from jacaros.agents.language.diagnostics import AslError
from jacaros.agents.terms.values import String
from jacaros.runtime.mas.debugging.reload import NOTHING
from jacaros.runtime.mas.embedding.running_agent import literal

OLD = """\
size(3).
big(X) :- size(N) & X > N.
!go.
@work
+!go <- .print(old); .wait(1000); .print(old, end); !go.
+?answer(X) <- X = 1.
"""


def write(file: Path, text: str | None) -> None:
    """Write a file; None removes it."""
    if text is None:
        file.unlink()
    else:
        file.write_text(text, encoding="utf-8")


@pytest.fixture
def file(tmp_path: Path, request: pytest.FixtureRequest) -> Path:
    """The program of bob and ann."""
    mark = request.node.get_closest_marker("program")
    path = tmp_path / "robot.asl"
    write(path, mark.args[0] if mark else OLD)
    return path


@pytest.fixture(autouse=True)
def play(lines: list[str], file: Path):
    """Run a scene with agents bob and ann that run the same file."""

    async def main(scene: Any) -> None:
        mas = Mas(
            seed=1,
            folder=file.parent,
            on_print=lambda agent, text: lines.append(text) if agent == "bob" else None,
            on_log=lambda *line: None,
        )
        async with mas:
            mas.add_agent("bob", file)
            mas.add_agent("ann", file, beliefs="hair(red)")
            await scene(mas=mas)

    return lambda scene: jacaros.run(main(scene), clock="fast")


async def test_plans_and_rules_are_replaced_and_beliefs_and_intentions_kept(
    mas: Mas, file: Path, lines: list[str]
) -> None:
    await mas.sleep(0.5)
    bob = mas.agent("bob")
    bob.add_belief("own(1)")
    before = bob.beliefs
    assert bob.believes("big(4)")
    new = OLD.replace("(old", "(new").replace("X > N", "X > N + 10")
    write(file, f"{new}+!more <- .print(more).\nsize(4).\n!more.\n")
    told = mas.debugger.reload()
    assert f"agent bob: intention 1 continues with its old plan +!go ({file}:4)" in told
    assert "agent bob: 1 plan removed, 2 new, 1 unchanged" in told
    assert "agent ann: 1 plan removed, 2 new, 1 unchanged" in told
    assert "agent bob: the new initial belief size(4) is not adopted" in told
    assert "agent ann: the new initial goal more is not adopted" in told
    assert len(told) == 8
    assert bob.beliefs == before
    assert not bob.believes("big(4)")
    assert bob.believes("big(14)")
    await mas.sleep(1.0)
    assert lines == ["old", "oldend", "new"]
    await bob.achieve("more")
    third = mas.add_agent("third", file)
    await mas.sleep(1.0)
    assert "new" in lines[4:]
    assert third.mind.program.plans == bob.mind.program.plans


async def test_a_wrong_or_unchanged_program_replaces_nothing(mas: Mas, file: Path, lines: list[str]) -> None:
    await mas.sleep(0.5)
    library = mas.agent("bob").mind.library
    plans = library.plans
    assert mas.debugger.reload() == [NOTHING]
    assert mas.agent("bob").mind.library is library
    write(file, OLD.replace("old, end", "old, end("))
    with pytest.raises(AslError, match=r"robot.asl:5"):
        mas.debugger.reload()
    assert mas.agent("bob").mind.library.plans is plans
    mas.add_agent("third", file)
    write(file, None)
    with pytest.raises(AslError):
        mas.debugger.reload()
    await mas.sleep(1.0)
    assert lines == ["old", "oldend", "old"]


ABC = "@a +!a <- .print(a). @b +!b <- .print(b). +!c <- .print(c)."


@pytest.mark.program(ABC)
async def test_plans_of_run_time_stay_and_removed_ones_stay_away(mas: Mas, file: Path, lines: list[str]):
    bob = mas.agent("bob")
    await bob.achieve("c")
    bob.mind.remove_plan(literal("a"))
    bob.mind.add_plan(String("+!d <- .print(own)."))
    bob.mind.add_plan(String("+!c <- .print(first)."), first=True)
    write(file, ABC.replace("print(b)", "print(newb)"))
    mas.debugger.reload()
    for goal in ("b", "c", "d"):
        await bob.achieve(goal)
    lost = bob.achieve("a")
    await mas.until_idle()
    assert lost.failed
    write(file, ABC.replace("print(a)", "print(newa)"))
    mas.debugger.reload()
    for goal in ("a", "b", "c", "d"):
        await bob.achieve(goal)
    assert lines == ["c", "newb", "first", "own", "newa", "b", "first", "own"]


@pytest.mark.program("ready.")
async def test_a_changed_file_that_is_included_counts(mas: Mas, file: Path, lines: list[str]) -> None:
    part = file.with_name("part.asl")
    write(part, "+!a <- .print(one).")
    write(file, '{ include("part.asl") } ready.')
    mas.debugger.reload()
    await mas.agent("bob").achieve("a")
    write(part, "+!a <- .print(two).")
    assert mas.debugger.reload() != [NOTHING]
    await mas.agent("bob").achieve("a")
    assert lines == ["one", "two"]


@pytest.mark.program("!go. +!go <- .print(reload); .print(old); !next. +!next <- .print(old).")
async def test_a_reload_in_the_middle_of_a_step_waits_for_its_end(mas: Mas, file: Path, lines: list[str]):
    def printed(agent: str, text: str) -> None:
        if (agent, text) == ("bob", "reload"):
            write(file, file.read_text("utf-8").replace("print(old)", "print(new)"))
            mas.debugger.reload()

    mas.on_print(printed)
    await mas.until_idle()
    assert lines == ["reload", "old", "new"]


async def test_a_breakpoint_in_a_reloaded_file_stops_at_its_new_line(mas: Mas, file: Path) -> None:
    await mas.sleep(0.5)
    write(file, "// one more line\n" + OLD)
    mas.debugger.reload()
    mas.debugger.add_breakpoint({"line": {"file": "robot.asl", "line": 6}})
    state = await mas.debugger.wait_until_paused()
    assert (state.line, mas.clock.elapsed) == (6, 1.0)


async def test_records_name_the_plans_of_the_reloaded_program(mas: Mas, file: Path) -> None:
    history = mas.system.history()
    history.start()

    def records(event: str) -> list[Any]:
        return [each.data for each in history.events if each.event == event]

    await mas.sleep(0.5)
    write(file, "// one more line\n" + OLD.replace("(old", "(new"))
    mas.debugger.pause()
    mas.debugger.reload()
    heads = [source["text"].splitlines()[0] for source in records("source")]
    assert heads == ["size(3).", "// one more line"]
    mas.debugger.resume()
    await mas.sleep(1.0)
    newest = {each["agent"]: {plan["id"]: plan for plan in each["plans"]} for each in records("program")}
    chosen = records("deliberation")[-1]
    plan = newest[chosen["agent"]][chosen["chosen"]]
    assert (plan["trigger"], plan["line"]) == ("+!go", 5)
    assert min(newest["bob"]) > 2, "numbers of plans are given once"
