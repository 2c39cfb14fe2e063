"""Commands of pages over real sockets: effects, errors, and their records."""

import asyncio
import threading
from collections.abc import Awaitable, Callable, Iterable
from pathlib import Path

import pytest
from live_client import LivePage, live_page

import jacaros
from jacaros import Mas, Out
from jacaros.artifacts import Artifact, operation
from jacaros.look import view
from jacaros.look.page.live import run_view
from jacaros.look.records.records import Record
from jacaros.look.why.explanation import Explanation
from jacaros.look.why.why import explain

WORLD = """
name: lab
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
walls:
  - segment: [[0, 1], [0, 3]]
doors:
  - {name: gate, segment: [[1, -3], [1, -2]], open: false}
robots:
  - name: turtlebot
    pose: {x: -1, y: 0, yaw_degrees: 0}
"""
PROGRAM = """
ready. battery(12). battery(90).
low :- battery(L) & L < 20.
cleared :- low & .abolish(battery(_)).
!wait.
+!wait <- .wait(found(_)).
+!go(X) <- +at(X).
+!never <- .wait(nothing).
+told(X)[source(S)] <- +heard(X, S).
"""

Test = Callable[[Mas, LivePage], Awaitable[None]]


class Counter(Artifact):
    """Counts."""

    def init(self) -> None:
        """Begin at 0."""
        self.total = 0

    @operation
    def count(self, by: int, now: Out[int]) -> None:
        """Count *by* more, and tell where it is now."""
        self.total += by
        now.set(self.total)

    @operation
    def refuse(self) -> None:
        """Fail."""
        self.fail("not today")


def commanding(test: Test, world: str = "none") -> None:
    """Run a test with an agent, an artifact and a page that is connected."""

    async def main() -> None:
        async with Mas(seed=1, world=world, on_print=lambda *_: None) as mas:
            mas.add_agent("bob", PROGRAM)
            await mas.make_artifact("counter", Counter)
            async with view(mas) as address, live_page(address) as page:
                await test(mas, page)

    jacaros.run(main())


async def refused(page: LivePage, command: str, **fields: object) -> str:
    """Return the error of a command, in one line."""
    reply = await page.do(command, **fields)
    assert not reply["ok"]
    assert "\n" not in reply["error"]
    return str(reply["error"])


async def done(page: LivePage, command: str, **fields: object) -> object:
    """The result of a command."""
    reply = await page.do(command, **fields)
    assert reply["ok"], reply
    return reply["result"]


def test_a_belief_is_added_and_removed() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        bob = mas.agent("bob")
        await done(page, "belief", agent="bob", op="+", text="found(key)")
        assert bob.believes("found(key)")
        await page.event("intervention", what="bob: +found(key)")
        await bob.until("not .intend(wait)")
        await done(page, "belief", agent="bob", op="-", text="found(key)")
        assert not bob.believes("found(key)")
        assert "does not believe" in await refused(page, "belief", agent="bob", op="-", text="found(key)")

    commanding(test)


def test_a_goal_is_posted_and_dropped() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        bob = mas.agent("bob")
        await done(page, "goal", agent="bob", op="post", text="go(dock)")
        await bob.until("at(dock)", 5)
        await page.event("goal", agent="bob", goal="!go(dock)", state="achieved")
        await done(page, "goal", agent="bob", op="post", text="!never")
        await bob.until(".intend(never)", 5)
        await done(page, "goal", agent="bob", op="drop", text="never")
        assert not bob.believes(".intend(never)")
        assert "does not pursue" in await refused(page, "goal", agent="bob", op="drop", text="never")

    commanding(test)


def test_a_message_is_sent() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        await done(page, "message", agent="bob", performative="tell", text="told(news)")
        await mas.agent("bob").until("heard(news, you)", 5)
        assert "unknown agent" in await refused(
            page, "message", agent="eve", performative="tell", text="told(x)"
        )
        assert "must be one of" in await refused(
            page, "message", agent="bob", performative="shout", text="told(x)"
        )

    commanding(test)


def test_the_answer_to_a_question_of_the_page_is_recorded() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        printed = await done(page, "message", agent="bob", performative="askOne", text="ready")
        assert printed == "sent; answers appear in Messages"
        answer = await page.event("message", to="you", state="sent")
        assert answer["from"] == "bob"
        assert answer["content"].startswith("ready")
        assert "you" not in mas.system.agent_names()

    commanding(test)


@pytest.mark.parametrize(
    ("line", "result"),
    [
        ("?ready", "yes"),
        ("?ready.", "yes"),
        ("?low", "yes"),
        ("?nothing", "no"),
        ("?X = Y & ready", "yes"),
        ("?.nothing_of_the_kind(3)", "no"),
        ("?battery(X)", "X = 12\nX = 90"),
        ("?battery(X) & X > 50", "X = 90"),
        ("? .member(X, [1, 2])", "X = 1\nX = 2"),
        ("+seen(a)", "added seen(a)"),
        ("-ready", "removed ready"),
        ("-+battery(5)", "replaced battery(5)"),
        ("!go(kitchen)", "posted !go(kitchen)"),
        ("!!go(kitchen)", "posted !go(kitchen)"),
    ],
)
def test_the_console_answers(line: str, result: str) -> None:
    async def test(_: Mas, page: LivePage) -> None:
        assert await done(page, "console", agent="bob", text=line) == result
        await done(page, "belief", agent="bob", op="+", text="last")
        await page.event("intervention", what="bob: +last")
        noted = [each["data"]["what"] for each in page.records if each.get("event") == "intervention"]
        assert noted == ([] if line.startswith("?") else [f"bob: {line}"]) + ["bob: +last"]

    commanding(test)


@pytest.mark.parametrize(
    ("line", "why"),
    [
        ("ready", "expected ?query, !goal"),
        ("?", "expected ?query, !goal"),
        ("?ready(", "expected"),
        ("+3", "expected a literal"),
        ("! ", "expected ?query, !goal"),
        ("", "Expected `str` matching regex"),
    ],
)
def test_the_console_reports_errors_in_one_line(line: str, why: str) -> None:
    async def test(_: Mas, page: LivePage) -> None:
        assert why in await refused(page, "console", agent="bob", text=line)

    commanding(test)


@pytest.mark.parametrize(
    "line",
    [
        "?.add_plan({+!y <- .print(y)})",
        "?ready & .abolish(battery(_))",
        "?F = .add_plan({+!y}) & F",
        "?.random(X)",
        "?not .create_agent(eve)",
        "?cleared",
    ],
)
def test_a_question_in_the_console_changes_nothing(line: str) -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        bob = mas.agent("bob")
        mind = bob.mind
        before = bob.beliefs, len(mind.library.plans), mind.architecture.random.getstate()
        assert "may have effects" in await refused(page, "console", agent="bob", text=line)
        assert (bob.beliefs, len(mind.library.plans), mind.architecture.random.getstate()) == before
        assert mas.system.agent_names() == ("bob",)

    commanding(test)


def test_functions_of_a_project_answer_questions_if_they_are_declared_pure(tmp_path: Path) -> None:
    (tmp_path / "bob.asl").write_text("ready. both(X) :- my.twice(X, Y) & my.act(X, Z).")
    (tmp_path / "my.py").write_text(
        "from jacaros import internal_action\n"
        '@internal_action("my.twice", pure=True)\ndef twice(x: int) -> int:\n    return 2 * x\n'
        '@internal_action("my.act")\ndef act(x: int) -> int:\n    return x\n'
    )

    async def main() -> None:
        async with (
            Mas(tmp_path / "bob.asl", on_print=lambda *_: None) as mas,
            view(mas) as address,
            live_page(address) as page,
        ):
            assert await done(page, "console", agent="bob", text="?my.twice(4, X)") == "X = 8"
            assert "`my.act` may have effects" in await refused(
                page, "console", agent="bob", text="?my.act(4, X)"
            )

    jacaros.run(main())


@pytest.mark.parametrize(
    "line",
    [
        "?X0 = f(a, a) & " + " & ".join(f"X{i + 1} = f(X{i}, X{i})" for i in range(60)),
        "?" + " & ".join(f"battery(X{i})" for i in range(60)) + " & nothing",
        "?.range(X, 1, 1000000000) & X < 0",
    ],
)
def test_an_endless_question_is_refused(line: str) -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        why = await refused(page, "console", agent="bob", text=line)
        assert "the question takes longer than 0.1 s" in why or "the search takes more than 10000" in why
        await done(page, "goal", agent="bob", op="post", text="go(hall)")
        await mas.agent("bob").until("at(hall)", 5)

    commanding(test)


def test_a_text_of_a_command_has_a_largest_length() -> None:
    async def test(_: Mas, page: LivePage) -> None:
        for command in (
            {"do": "console", "text": "?ready"},
            {"do": "goal", "op": "post", "text": "go(hall)"},
        ):
            name = command.pop("do")
            await done(page, name, agent="bob", **{**command, "text": command["text"].ljust(2000)})
            why = await refused(page, name, agent="bob", **{**command, "text": command["text"].ljust(2001)})
            assert why == "Expected `str` of length <= 2000 - at `$.text`"
        assert "of length <= 2000" in await refused(page, "why", question="x" * 2001)

    commanding(test)


def test_every_command_is_recorded_whatever_its_fields() -> None:
    async def test(_: Mas, page: LivePage) -> None:
        await done(page, "obstacle", x=1, y=1, text="?")
        await page.event("intervention", what="obstacle x=1 y=1 text=?")

    commanding(test, WORLD)


def test_the_console_limits_long_answers() -> None:
    async def test(_: Mas, page: LivePage) -> None:
        answers = str(await done(page, "console", agent="bob", text="?.range(X, 1, 1000000000)")).splitlines()
        assert answers[:2] == ["X = 1", "X = 2"]
        assert answers[-1] == "..."
        assert len(answers) < 50

    commanding(test)


def test_an_operation_is_executed() -> None:
    async def test(_: Mas, page: LivePage) -> None:
        assert await done(page, "operate", artifact="counter", text="count(3, Now)") == "Now = 3"
        assert await done(page, "operate", artifact="/main/counter", text="count(4, X)") == "X = 7"
        assert await refused(page, "operate", artifact="counter", text="refuse") == "not today"
        assert await refused(page, "operate", artifact="counter", text="refuse[a(1)]") == "not today"
        assert "unknown operation `nope/0`" in await refused(page, "operate", artifact="counter", text="nope")
        assert "unknown artifact" in await refused(page, "operate", artifact="clock", text="count(1, X)")

    commanding(test)


@pytest.mark.parametrize(
    ("command", "why"),
    [
        ({"do": "nothing"}, "unknown command here: `nothing`"),
        ({}, "unknown command here"),
        ({"do": ["x"]}, "unknown command here"),
        ({"do": "belief"}, "Object missing required field `agent`"),
        ({"do": "belief", "agent": "eve", "text": "x", "op": "+"}, "unknown agent: `eve`"),
        ({"do": "belief", "agent": 3}, "Expected `str`, got `int` - at `$.agent`"),
        ({"do": "belief", "agent": "bob", "text": "x", "op": "*"}, "`op` must be one of +, -"),
    ],
)
def test_incomplete_commands_are_refused(command: dict[str, object], why: str) -> None:
    async def test(_: Mas, page: LivePage) -> None:
        name = command.get("do")
        fields = {key: value for key, value in command.items() if key != "do"}
        assert why in await refused(page, name, **fields)  # type: ignore[arg-type]

    commanding(test)


def test_only_available_commands_are_offered() -> None:
    async def test(_: Mas, page: LivePage) -> None:
        assert {"belief", "console", "goal", "message", "operate"} <= set(page.hello["can"])
        assert not {"move_robot", "door", "obstacle", "person", "battery", "fault"} & set(page.hello["can"])

    commanding(test)


def test_a_robot_is_moved() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        assert mas.world is not None
        robot = mas.world.robot("turtlebot")
        await done(page, "move_robot", robot="turtlebot", x=2, y=1, yaw=1.5)
        assert (robot.x, robot.y, robot.yaw) == (2.0, 1.0, 1.5)
        await page.event("intervention", what="turtlebot moved to (2, 1)")
        await page.event("robot_placed", robot="turtlebot", x=2.0, y=1.0)
        await page.until(
            lambda: any(each["kind"] == "frame" and each["robots"][0][:2] == [2, 1] for each in page.records)
        )
        assert "a wall is in the way" in await refused(page, "move_robot", robot="turtlebot", x=0, y=2)
        assert "outside of the world" in await refused(page, "move_robot", robot="turtlebot", x=9, y=2)
        assert "unknown robot 'r2'" in await refused(page, "move_robot", robot="r2", x=1, y=2)
        assert "Expected `float`, got `str` - at `$.x`" in await refused(
            page, "move_robot", robot="turtlebot", x="1", y=2
        )
        assert "got `bool` - at `$.yaw`" in await refused(
            page, "move_robot", robot="turtlebot", x=1, y=1, yaw=True
        )

    commanding(test, WORLD)


def test_a_door_is_opened_and_closed() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        assert mas.world is not None
        await done(page, "door", name="gate", open=True)
        assert mas.world.doors["gate"]
        await page.event("door_opened", door="gate")
        await done(page, "move_robot", robot="turtlebot", x=1, y=-2.5)
        assert "turtlebot is in the way" in await refused(page, "door", name="gate", open=False)
        assert "unknown door 'exit'" in await refused(page, "door", name="exit", open=True)

    commanding(test, WORLD)


def test_an_obstacle_stops_a_robot() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        assert mas.world is not None
        name = await done(page, "obstacle", x=0, y=-0.5, radius=0.3)
        await page.event("obstacle_placed", obstacle=name, radius=0.3)
        assert "obstacle_1 is in the way" in await refused(page, "move_robot", robot="turtlebot", x=0, y=-0.4)
        assert "turtlebot is in the way" in await refused(page, "obstacle", x=-1, y=0)
        assert "0.02 and 2 metres" in await refused(page, "obstacle", x=2, y=2, radius=9)
        await done(page, "obstacle", remove=name)
        await page.event("obstacle_removed", obstacle=name)
        assert not mas.world.obstacles

    commanding(test, WORLD)


def test_a_person_comes_and_goes() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        assert mas.world is not None
        name = await done(page, "person", x=2, y=2)
        await page.event("person_comes", person=name)
        assert [(each.x, each.y) for each in mas.world.people.values()] == [(2.0, 2.0)]
        assert "a wall is in the way" in await refused(page, "person", x=0, y=2)
        await done(page, "person", remove=name)
        assert not mas.world.people

    commanding(test, WORLD)


def test_a_battery_is_drained() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        assert mas.world is not None
        await done(page, "battery", robot="turtlebot", level=7)
        assert mas.world.robot().battery.level <= 7
        await page.event("battery_set", robot="turtlebot", level=7)
        assert "0 and 100" in await refused(page, "battery", robot="turtlebot", level=101)

    commanding(test, WORLD)


def test_a_fault_begins_and_ends() -> None:
    faults = "faults:\n  stuck: {kind: blocked_wheel}\n"

    async def main() -> None:
        async with (
            Mas(seed=1, world=WORLD, faults=faults) as mas,
            view(mas) as address,
            live_page(address) as page,
        ):
            assert mas.world is not None
            await done(page, "fault", name="stuck", on=True)
            assert mas.world.faults.at_work == ["stuck"]
            await page.event("fault", fault="stuck", state="begins")
            await done(page, "fault", name="stuck", on=False)
            assert mas.world.faults.at_work == []
            assert "unknown fault 'fire'" in await refused(page, "fault", name="fire", on=True)
            assert "Expected `bool`, got `str` - at `$.on`" in await refused(
                page, "fault", name="stuck", on="yes"
            )

    jacaros.run(main())


@pytest.mark.parametrize("clock", ["real", "fast"])
def test_a_run_is_paused_stepped_and_continued(clock: str) -> None:
    """On the virtual clock the page must reach a run whose clock stands still."""

    async def main() -> None:
        running = Mas(seed=1, world=WORLD, on_print=lambda *_: None)
        async with running as mas, view(mas) as address, live_page(address) as page:
            mas.add_agent("bob", "!count(0). +!count(N) <- -+counted(N); .wait(10); !count(N + 1).")
            await done(page, "pause")
            await page.event("debug", state="paused", why="pause")
            counted = await done(page, "console", agent="bob", text="?counted(N)")
            await done(page, "move_robot", robot="turtlebot", x=2, y=1)
            await page.until(
                lambda: any(
                    each["kind"] == "frame" and each["robots"][0][:2] == [2, 1] for each in page.records
                )
            )
            await done(page, "belief", agent="bob", op="+", text="found(key)")
            assert await done(page, "console", agent="bob", text="?counted(N)") == counted
            await done(page, "step", what="step", agent="bob")
            await page.event("debug", state="paused", why="step")
            await done(page, "continue")
            until = int(str(counted).partition("= ")[2] or 0) + 5
            await mas.agent("bob").until(f"counted(N) & N >= {until}")
            assert mas.agent("bob").believes("found(key)")

    jacaros.run(main(), clock="real" if clock == "real" else "fast")


def test_a_breakpoint_stops_the_run() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        at = {"event": "+!go(_)"}
        assert await done(page, "breakpoint", op="add", at=at) == ["+!go(_)"]
        await done(page, "goal", agent="bob", op="post", text="go(dock)")
        assert (await page.event("debug", state="paused"))["why"] == "breakpoint +!go(_)"
        assert not mas.agent("bob").believes("at(_)")
        assert await done(page, "breakpoint", op="remove", at=at) == []
        await done(page, "continue")
        await mas.agent("bob").until("at(dock)", 5)
        assert "not set" in await refused(page, "breakpoint", op="remove", at=at)
        assert "got `str` - at `$.at`" in await refused(page, "breakpoint", op="add", at="here")
        assert "invalid breakpoint" in await refused(page, "breakpoint", op="add", at={"line": 3})
        assert "must be one of" in await refused(page, "step", what="mile")

    commanding(test)


def test_the_speed_is_changed() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        await done(page, "speed", factor=4)
        await page.event("debug", state="running", speed=4.0)
        assert mas.system.debugger.speed == 4.0
        assert "greater than 0" in await refused(page, "speed", factor=0)

    commanding(test)


def test_a_changed_program_is_reloaded(tmp_path: Path) -> None:
    program = tmp_path / "bob.asl"
    program.write_text("+!say <- +said(old).")

    async def main() -> None:
        async with (
            Mas(program, on_print=lambda *_: None) as mas,
            view(mas) as address,
            live_page(address) as page,
        ):
            program.write_text("+!say <- +said(new).")
            assert "bob" in str(await done(page, "reload"))
            await done(page, "goal", agent="bob", op="post", text="say")
            await mas.agent("bob").until("said(new)", 5)
            program.write_text("+!say <- (")
            assert await refused(page, "reload")
            assert mas.agent("bob").believes("said(new)")

    jacaros.run(main())


def test_the_run_continues_while_a_question_about_it_is_answered(monkeypatch: pytest.MonkeyPatch) -> None:
    asked, may_answer = threading.Event(), threading.Event()

    def explained(records: Iterable[Record], question: str, at: float | None) -> Explanation:
        asked.set()
        assert may_answer.wait(20)
        return explain(records, question, at)

    monkeypatch.setattr(run_view, "explain", explained)

    async def test(mas: Mas, page: LivePage) -> None:
        answer = asyncio.create_task(done(page, "why", question="waiting"))
        await asyncio.to_thread(asked.wait, 20)
        await done(page, "goal", agent="bob", op="post", text="go(hall)")
        await mas.agent("bob").until("at(hall)", 5)
        assert not answer.done()
        may_answer.set()
        assert "intention" in str(await answer)

    commanding(test)


def test_a_question_is_answered() -> None:
    async def test(mas: Mas, page: LivePage) -> None:
        await done(page, "goal", agent="bob", op="post", text="go(dock)")
        await mas.agent("bob").until("at(dock)", 5)
        assert "!go(dock) achieved" in str(await done(page, "why", question="!go(dock)"))
        assert "missing required field `question`" in await refused(page, "why")
        assert await refused(page, "why", question="gibberish of no kind at all")

    commanding(test)
