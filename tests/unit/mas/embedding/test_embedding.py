"""Agents, artifacts and messages in a Python program: `async with Mas(...) as mas`."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import pytest

import jacaros
from jacaros import Atom, GoalFailed, Mas, Structure
from jacaros.asl.errors import AslError
from jacaros.bdi.agent import Agent
from jacaros.clock import VirtualClock, WallClock, clock_of, new_event_loop
from jacaros.env import Artifact, OperationFailed, Out, operation
from jacaros.errors import InternalError, UsageError
from jacaros.mas.deployment import AgentSpec, FocusSpec, ProjectError
from jacaros.mas.embedding.errors import AgentEnded, RunEnded, UnknownAgent
from jacaros.mas.embedding.mailbox import Mailbox
from jacaros.mas.embedding.running_agent import RunningAgent

Test = Callable[[Mas], Awaitable[None]]


class Counter(Artifact):
    """Counts."""

    def init(self, start: int = 0) -> None:
        self.define_property("count", start)
        self.stopped = False

    @operation
    def inc(self, by: int = 1) -> None:
        self.update_property("count", self.value("count") + by)

    @operation
    async def drive(self) -> None:
        try:
            await self.sleep(1000)
        finally:
            self.stopped = True
            self.resources["console"]("counter", "standing")

    @operation
    def double(self, number: int, result: Out) -> None:
        result.set(2 * number)


def run(test: Test, lines: list[str] | None = None, logs: list[str] | None = None, **options: object) -> Mas:
    """Run a test in a system of its own, on the virtual clock."""

    def printed(agent: str, text: str) -> None:
        if lines is not None:
            lines.append(f"[{agent}] {text}")

    def logged(text: str, level: str) -> None:
        if logs is not None:
            logs.append(text)

    async def main() -> Mas:
        async with Mas(seed=1, on_print=printed, on_log=logged, **options) as mas:  # type: ignore[arg-type]
            await test(mas)
        return mas

    return jacaros.run(main(), clock="fast")


def test_an_agent_from_a_text_achieves_a_goal() -> None:
    async def test(mas: Mas) -> None:
        bob = mas.add_agent("bob", "+!greet(X) <- .wait(1000); .print(hello, X).")
        goal = bob.achieve("greet(world)")
        assert not goal.achieved
        await goal
        assert goal.achieved
        assert mas.clock.now() - began == pytest.approx(1.0)

    began = VirtualClock().now()
    lines: list[str] = []
    mas = run(test, lines)
    assert lines == ["[bob] helloworld"]
    assert mas.exit_code == 0


def test_agents_come_from_files_and_specs(tmp_path: Path) -> None:
    (tmp_path / "ann.asl").write_text("!go. +!go : p(X) <- .print(X).", encoding="utf-8")

    async def test(mas: Mas) -> None:
        mas.add_agent("ann", beliefs="p(1)")
        mas.add_agent("second", tmp_path / "ann.asl", beliefs="p(2)")
        mas.add_agent(AgentSpec("third", tmp_path / "ann.asl", beliefs="p(3)"))
        assert [agent.name for agent in mas.agents] == ["ann", "second", "third"]
        await mas.until_idle()

    lines: list[str] = []
    run(test, lines, folder=tmp_path)
    assert lines == ["[ann] 1", "[second] 2", "[third] 3"]


def test_a_program_in_a_text_includes_files_of_the_folder(tmp_path: Path) -> None:
    (tmp_path / "greeting.asl").write_text("+!greet <- .print(hi).", encoding="utf-8")

    async def test(mas: Mas) -> None:
        await mas.add_agent("bob", '{ include("greeting.asl") }').achieve("greet")

    lines: list[str] = []
    run(test, lines, folder=tmp_path)
    assert lines == ["[bob] hi"]


def test_a_project_runs_inside_a_program(tmp_path: Path) -> None:
    (tmp_path / "artifacts.py").write_text(
        "from jacaros.env import Artifact\n\n\nclass Lamp(Artifact):\n"
        "    def init(self) -> None:\n        self.define_property('lit', False)\n",
        encoding="utf-8",
    )
    (tmp_path / "a.asl").write_text("+!stop <- .stopMAS(0, 3).", encoding="utf-8")
    project = tmp_path / "p.jcm"
    project.write_text(
        "mas p {\n agent a {\n focus: lab.l\n }\n workspace lab {\n artifact l: Lamp()\n }\n}\n"
    )

    async def test(mas: Mas) -> None:
        await mas.agent("a").until("lit(false)", timeout=1)
        mas.send("a", "achieve", "stop")
        assert await mas.ended() == 3
        assert mas.exit_code == 3
        with pytest.raises(RunEnded, match="the run has ended"):
            mas.add_agent("late", "!go.")

    assert run(test, project=project).exit_code == 3


def test_artifacts_are_made_focused_and_used() -> None:
    async def test(mas: Mas) -> None:
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

    run(test)


def test_focus_takes_names_paths_and_specs() -> None:
    async def test(mas: Mas) -> None:
        mas.create_workspace("lab")
        for workspace in ("/main", "lab"):
            await mas.make_artifact("counter", Counter, [len(workspace)], workspace=workspace)
        for name, wanted, count in (
            ("a", "counter", 5),
            ("b", "lab/counter", 3),
            ("c", "/main/lab/counter", 3),
            ("d", FocusSpec("counter", "lab"), 3),
        ):
            agent = mas.add_agent(name, "!look. +!look : count(X) <- +seen(X).", focus=[wanted])
            assert await agent.until("seen(X)", timeout=1) == {"X": count}
        with pytest.raises(OperationFailed, match="no artifact conter; did you mean counter"):
            mas.add_agent("e", "", focus=["conter"])
        with pytest.raises(OperationFailed, match="no workspace /main/lob"):
            mas.add_agent("e", "", join=["lob"])
        assert "e" not in [agent.name for agent in mas.agents]

    run(test)


def test_a_condition_is_waited_for() -> None:
    async def test(mas: Mas) -> None:
        await mas.make_artifact("counter", Counter)
        bob = mas.add_agent("bob", "big(X) :- count(X) & X > 2.", focus=["counter"])
        painter = mas.session("painter")

        async def count() -> None:
            for _ in range(4):
                await mas.sleep(1)
                await painter.act("inc")

        counting = asyncio.ensure_future(count())
        assert await bob.until("big(X)", timeout=10) == {"X": 3}
        assert mas.clock.now() - began == pytest.approx(3.0)
        assert await bob.until("big(X)") == {"X": 3}
        await counting

    began = VirtualClock().now()
    run(test)


def test_a_condition_that_does_not_come_in_time_tells_what_there_is() -> None:
    async def test(mas: Mas) -> None:
        bob = mas.add_agent("bob", "count(1). other(2).")
        with pytest.raises(TimeoutError) as late:
            await bob.until("count(X) & X > 2", timeout=1.5)
        assert (
            str(late.value)
            == "count(X) & X > 2 did not hold for agent bob (it believes count(1)) within 1.5 s"
        )
        assert mas.clock.now() - began == pytest.approx(1.5)
        assert bob.mind.condition_waits == []
        with pytest.raises(AslError):
            await bob.until("count(X")

    began = VirtualClock().now()
    run(test)


def test_a_cancelled_wait_leaves_nothing_behind() -> None:
    async def test(mas: Mas) -> None:
        bob = mas.add_agent("bob", "+!long <- .wait(10000).")
        for waiting in (bob.until("never"), bob.achieve("long").wait()):
            task = asyncio.ensure_future(waiting)
            await mas.sleep(0.1)
            task.cancel()
            with pytest.raises(asyncio.CancelledError):
                await task
        assert bob.mind.condition_waits == []
        assert bob.goals == ["long"]

    run(test)


def test_beliefs_percepts_and_signals_are_given() -> None:
    async def test(mas: Mas) -> None:
        bob = mas.add_agent(
            "bob",
            "+door(X)[source(S)] <- .print(door, X, S). +knock <- .print(knock). -door(X) <- .print(gone, X).",
        )
        bob.perceive("door(open)")
        await bob.until("door(open)")
        bob.signal("knock")
        bob.add_belief("door(shut)", "door(red)[source(ann)]")
        assert bob.believes("door(shut)[source(self)] & door(red)[source(ann)]")
        bob.perceive_no_more("door(open)")
        bob.remove_belief("door(shut)")
        await mas.until_idle()
        assert bob.beliefs == ["door(red)[source(ann)]"]
        with pytest.raises(ValueError, match="a percept has no variables"):
            bob.perceive("door(X)")

    lines: list[str] = []
    run(test, lines)
    assert sorted(lines) == sorted(
        [
            "[bob] dooropenpercept",
            "[bob] knock",
            "[bob] doorshutself",
            "[bob] doorredann",
            "[bob] goneopen",
            "[bob] goneshut",
        ]
    )


def test_an_agent_may_be_given_things_while_it_prints() -> None:
    agents: list[RunningAgent] = []

    async def main() -> None:
        async with Mas(on_print=lambda agent, text: agents[0].add_belief(f"said({text})")) as mas:
            agents.append(mas.add_agent("bob", "+!go <- .print(one); ?said(one); .print(two)."))
            await agents[0].achieve("go")
            await agents[0].until("said(two)", timeout=1)

    jacaros.run(main(), clock="fast")


def test_a_failed_goal_raises_with_its_reasons() -> None:
    async def test(mas: Mas) -> None:
        await mas.make_artifact("counter", Counter)
        bob = mas.add_agent(
            "bob", '+!go <- .fail(blocked(wall), error_msg("no way")). +!add <- inc(far). +!fly <- soar.'
        )
        with pytest.raises(GoalFailed) as failed:
            await bob.achieve("go")
        assert (
            str(failed.value)
            == "goal !go of agent bob failed: no way (blocked(wall), error(internal_action)), in <bob>:1"
        )
        assert failed.value.goal == "go"
        assert failed.value.message == "no way"
        assert Structure("blocked", (Atom("wall"),)) in failed.value.reasons
        assert failed.value.reason("blocked") == "wall"
        assert failed.value.reason("other") is None
        with pytest.raises(GoalFailed, match="no relevant plan for !missing"):
            await bob.achieve("missing")
        with pytest.raises(GoalFailed) as failed:
            await bob.achieve("add")
        assert failed.value.reason("env_failure_reason").functor == "wrong_op_arguments"  # type: ignore[attr-defined]
        with pytest.raises(GoalFailed) as failed:
            await bob.achieve("fly")
        assert failed.value.message == "no artifact of workspace /main has an operation soar/0"

    run(test)


def test_waiting_for_ever_on_the_virtual_clock_raises() -> None:
    async def test(mas: Mas) -> None:
        bob = mas.add_agent("bob", '+!long <- .wait("+never"). +!later(N) <- .wait(N); +later.')
        bob.achieve("later(5000)")
        assert await bob.until("later") == {}
        for waiting in (bob.achieve("long").wait(), bob.until("p"), mas.mailbox("me").get()):
            with pytest.raises(TimeoutError, match="and nothing more will happen: everybody waits"):
                await waiting
        assert await asyncio.to_thread(lambda: 7) == 7

    run(test)


def test_goals_can_be_dropped_and_late() -> None:
    async def test(mas: Mas) -> None:
        bob = mas.add_agent("bob", "+!long <- .wait(10000). +!forget <- .drop_intention(long).")
        goal = bob.achieve("long")
        with pytest.raises(TimeoutError, match=r"bob did not achieve !long \(it is waiting\) within 2 s"):
            await goal.wait(timeout=2)
        assert goal.state == "waiting"
        goal.drop()
        with pytest.raises(GoalFailed, match="goal !long of agent bob was dropped"):
            await goal
        waiting = asyncio.ensure_future(bob.achieve("long").wait())
        await mas.sleep(1)
        bob.achieve("forget")
        with pytest.raises(GoalFailed, match="was dropped"):
            await waiting

    run(test)


def test_python_code_has_mailboxes() -> None:
    async def test(mas: Mas) -> None:
        me = mas.mailbox("me")
        assert mas.mailbox("me") is me
        bob = mas.add_agent(
            "bob",
            """
            +!report(X)[source(S)] <- .send(S, tell, done(X)); .broadcast(tell, bye).
            color(box, red). color(ball, blue).
            +?sum(A, B, C) <- C = A + B.
            +!ask <- .send(me, askOne, weather(W), Answer, 5000); .print(Answer).
            """,
        )
        me.send("bob", "achieve", Structure("report", ("x y",)))
        first, second = [await me.get(timeout=1) for _ in range(2)]
        assert (first.sender, first.performative, first.content.functor) == ("bob", "tell", "done")
        assert second.content.functor == "bye"
        assert await me.ask("bob", "color(ball, C)") == {"C": Atom("blue")}
        assert await me.ask_all("bob", "color(X, C)") == [
            {"X": Atom("box"), "C": Atom("red")},
            {"X": Atom("ball"), "C": Atom("blue")},
        ]
        assert await me.ask("bob", "sum(1, 2, X)") == {"X": 3}
        assert await me.ask("bob", "color(cup, C)") is None
        assert len(me) == 0
        asking = bob.achieve("ask")
        question = await me.get()
        me.send(question.sender, "tell", "weather(fine)", reply_to=question)
        await asking
        with pytest.raises(UnknownAgent, match="there is no agent bobb; did you mean bob"):
            me.send("bobb", "tell", "x")
        with pytest.raises(TimeoutError, match="no message came for me within 1 s"):
            await me.get(timeout=1)
        with pytest.raises(UsageError, match="there is an agent bob; a mailbox needs a name of its own"):
            mas.mailbox("bob")

    lines: list[str] = []
    run(test, lines)
    assert lines == ["[bob] weather(fine)[source(me)]"]


def test_messages_are_gone_through_as_they_come() -> None:
    async def test(mas: Mas) -> None:
        me = mas.mailbox("me")
        mas.add_agent(
            "bob", "!go. +!go <- for (.range(I, 1, 3)) { .wait(1000); .send(me, tell, n(I)) }; .stopMAS."
        )
        numbers = [message.content.arguments[0] async for message in me]
        assert numbers == [1, 2, 3]

    run(test)


def test_output_is_a_stream() -> None:
    async def test(mas: Mas) -> None:
        everything, bobs = mas.output(), mas.output("bob")
        mas.add_agent("bob", "!go. +!go <- .print(a); .wait(1000); .print(b); .wait(1000); .stopMAS.")
        mas.add_agent("ann", "!go. +!go <- .wait(500); .print(c).")
        assert str(await bobs.get(timeout=1)) == "[bob] a"
        assert [line.text async for line in bobs] == ["b"]
        assert [tuple(line) for line in everything.take()] == [("bob", "a"), ("ann", "c"), ("bob", "b")]

    run(test)


def test_lines_go_to_the_standard_output_unless_told_otherwise(capsys: pytest.CaptureFixture[str]) -> None:
    async def main() -> None:
        async with Mas() as mas:
            mas.add_agent("bob", "!go. +!go <- .print(hi); .log(warning, careful).")
            await mas.until_idle()

    jacaros.run(main(), clock="fast")
    shown = capsys.readouterr()
    assert shown.out == "[bob] hi\n"
    assert "careful" in shown.err


def test_a_session_works_beside_the_agents() -> None:
    async def test(mas: Mas) -> None:
        await mas.make_artifact("counter", Counter, [5])
        bob = mas.add_agent("bob", "", focus=["counter"])
        painter = mas.session("painter")
        assert await painter.act("double", 4, Out()) == 8
        await painter.act("inc")
        assert await bob.until("count(X) & X > 5") == {"X": 6}
        with pytest.raises(OperationFailed, match="no workspace /main/lab"):
            mas.session("other", workspace="lab")

    run(test)


@pytest.mark.parametrize("how", ["ends", "raises", "is cancelled"])
def test_the_end_of_the_block_ends_everything(how: str) -> None:
    lines: list[str] = []

    async def block(mas: Mas) -> None:
        await mas.make_artifact("counter", Counter)
        mas.add_agent("bob", "!go. +!go <- drive.", focus=["counter"])
        mas.session("painter").begin("drive")
        await mas.sleep(1)
        if how == "raises":
            raise KeyError("of the user")
        if how == "is cancelled":
            asyncio.current_task().cancel()  # type: ignore[union-attr]
            await mas.sleep(1)

    async def main() -> None:
        before = asyncio.all_tasks()
        try:
            async with Mas(on_print=lambda agent, text: lines.append(text)) as mas:
                await block(mas)
        finally:
            assert asyncio.all_tasks() == before
            assert lines == ["standing", "standing"]
            assert mas.exit_code == 0

    expected = {"ends": None, "raises": KeyError, "is cancelled": asyncio.CancelledError}[how]
    if expected is None:
        jacaros.run(main(), clock="fast")
    else:
        with pytest.raises(expected):
            jacaros.run(main(), clock="fast")


def test_waiting_for_what_cannot_come_any_more_raises() -> None:
    async def test(mas: Mas) -> None:
        bob = mas.add_agent("bob", "+!stop <- .stopMAS(0, 5). +!long <- .wait(100000).")
        ann = mas.add_agent("ann", "")
        waits = [
            asyncio.ensure_future(each)
            for each in (ann.until("p"), bob.achieve("long").wait(), mas.mailbox("m").get())
        ]
        await mas.sleep(1)
        ann.kill()
        with pytest.raises(AgentEnded, match="agent ann has ended"):
            await waits[0]
        assert ann.ended
        with pytest.raises(AgentEnded, match="agent ann has ended"):
            ann.add_belief("p")
        with pytest.raises(UnknownAgent):
            mas.agent("ann")
        bob.achieve("stop")
        for waiting in waits[1:]:
            with pytest.raises(RunEnded, match="the run ended with exit code 5"):
                await waiting
        assert await mas.ended() == 5
        with pytest.raises(RunEnded):
            await bob.until("p")

    assert run(test).exit_code == 5


def test_the_system_can_be_stopped_from_python() -> None:
    async def test(mas: Mas) -> None:
        mas.add_agent("bob", "!go. +!go <- .wait(100); .print(tick); !go.")
        await mas.sleep(0.35)
        mas.stop(7)
        assert mas.exit_code == 7
        await mas.sleep(1)
        assert await mas.ended() == 7

    lines: list[str] = []
    assert run(test, lines).exit_code == 7
    assert lines == ["[bob] tick"] * 3


def test_being_idle_is_waited_for() -> None:
    async def test(mas: Mas) -> None:
        await mas.until_idle()
        mas.add_agent("bob", "!go. +!go <- .wait(3000); +done. +!busy <- .wait(1); !busy.")
        await mas.until_idle()
        assert mas.agent("bob").believes("done")
        mas.agent("bob").achieve("busy")
        with pytest.raises(TimeoutError, match="the agents did not get idle within 2 s"):
            await mas.until_idle(timeout=2)

    run(test)


def test_an_operation_of_a_session_is_under_way() -> None:
    async def test(mas: Mas) -> None:
        await mas.make_artifact("counter", Counter)
        painter = mas.session("painter")
        driving = painter.begin("drive")
        with pytest.raises(TimeoutError, match="did not get idle within 2 s"):
            await mas.until_idle(timeout=2)
        await mas.until_idle(timeout=2000)
        assert driving.done
        assert mas.clock.now() - began == pytest.approx(1000.0)

    began = VirtualClock().now()
    run(test)


def test_mistakes_are_told_where_they_are_made(tmp_path: Path) -> None:
    async def test(mas: Mas) -> None:
        with pytest.raises(AslError, match=r"<bob>:1:16: error: a term is expected"):
            mas.add_agent("bob", "+!go <- .print(.")
        with pytest.raises(UsageError, match=r"there is no program carl\.asl in"):
            mas.add_agent("carl")
        mas.add_agent("bob", "")
        with pytest.raises(UsageError, match="there is an agent bob already"):
            mas.add_agent("bob", "")
        with pytest.raises(UnknownAgent, match="there is no agent bbo; did you mean bob"):
            mas.agent("bbo")
        with pytest.raises(UnknownAgent, match="there is no agent x; there are bob"):
            mas.agent("x")
        mas.add_artifact_types(Counter)
        with pytest.raises(OperationFailed, match="no artifact type is called Countr; did you mean Counter"):
            await mas.make_artifact("c", "Countr")
        with pytest.raises(OperationFailed, match="cannot be made"):
            await mas.make_artifact("c", Counter, ["far"])

    run(test, folder=tmp_path)
    with pytest.raises(ProjectError, match=r"nothing.jcm"):
        Mas(tmp_path / "nothing.jcm")
    with pytest.raises(UsageError, match="there is no ROS backend 'ros3'"):
        Mas(ros="ros3")


def test_a_system_is_used_inside_its_block() -> None:
    mas = Mas()
    assert repr(mas) == "<Mas mas, not begun>"
    with pytest.raises(RunEnded, match="use it inside `async with Mas"):
        mas.add_agent("bob", "")

    async def twice() -> None:
        async with mas:
            assert repr(mas) == "<Mas mas, running>"
        async with mas:
            pass

    with pytest.raises(UsageError, match="this system has run already"):
        jacaros.run(twice(), clock="fast")
    assert repr(mas) == "<Mas mas, ended with exit code 0>"


def test_a_project_that_cannot_start_leaves_nothing_behind(tmp_path: Path) -> None:
    (tmp_path / "a.asl").write_text("+!go <- .print(", encoding="utf-8")

    async def main() -> None:
        before = asyncio.all_tasks()
        with pytest.raises(AslError, match=r"a.asl:1"):
            async with Mas(tmp_path / "a.asl"):
                pytest.fail("it began")
        assert asyncio.all_tasks() == before

    jacaros.run(main(), clock="fast")


def test_a_defect_of_jacaros_is_raised_at_the_end(monkeypatch: pytest.MonkeyPatch) -> None:
    def broken(self: Agent, fuel: int) -> bool:
        raise InternalError("broken")

    async def test(mas: Mas) -> None:
        monkeypatch.setattr(Agent, "run", broken)
        await mas.add_agent("bob", "").until("p")

    with pytest.raises(InternalError, match="broken"):
        run(test)


def test_two_systems_share_a_loop() -> None:
    async def main() -> None:
        lines: list[str] = []
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

    jacaros.run(main(), clock="fast")


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
    with pytest.raises(UsageError, match="no clock 'slow'"):
        jacaros.run(main(), clock="slow")  # type: ignore[arg-type]


def test_the_clock_of_a_loop_is_known() -> None:
    clock = VirtualClock()
    loop = new_event_loop(clock)
    assert clock_of(loop) is clock
    loop.close()


def test_a_virtual_clock_and_a_real_graph_do_not_go_together() -> None:
    async def main() -> None:
        async with Mas(ros="ros1"):
            pytest.fail("it began")

    with pytest.raises(UsageError, match="the virtual clock"):
        jacaros.run(main(), clock="fast")


def test_a_mapping_and_other_names_are_given_as_on_the_command_line(tmp_path: Path) -> None:
    mapping = tmp_path / "wheels.yaml"
    mapping.write_text(
        "properties:\n  odom: {topic: odom, type: nav_msgs/msg/Odometry, fields: [pose.pose.position.x]}\n"
    )
    lines: list[str] = []

    async def test(mas: Mas) -> None:
        bob = mas.add_agent("bob", "+!go <- .wait(odom(X)); .print(X).", focus=["wheels"])
        await bob.achieve("go")
        assert mas.ros.resolve("odom") == "/odom"
        assert mas.ros.resolve("scan") == "/somebody/scan"

    run(
        test,
        lines,
        mappings=[mapping],
        world="empty",
        remap={"/somebody/odom": "/odom"},
        namespace="somebody",
    )
    assert lines == ["[bob] 0"]


@pytest.mark.parametrize(
    ("options", "text"),
    [
        ({"domain_id": 3}, "--domain-id goes with --ros ros2"),
        ({"ros": "ros2", "domain_id": 1000}, "--domain-id is a whole number"),
        ({"master": "http://robot.lab.example:11311"}, "--master goes with --ros ros1"),
        ({"ros": "ros1", "master": "robot"}, "--master is an address"),
        ({"bridge": "ws://robot.lab.example:9090"}, "--bridge goes with --ros rosbridge"),
        ({"ros_clock": True}, "--clock ros follows"),
        ({"node_name": "my node"}, "my node"),
        ({"remap": {"a b": "c"}}, "a b"),
    ],
)
def test_options_of_the_graph_are_checked_when_they_are_given(options: dict[str, Any], text: str) -> None:
    with pytest.raises(UsageError, match=text):
        Mas(**options)


def test_a_missing_mapping_is_told_when_it_is_given() -> None:
    with pytest.raises(ProjectError, match=r"there is no mapping file nowhere\.yaml"):
        Mas(mappings=["nowhere.yaml"])


def test_the_names_of_mailboxes_are_known_to_agents() -> None:
    async def test(mas: Mas) -> None:
        box: Mailbox = mas.mailbox("me")
        bob = mas.add_agent("bob", "+!go <- .all_names(L); +names(L).")
        assert repr(box) == "<mailbox me, 0 messages>"
        await bob.achieve("go")
        assert bob.ask("names(L)") == {"L": [Atom("bob"), Atom("me")]}

    run(test)


def test_a_failed_goal_that_nobody_awaits_is_told() -> None:
    async def test(mas: Mas) -> None:
        bob = mas.add_agent("bob", "+!refused <- .fail.")
        bob.achieve("nothing(1)")
        bob.achieve("refused")
        later = asyncio.create_task(bob.achieve("awaited").wait())
        with pytest.raises(GoalFailed):
            await bob.achieve("awaited_too")
        with pytest.raises(GoalFailed):
            await later

    logs: list[str] = []
    run(test, logs=logs)
    assert [line.partition(" and has")[0] for line in logs] == [
        "[bob] warning: the goal !nothing(1) failed",
        "[bob] warning: the goal !refused failed",
    ]


class Door(Artifact):
    """Is opened once."""

    def init(self) -> None:
        self.define_property("open", False)

    @operation(name="openIt")
    def open_it(self) -> None:
        self.update_property("open", True)

    @operation
    async def stay(self) -> None:
        while True:
            try:
                await self.sleep(1)
            except asyncio.CancelledError:
                self.log("not yet")


def test_who_is_told_later_sees_the_change_before_the_end() -> None:
    """An observer that disposes the artifact of which it is just being told."""

    async def test(mas: Mas) -> None:
        door = await mas.make_artifact("door", Door)
        first, second = mas.session("first"), mas.session("second")
        first.focus(door)
        second.focus(door)
        bob = mas.add_agent(
            "bob", "+open(X) <- .print(open(X)). -open(X) <- .print(no_more(X)).", focus=[door]
        )
        seen: list[object] = []
        second.on_change(lambda change: seen.append((change.before, change.now)))
        first.on_change(lambda change: first.dispose_artifact(door) if change.now else None)
        await second.act("openIt")
        await mas.until_idle()
        assert seen == [((False,), (True,)), ((True,), None)]
        assert bob.ask("open(_)") is None

    lines: list[str] = []
    run(test, lines)
    assert [line[6:] for line in lines] == ["open(false)", "no_more(false)", "open(true)", "no_more(true)"]


def test_an_artifact_that_is_disposed_when_it_appears_is_waited_for() -> None:
    async def test(mas: Mas) -> None:
        first, second = mas.session("first"), mas.session("second")
        first.on_change(lambda change: first.dispose_artifact("door") if change.now and once else None)
        tasks = [asyncio.create_task(each.focus_when_available("door")) for each in (first, second)]
        goal = mas.add_agent("bob", '+!see <- focusWhenAvailable("door"); ?open(X).').achieve("see")
        await mas.sleep(1)
        await mas.make_artifact("door", Door)
        once.clear()
        await mas.sleep(1)
        assert [task.done() for task in tasks] == [True, False]
        assert goal.state == "waiting"
        await mas.make_artifact("door", Door)
        await goal
        assert second.focused == (await tasks[1],)

    once = [True]
    assert run(test).exit_code == 0


def test_a_run_ends_though_an_operation_takes_no_cancellation() -> None:
    async def test(mas: Mas) -> None:
        session = mas.session("s")
        await session.make_artifact("door", Door)
        session.begin("stay")
        await mas.sleep(3)

    logs: list[str] = []
    run(test, logs=logs)
    assert "it is left behind" in logs[-1]


def test_a_callback_for_prints_that_raises_harms_no_agent() -> None:
    async def test(mas: Mas) -> None:
        def refuse(agent: str, text: str) -> None:
            raise ValueError("no printing")

        mas.on_print(refuse)
        await mas.add_agent("bob", "+!go <- .print(a); .print(b).").achieve("go")

    lines: list[str] = []
    logs: list[str] = []
    run(test, lines, logs)
    assert lines == ["[bob] a", "[bob] b"]
    assert "ValueError: no printing" in logs[0]
