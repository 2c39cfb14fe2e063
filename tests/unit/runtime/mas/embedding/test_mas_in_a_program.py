"""Agents, artifacts and projects in a Python program: `async with Mas(...) as mas`."""

import asyncio
import json
from functools import partial
from pathlib import Path

import pytest
from embedding_lab import Counter, run

import jacaros
from jacaros import Atom, Mas
from jacaros.agents.language.diagnostics import AslError
from jacaros.artifacts import OperationFailed, Out
from jacaros.runtime.clock import VirtualClock, WallClock, clock_of, new_event_loop
from jacaros.runtime.errors import UsageError
from jacaros.runtime.mas.deployment import ProjectError
from jacaros.runtime.mas.embedding.waits import RunEnded, UnknownAgent


async def test_an_agent_from_a_text_achieves_a_goal(mas: Mas, lines: list[str]) -> None:
    goal = mas.add_agent("bob", "+!greet(X) <- .wait(1000); .print(hello, X).").achieve("greet(world)")
    assert not goal.achieved
    await goal
    assert goal.achieved
    assert mas.clock.elapsed == pytest.approx(1.0)
    assert lines == ["[bob] helloworld"]
    mas.stop()
    assert mas.exit_code == 0


async def test_agents_come_from_files(mas: Mas, lines: list[str], tmp_path: Path) -> None:
    program = tmp_path / "ann.asl"
    program.write_text("!go. +!go : p(X) <- .print(X).", encoding="utf-8")
    mas.add_agent("ann", beliefs="p(1)")
    mas.add_agent("second", program, beliefs="p(2)")
    assert [agent.name for agent in mas.agents] == ["ann", "second"]
    await mas.until_idle()
    assert lines == ["[ann] 1", "[second] 2"]
    program.write_text("+!greet <- .print(hi).", encoding="utf-8")
    await mas.add_agent("bob", '{ include("ann.asl") }').achieve("greet")
    assert lines[2:] == ["[bob] hi"], "a program in a text includes files of the folder"


def test_a_project_runs_inside_a_program(tmp_path: Path) -> None:
    (tmp_path / "artifacts.py").write_text(
        "from jacaros.artifacts import Artifact\n\n\nclass Lamp(Artifact):\n"
        "    def init(self) -> None:\n        self.define_property('lit', False)\n",
        encoding="utf-8",
    )
    (tmp_path / "a.asl").write_text("+!stop <- .stopMAS(0, 3).", encoding="utf-8")
    project = tmp_path / "p.jcm"
    project.write_text("mas p { agent a { focus: lab.l } workspace lab { artifact l: Lamp() } }")

    async def test(mas: Mas) -> None:
        await mas.agent("a").until("lit(false)", timeout=1)
        mas.send("a", "achieve", "stop")
        assert await mas.ended() == 3
        assert mas.exit_code == 3
        with pytest.raises(RunEnded, match="the run has ended"):
            mas.add_agent("late", "!go.")

    assert run(test, [], [], project=project).exit_code == 3


async def test_artifacts_are_made_focused_and_used(mas: Mas) -> None:
    mas.add_artifact_types(Counter)
    lab = mas.create_workspace("lab")
    counter = await mas.make_artifact("counter", Counter, [1], workspace=lab)
    program = '+!go <- inc; makeArtifact(mine, "Counter", [7], Id); focus(Id); double(4, X); +doubled(X).'
    bob = mas.add_agent("bob", program, focus=[counter], join=["/main"])
    await bob.achieve("go")
    assert bob.answers("count(X)[artifact_name(N)]") == [
        {"X": 7, "N": Atom("mine")},
        {"X": 2, "N": Atom("counter")},
    ]
    assert bob.ask("doubled(X)") == {"X": 8}


async def test_focus_takes_names_and_paths(mas: Mas) -> None:
    mas.create_workspace("lab")
    for workspace in ("/main", "lab"):
        await mas.make_artifact("counter", Counter, [len(workspace)], workspace=workspace)
    for name, wanted, count in (
        ("a", "counter", 5),
        ("b", "lab/counter", 3),
        ("c", "/main/lab/counter", 3),
    ):
        agent = mas.add_agent(name, "!look. +!look : count(X) <- +seen(X).", focus=[wanted])
        assert await agent.until("seen(X)", timeout=1) == {"X": count}
    with pytest.raises(OperationFailed, match=r"unknown artifact `conter` .*; did you mean `counter`"):
        mas.add_agent("e", "", focus=["conter"])
    with pytest.raises(OperationFailed, match="unknown workspace `/main/lob`"):
        mas.add_agent("e", "", join=["lob"])
    assert "e" not in [agent.name for agent in mas.agents]


async def test_a_session_can_act_beside_the_agents(mas: Mas) -> None:
    await mas.make_artifact("counter", Counter, [5])
    bob = mas.add_agent("bob", "", focus=["counter"])
    painter = mas.session("painter")
    assert await painter.act("double", 4, Out()) == 8
    await painter.act("inc")
    assert await bob.until("count(X) & X > 5") == {"X": 6}
    with pytest.raises(OperationFailed, match="unknown workspace `/main/lab`"):
        mas.session("other", workspace="lab")


async def test_errors_are_raised_at_the_call(mas: Mas, tmp_path: Path) -> None:
    with pytest.raises(AslError, match=r"<bob>:1:16: error: expected a term"):
        mas.add_agent("bob", "+!go <- .print(.")
    with pytest.raises(UsageError, match=r"program not found: carl\.asl; expected in"):
        mas.add_agent("carl")
    mas.add_agent("bob", "")
    with pytest.raises(UsageError, match="duplicate agent name `bob`"):
        mas.add_agent("bob", "")
    with pytest.raises(UnknownAgent, match="unknown agent `bbo`; did you mean `bob`"):
        mas.agent("bbo")
    with pytest.raises(UnknownAgent, match="unknown agent `x`; agents: bob"):
        mas.agent("x")
    mas.add_artifact_types(Counter)
    with pytest.raises(OperationFailed, match="unknown artifact type `Countr`; did you mean `Counter`"):
        await mas.make_artifact("c", "Countr")
    with pytest.raises(OperationFailed, match="cannot create artifact"):
        await mas.make_artifact("c", Counter, ["far"])
    with pytest.raises(ProjectError, match=r"nothing.jcm"):
        Mas(tmp_path / "nothing.jcm")
    with pytest.raises(UsageError, match="unknown ROS backend 'ros3'"):
        Mas(ros="ros3")


async def test_a_system_is_used_inside_its_block() -> None:
    mas = Mas()
    assert repr(mas) == "<Mas mas, not begun>"
    with pytest.raises(RunEnded, match="use it inside `async with Mas"):
        mas.add_agent("bob", "")
    async with mas:
        assert repr(mas) == "<Mas mas, running>"
    with pytest.raises(UsageError, match="this Mas has already run"):
        async with mas:
            pass
    assert repr(mas) == "<Mas mas, ended with exit code 0>"


async def test_two_systems_share_a_loop(lines: list[str]) -> None:
    async with (
        Mas(name="one", on_print=lambda agent, text: lines.append(f"one {text}")) as one,
        Mas(name="two", on_print=lambda agent, text: lines.append(f"two {text}")) as two,
    ):
        for mas in (one, two):
            mas.add_agent("bob", "!go. +!go <- .wait(1000); .my_name(N); .print(N); +done.")
        await one.agent("bob").until("done")
        await two.agent("bob").until("done")
        one.stop(4)
        assert (one.exit_code, two.exit_code) == (4, None)
        await two.agent("bob").achieve("go")
    assert lines == ["one bob", "two bob", "two bob"]


def test_a_system_works_on_a_plain_loop_and_in_a_running_one() -> None:
    async def main() -> float:
        async with Mas(on_print=lambda agent, text: None) as mas:
            assert isinstance(mas.clock, WallClock)
            await mas.add_agent("bob", "+!go <- .wait(1).").achieve("go")
            return mas.clock.now()

    assert asyncio.run(main()) > VirtualClock().now()
    assert jacaros.run(main()) > VirtualClock().now()

    async def nested() -> None:
        coroutine = main()
        with pytest.raises(UsageError, match="await the coroutine"):
            jacaros.run(coroutine)

    asyncio.run(nested())
    with pytest.raises(UsageError, match="unknown clock `slow`"):
        jacaros.run(main(), clock="slow")  # type: ignore[arg-type]


def test_the_clock_of_a_loop_is_known() -> None:
    clock = VirtualClock()
    loop = new_event_loop(clock)
    assert clock_of(loop) is clock
    loop.close()


async def test_an_output_callback_that_raises_does_not_affect_agents(
    mas: Mas, lines: list[str], logs: list[str]
) -> None:
    def refuse(agent: str, text: str) -> None:
        raise ValueError("no printing")

    mas.on_print(refuse)
    await mas.add_agent("bob", "+!go <- .print(a); .print(b).").achieve("go")
    assert lines == ["[bob] a", "[bob] b"]
    assert "ValueError: no printing" in logs[0]


async def test_calls_from_another_thread_are_refused_with_a_fix(mas: Mas) -> None:
    bob = mas.add_agent("bob", "+!work(N) <- .print(N).")
    add = partial(mas.add_agent, "eve", "x.")
    for call in (partial(bob.achieve, "work(1)"), partial(bob.perceive, "x(1)"), add, mas.stop):
        with pytest.raises(UsageError, match=r"called in thread .*loop\.call_soon_threadsafe"):
            await asyncio.to_thread(call)
    assert mas.exit_code is None


@pytest.mark.parametrize("name", ["", "a b", "a\n[b] forged", "n\0"])
async def test_a_name_that_would_forge_output_is_refused(mas: Mas, name: str) -> None:
    with pytest.raises(UsageError, match="invalid agent name"):
        mas.add_agent(name, "x.")


async def test_an_agent_continues_in_another_run(mas: Mas, lines: list[str], logs: list[str]) -> None:
    program = "day(0). !work. +!work : day(N) <- -+day(N + 1); .print(N + 1); .wait(1000); !work."
    bob = mas.add_agent("bob", program)
    await mas.sleep(2.5)
    kept = json.dumps(bob.stored())
    mas.stop()
    async with Mas(on_print=lambda agent, text: lines.append(f"[{agent}] {text}")) as other:
        began = other.clock.now()
        await other.add_agent("bob", program, stored=json.loads(kept)).until("day(4)")
        assert other.clock.now() - began == pytest.approx(0.5), "half of the wait was left"
    assert lines == ["[bob] 1", "[bob] 2", "[bob] 3", "[bob] 4"]


async def test_an_agent_that_continues_perceives_anew(mas: Mas, lines: list[str]) -> None:
    program = "+door(X) <- +last(X); .print(X)."
    bob = mas.add_agent("bob", program)
    bob.perceive("door(open)")
    bob.perceive("door(wide)")
    await mas.until_idle()
    kept = bob.stored()
    bob.kill()
    bob = mas.add_agent("bob", program, stored=kept)
    bob.perceive("door(open)")
    await mas.until_idle()
    assert [each["X"] for each in bob.answers("door(X)")] == [Atom("open")]
    bob.perceive_no_more("door(open)")
    await mas.until_idle()
    assert not bob.believes("door(_)")
    assert bob.believes("last(wide)")
    assert lines == ["[bob] open", "[bob] wide", "[bob] open"]


async def test_there_is_no_agent_when_what_was_stored_does_not_fit_its_program(mas: Mas) -> None:
    bob = mas.add_agent("bob", "!go. +!go <- .wait(1000).")
    await mas.sleep(0.5)
    kept = bob.stored()
    bob.kill()
    with pytest.raises(ValueError, match="the program has changed"):
        mas.add_agent("bob", "+!go <- .print(other).", stored=kept)
    with pytest.raises(UsageError, match="is a Python agent"):
        mas.add_agent("ann", type("Ann", (jacaros.PythonAgent,), {}), stored=kept)
    mas.add_agent("bob", "!go. +!go <- .wait(1000).", stored=kept)
    assert [each.name for each in mas.agents] == ["bob"]


async def test_an_agent_in_the_middle_of_a_step_or_with_an_awaited_goal_is_not_stored(mas: Mas) -> None:
    bob = mas.add_agent("bob", "!now. +!now <- .print(now). +!go <- .wait(1000).")
    refused: list[str] = []

    def store(agent: str, text: str) -> None:
        with pytest.raises(UsageError, match="agent bob is in the middle of a step") as why:
            bob.stored()
        refused.append(f"{agent} {text} {why.typename}")

    mas.on_print(store)
    await mas.until_idle()
    assert refused == ["bob now UsageError"]
    goal = bob.achieve("go")
    await mas.sleep(0.5)
    with pytest.raises(jacaros.NotStorable, match="Python code awaits a goal"):
        bob.stored()
    await goal
    assert bob.stored()["agent"] == "bob"
