"""Reload of changed programs during a run."""

from collections.abc import Awaitable, Callable
from pathlib import Path

import pytest

import jacaros
from jacaros import Mas
from jacaros.agents.language.diagnostics import AslError
from jacaros.runtime.mas.debugging.reload import NOTHING

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


def reloaded(
    tmp_path: Path,
    test: Callable[[Mas, Path, list[str]], Awaitable[None]],
    old: str = OLD,
    **files: str,
) -> list[str]:
    """Run *test* with agents bob and ann that run the file robot.asl. Return their output."""
    lines: list[str] = []
    file = tmp_path / "robot.asl"
    write(file, old)
    for name, text in files.items():
        write(tmp_path / f"{name}.asl", text)

    async def main() -> None:
        mas = Mas(
            seed=1,
            folder=tmp_path,
            on_print=lambda agent, text: lines.append(f"{agent} {text}"),
            on_log=lambda *line: None,
        )
        async with mas:
            mas.add_agent("bob", file)
            mas.add_agent("ann", file, beliefs="hair(red)")
            await test(mas, file, lines)

    jacaros.run(main(), clock="fast")
    return lines


def test_plans_and_rules_are_replaced_and_beliefs_and_intentions_kept(tmp_path: Path) -> None:
    async def test(mas: Mas, file: Path, lines: list[str]) -> None:
        await mas.sleep(0.5)
        bob = mas.agent("bob")
        bob.add_belief("own(1)")
        before = bob.beliefs
        assert bob.believes("big(4)")
        write(
            file,
            OLD.replace("(old", "(new").replace("X > N", "X > N + 10")
            + "+!more <- .print(more).\nsize(4).\n!more.\n",
        )
        told = mas.reload()
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
        assert [line for line in lines if line.startswith("bob")] == ["bob old", "bob oldend", "bob new"]
        await bob.achieve("more")
        third = mas.add_agent("third", file)
        await mas.sleep(0.1)
        assert "third new" in lines
        assert third.mind.program.plans == bob.mind.program.plans

    reloaded(tmp_path, test)


def test_a_wrong_program_is_reported_and_nothing_is_replaced(tmp_path: Path) -> None:
    async def test(mas: Mas, file: Path, lines: list[str]) -> None:
        await mas.sleep(0.5)
        plans = mas.agent("bob").mind.library.plans
        write(file, OLD.replace("old, end", "old, end("))
        with pytest.raises(AslError, match=r"robot.asl:5"):
            mas.reload()
        assert mas.agent("bob").mind.library.plans is plans
        mas.add_agent("third", file)
        write(file, None)
        with pytest.raises(AslError):
            mas.reload()
        await mas.sleep(1.0)

    lines = reloaded(tmp_path, test)
    assert [line for line in lines if line.startswith("bob")] == ["bob old", "bob oldend", "bob old"]


def test_an_unchanged_program_is_not_reloaded(tmp_path: Path) -> None:
    async def test(mas: Mas, file: Path, lines: list[str]) -> None:
        await mas.sleep(0.5)
        library = mas.agent("bob").mind.library
        assert mas.reload() == [NOTHING]
        assert mas.agent("bob").mind.library is library

    reloaded(tmp_path, test)


def test_plans_of_run_time_stay_and_removed_ones_stay_away(tmp_path: Path) -> None:
    old = "@a +!a <- .print(a). @b +!b <- .print(b). +!c <- .print(c)."

    async def test(mas: Mas, file: Path, lines: list[str]) -> None:
        bob = mas.agent("bob")
        await bob.achieve("c")
        bob.mind.remove_plan(jacaros.runtime.mas.embedding.running_agent.literal("a"))
        bob.mind.add_plan(jacaros.agents.terms.values.String("+!d <- .print(own)."))
        bob.mind.add_plan(jacaros.agents.terms.values.String("+!c <- .print(first)."), first=True)
        write(file, old.replace("print(b)", "print(newb)"))
        mas.reload()
        for goal in ("b", "c", "d"):
            await bob.achieve(goal)
        lost = bob.achieve("a")
        await mas.until_idle()
        assert lost.failed
        write(file, old.replace("print(a)", "print(newa)"))
        mas.reload()
        for goal in ("a", "b", "c", "d"):
            await bob.achieve(goal)

    lines = reloaded(tmp_path, test, old)
    said = [line.removeprefix("bob ") for line in lines if line.startswith("bob")]
    assert said == ["c", "newb", "first", "own", "newa", "b", "first", "own"]


def test_a_changed_file_that_is_included_counts(tmp_path: Path) -> None:
    async def test(mas: Mas, file: Path, lines: list[str]) -> None:
        await mas.agent("bob").achieve("a")
        write(tmp_path / "part.asl", "+!a <- .print(two).")
        assert mas.reload() != [NOTHING]
        await mas.agent("bob").achieve("a")

    old = '{ include("part.asl") } ready.'
    assert reloaded(tmp_path, test, old, part="+!a <- .print(one).") == ["bob one", "bob two"]


def test_a_reload_in_the_middle_of_a_step_waits_for_its_end(tmp_path: Path) -> None:
    file = tmp_path / "robot.asl"
    write(file, "!go. +!go <- .print(reload); .print(old); !next. +!next <- .print(old).")
    lines: list[str] = []

    async def main() -> None:
        mas: Mas

        def printed(agent: str, text: str) -> None:
            lines.append(text)
            if text == "reload":
                write(file, file.read_text("utf-8").replace("print(old)", "print(new)"))
                mas.reload()

        mas = Mas(seed=1, folder=tmp_path, on_print=printed)
        async with mas:
            mas.add_agent("bob", file)
            await mas.until_idle()

    jacaros.run(main(), clock="fast")
    assert lines == ["reload", "old", "new"]


def test_a_breakpoint_in_a_reloaded_file_stops_at_its_new_line(tmp_path: Path) -> None:
    async def test(mas: Mas, file: Path, lines: list[str]) -> None:
        await mas.sleep(0.5)
        write(file, "// one more line\n" + OLD)
        mas.reload()
        mas.debugger.add_breakpoint({"line": {"file": "robot.asl", "line": 6}})
        state = await mas.debugger.wait_until_paused()
        assert (state.line, mas.clock.elapsed) == (6, 1.0)
        mas.debugger.resume()

    reloaded(tmp_path, test)


def test_records_name_the_plans_of_the_reloaded_program(tmp_path: Path) -> None:
    async def test(mas: Mas, file: Path, lines: list[str]) -> None:
        history = mas.system.history()
        history.start()
        await mas.sleep(0.5)
        write(file, "// one more line\n" + OLD.replace("(old", "(new"))
        mas.debugger.pause()
        mas.reload()
        sources = [each.data for each in history.events if each.event == "source"]
        assert [source["text"].splitlines()[0] for source in sources] == ["size(3).", "// one more line"]
        mas.debugger.resume()
        await mas.sleep(1.0)
        programs = [each.data for each in history.events if each.event == "program"]
        newest = {each["agent"]: {plan["id"]: plan for plan in each["plans"]} for each in programs}
        chosen = [each.data for each in history.events if each.event == "deliberation"][-1]
        plan = newest[chosen["agent"]][chosen["chosen"]]
        assert (plan["trigger"], plan["line"]) == ("+!go", 5)
        assert min(newest["bob"]) > 2, "numbers of plans are given once"

    reloaded(tmp_path, test)
