"""Commands of pages over real sockets: effects, errors, and their records."""

import asyncio
import threading
from collections.abc import Awaitable, Callable, Iterable
from pathlib import Path

import pytest
from live_client import LivePage, viewed

import jacaros
from jacaros import Mas, Out
from jacaros.artifacts import Artifact, operation
from jacaros.look.records.records import Record
from jacaros.look.why.explanation import Explanation
from jacaros.look.why.why import explain
from jacaros.robots.artifacts.operator_artifact import Operator
from jacaros.serving import service
from played import played

WORLD = """
name: lab
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
walls: [{segment: [[0, 1], [0, 3]]}]
doors: [{name: gate, segment: [[1, -3], [1, -2]], open: false}]
robots: [{name: turtlebot, pose: {x: -1, y: 0, yaw_degrees: 0}}]
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


class Counter(Artifact):
    total = 0

    @operation
    def count(self, by: int, now: Out[int]) -> None:
        self.total += by
        now.set(self.total)

    @operation
    def refuse(self) -> None:
        self.fail("not today")


def commanding(test: Callable[[LivePage], Awaitable[None]], **options: str) -> None:
    """Run a test with the page of a system that has an agent and an artifact."""

    async def main() -> None:
        async with viewed(Mas(seed=1, on_print=lambda *_: None, **{"world": "none", **options})) as page:
            page.mas.add_agent("bob", PROGRAM)
            await page.mas.make_artifact("counter", Counter)
            await test(page)

    jacaros.run(main())


@played(commanding)
async def test_a_belief_is_added_and_removed(page) -> None:
    bob = page.mas.agent("bob")
    await page.done("console", agent="bob", text="+found(key)")
    assert bob.believes("found(key)")
    await page.event("intervention", what="page:operator: bob: +found(key)")
    await bob.until("not .intend(wait)")
    await page.done("console", agent="bob", text="-found(key)")
    assert not bob.believes("found(key)")
    assert "does not believe" in await page.refused("console", agent="bob", text="-found(key)")


@played(commanding)
async def test_a_goal_is_posted_and_dropped(page) -> None:
    bob = page.mas.agent("bob")
    await page.done("console", agent="bob", text="!go(dock)")
    await bob.until("at(dock)", timeout=5)
    await page.event("goal", agent="bob", goal="!go(dock)", state="achieved")
    await page.done("console", agent="bob", text="!never")
    await bob.until(".intend(never)", timeout=5)
    await page.done("console", agent="bob", text="-!never")
    assert not bob.believes(".intend(never)")
    assert "does not pursue" in await page.refused("console", agent="bob", text="-!never")


@played(commanding)
async def test_a_message_is_sent(page) -> None:
    await page.done("message", agent="bob", performative="tell", text="told(news)")
    await page.mas.agent("bob").until("heard(news, you)", timeout=5)
    assert "unknown agent" in await page.refused("message", agent="eve", performative="tell", text="told(x)")
    assert "must be one of" in await page.refused(
        "message", agent="bob", performative="shout", text="told(x)"
    )


@played(commanding)
async def test_the_answer_to_a_question_of_the_page_is_recorded(page) -> None:
    printed = await page.done("message", agent="bob", performative="askOne", text="ready")
    assert printed == "sent; answers appear in Messages"
    answer = await page.event("message", to="you", state="sent")
    assert answer["from"] == "bob"
    assert answer["content"].startswith("ready")
    assert "you" not in page.mas.system.agent_names()


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
@played(commanding)
async def test_the_console_answers(page, line: str, result: str) -> None:
    assert await page.done("console", agent="bob", text=line) == result
    await page.done("console", agent="bob", text="+last")
    await page.event("intervention", what="page:operator: bob: +last")
    noted = [each["data"]["what"] for each in page.records if each.get("event") == "intervention"]
    assert noted == ([] if line.startswith("?") else [f"page:operator: bob: {line}"]) + [
        "page:operator: bob: +last"
    ]


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
@played(commanding)
async def test_the_console_reports_errors_in_one_line(page, line: str, why: str) -> None:
    assert why in await page.refused("console", agent="bob", text=line)


@pytest.mark.parametrize(
    "line",
    [
        *("?.add_plan({+!y <- .print(y)})", "?ready & .abolish(battery(_))", "?F = .add_plan({+!y}) & F"),
        *("?.random(X)", "?not .create_agent(eve)", "?cleared"),
    ],
)
@played(commanding)
async def test_a_question_in_the_console_changes_nothing(page, line: str) -> None:
    bob = page.mas.agent("bob")
    mind = bob.mind
    before = bob.beliefs, len(mind.library.plans), mind.architecture.random.getstate()
    assert "may have effects" in await page.refused("console", agent="bob", text=line)
    assert (bob.beliefs, len(mind.library.plans), mind.architecture.random.getstate()) == before
    assert page.mas.system.agent_names() == ("bob",)


async def test_functions_of_a_project_answer_no_questions(tmp_path: Path) -> None:
    (tmp_path / "bob.asl").write_text("ready. both(X) :- my.act(X, Z).")
    (tmp_path / "my.py").write_text(
        "from jacaros import internal_action\n"
        '@internal_action("my.act")\ndef act(x: int) -> int:\n    return x\n'
    )

    async with viewed(Mas(tmp_path / "bob.asl")) as page:
        why = await page.refused("console", agent="bob", text="?my.act(4, X)")
        assert "`my.act` may have effects" in why


@pytest.mark.parametrize(
    "line",
    [
        "?X0 = f(a, a) & " + " & ".join(f"X{i + 1} = f(X{i}, X{i})" for i in range(60)),
        "?" + " & ".join(f"battery(X{i})" for i in range(60)) + " & nothing",
        "?.range(X, 1, 1000000000) & X < 0",
    ],
)
@played(commanding)
async def test_an_endless_question_is_refused(page, line: str) -> None:
    why = await page.refused("console", agent="bob", text=line)
    assert "the question takes longer than 0.1 s" in why or "the search takes more than 10000" in why
    await page.done("console", agent="bob", text="!go(hall)")
    await page.mas.agent("bob").until("at(hall)", timeout=5)


@played(commanding)
async def test_a_text_of_a_command_has_a_largest_length(page) -> None:
    for name, text, more in (("console", "?ready", {}), ("message", "go(hall)", {"performative": "achieve"})):
        await page.done(name, agent="bob", text=text.ljust(2000), **more)
        why = await page.refused(name, agent="bob", text=text.ljust(2001), **more)
        assert why == "Expected `str` of length <= 2000 - at `$.text`"
    assert "of length <= 2000" in await page.refused("why", question="x" * 2001)


@played(commanding, world=WORLD)
async def test_every_command_is_recorded_whatever_its_fields(page) -> None:
    await page.done("obstacle", x=1, y=1, text="?")
    await page.event("intervention", what="page:operator: obstacle x=1 y=1 text=?")


@played(commanding)
async def test_the_console_limits_long_answers(page) -> None:
    answers = str(await page.done("console", agent="bob", text="?.range(X, 1, 1000000000)")).splitlines()
    assert answers[:2] == ["X = 1", "X = 2"]
    assert answers[-1] == "..."
    assert len(answers) < 50


@played(commanding)
async def test_an_operation_is_executed(page) -> None:
    assert await page.done("operate", artifact="counter", text="count(3, Now)") == "Now = 3"
    assert await page.done("operate", artifact="/main/counter", text="count(4, X)") == "X = 7"
    assert await page.refused("operate", artifact="counter", text="refuse") == "not today"
    assert await page.refused("operate", artifact="counter", text="refuse[a(1)]") == "not today"
    assert "unknown operation `nope/0`" in await page.refused("operate", artifact="counter", text="nope")
    assert "unknown artifact" in await page.refused("operate", artifact="clock", text="count(1, X)")


@played(commanding)
async def test_a_question_to_a_person_is_answered(page) -> None:
    await page.mas.make_artifact("operator", Operator)
    page.mas.add_agent("eve", '!ask. +!ask <- ask("Where?", [kitchen, hall], Place); +found(Place).')
    await page.event("property", artifact="/main/operator", values=[1, "Where?", ["kitchen", "hall"]])
    refused = "`attic` is not an answer to question 1: expected kitchen, hall"
    assert await page.refused("answer", question="operator-1", given="attic") == refused
    await page.done("answer", question="/main/operator-1", given="2")
    await page.mas.agent("eve").until("found(hall)")
    await page.event("intervention", what="page:operator: answers question /main/operator-1: 2")
    await page.event("signal", signal="answered(1,hall,page)")
    await page.event("operation", operation='answer(1,"2")', agent="page", state="done")
    refused = await page.refused("answer", question="/main/operator-1", given="1")
    assert refused == "no open question `/main/operator-1`"


@pytest.mark.parametrize(
    ("command", "why"),
    [
        ({"do": "nothing"}, "unknown command here: `nothing`"),
        ({}, "unknown command here"),
        ({"do": ["x"]}, "unknown command here"),
        ({"do": "console"}, "Object missing required field `agent`"),
        ({"do": "console", "agent": "eve", "text": "+x"}, "unknown agent: `eve`"),
        ({"do": "console", "agent": 3}, "Expected `str`, got `int` - at `$.agent`"),
        ({"do": "breakpoint", "at": {}, "op": "*"}, "`op` must be one of add, remove"),
    ],
)
@played(commanding)
async def test_incomplete_commands_are_refused(page, command: dict[str, object], why: str) -> None:
    name = command.get("do")
    fields = {key: value for key, value in command.items() if key != "do"}
    assert why in await page.refused(name, **fields)  # type: ignore[arg-type]


@played(commanding)
async def test_only_available_commands_are_offered(page) -> None:
    assert {"answer", "console", "message", "operate"} <= set(page.hello["can"])
    assert not {"move_robot", "door", "obstacle", "person", "battery", "fault"} & set(page.hello["can"])


@played(commanding, world=WORLD)
async def test_a_robot_is_moved(page) -> None:
    robot = page.mas.world.robot("turtlebot")
    await page.done("move_robot", robot="turtlebot", x=2, y=1, yaw=1.5)
    assert (robot.x, robot.y, robot.yaw) == (2.0, 1.0, 1.5)
    await page.event("intervention", what="page:operator: turtlebot moved to (2, 1)")
    await page.event("robot_placed", robot="turtlebot", x=2.0, y=1.0)
    await page.until(lambda: any(each["robots"][0][:2] == [2, 1] for each in page.of("frame")))
    assert "a wall is in the way" in await page.refused("move_robot", robot="turtlebot", x=0, y=2)
    assert "outside of the world" in await page.refused("move_robot", robot="turtlebot", x=9, y=2)
    assert "unknown robot 'r2'" in await page.refused("move_robot", robot="r2", x=1, y=2)
    assert "Expected `float`, got `str` - at `$.x`" in await page.refused(
        "move_robot", robot="turtlebot", x="1", y=2
    )
    assert "got `bool` - at `$.yaw`" in await page.refused(
        "move_robot", robot="turtlebot", x=1, y=1, yaw=True
    )


@played(commanding, world=WORLD)
async def test_a_door_is_opened_and_closed(page) -> None:
    await page.done("door", name="gate", open=True)
    assert page.mas.world.doors["gate"]
    await page.event("door_opened", door="gate")
    await page.done("move_robot", robot="turtlebot", x=1, y=-2.5)
    assert "turtlebot is in the way" in await page.refused("door", name="gate", open=False)
    assert "unknown door 'exit'" in await page.refused("door", name="exit", open=True)


@played(commanding, world=WORLD)
async def test_an_obstacle_stops_a_robot(page) -> None:
    name = await page.done("obstacle", x=0, y=-0.5, radius=0.3)
    await page.event("obstacle_placed", obstacle=name, radius=0.3)
    assert "obstacle_1 is in the way" in await page.refused("move_robot", robot="turtlebot", x=0, y=-0.4)
    assert "turtlebot is in the way" in await page.refused("obstacle", x=-1, y=0)
    assert "0.02 and 2 metres" in await page.refused("obstacle", x=2, y=2, radius=9)
    await page.done("obstacle", remove=name)
    await page.event("obstacle_removed", obstacle=name)
    assert not page.mas.world.obstacles


@played(commanding, world=WORLD)
async def test_a_person_comes_and_goes(page) -> None:
    name = await page.done("person", x=2, y=2)
    await page.event("person_comes", person=name)
    assert [(each.x, each.y) for each in page.mas.world.people.values()] == [(2.0, 2.0)]
    assert "a wall is in the way" in await page.refused("person", x=0, y=2)
    await page.done("person", remove=name)
    assert not page.mas.world.people


@played(commanding, world=WORLD)
async def test_a_battery_is_drained(page) -> None:
    await page.done("battery", robot="turtlebot", level=7)
    assert page.mas.world.robot().battery.level <= 7
    await page.event("battery_set", robot="turtlebot", level=7)
    assert "0 and 100" in await page.refused("battery", robot="turtlebot", level=101)


@played(commanding, world=WORLD, faults="faults:\n  stuck: {kind: blocked_wheel}\n")
async def test_a_fault_begins_and_ends(page) -> None:
    await page.done("fault", name="stuck", on=True)
    assert page.mas.world.faults.at_work == ["stuck"]
    await page.event("fault", fault="stuck", state="begins")
    await page.done("fault", name="stuck", on=False)
    assert page.mas.world.faults.at_work == []
    assert "unknown fault 'fire'" in await page.refused("fault", name="fire", on=True)
    assert "Expected `bool`, got `str` - at `$.on`" in await page.refused("fault", name="stuck", on="yes")


@pytest.mark.parametrize("clock", ["real", "fast"])
async def test_a_run_is_paused_stepped_and_continued(clock: str) -> None:
    """On the virtual clock the page must reach a run whose clock stands still."""
    async with viewed(Mas(seed=1, world=WORLD, on_print=lambda *_: None)) as page:
        bob = page.mas.add_agent("bob", "!count(0). +!count(N) <- -+counted(N); .wait(10); !count(N + 1).")
        await page.done("pause")
        await page.event("debug", state="paused", why="pause")
        counted = await page.done("console", agent="bob", text="?counted(N)")
        await page.done("move_robot", robot="turtlebot", x=2, y=1)
        await page.until(lambda: any(each["robots"][0][:2] == [2, 1] for each in page.of("frame")))
        await page.done("console", agent="bob", text="+found(key)")
        assert await page.done("console", agent="bob", text="?counted(N)") == counted
        await page.done("step", what="step", agent="bob")
        await page.event("debug", state="paused", why="step")
        await page.done("continue")
        until = int(str(counted).partition("= ")[2] or 0) + 5
        await bob.until(f"counted(N) & N >= {until}")
        assert bob.believes("found(key)")


@played(commanding)
async def test_a_breakpoint_stops_the_run(page) -> None:
    at = {"event": "+!go(_)"}
    assert await page.done("breakpoint", op="add", at=at) == ["+!go(_)"]
    await page.done("console", agent="bob", text="!go(dock)")
    assert (await page.event("debug", state="paused"))["why"] == "breakpoint +!go(_)"
    assert not page.mas.agent("bob").believes("at(_)")
    assert await page.done("breakpoint", op="remove", at=at) == []
    await page.done("continue")
    await page.mas.agent("bob").until("at(dock)", timeout=5)
    assert "not set" in await page.refused("breakpoint", op="remove", at=at)
    assert "got `str` - at `$.at`" in await page.refused("breakpoint", op="add", at="here")
    assert "invalid breakpoint" in await page.refused("breakpoint", op="add", at={"line": 3})
    assert "must be one of" in await page.refused("step", what="mile")


@played(commanding)
async def test_the_speed_is_changed(page) -> None:
    await page.done("speed", factor=4)
    await page.event("debug", state="running", speed=4.0)
    assert page.mas.system.debugger.speed == 4.0
    assert "greater than 0" in await page.refused("speed", factor=0)


async def test_a_changed_program_is_reloaded(tmp_path: Path) -> None:
    program = tmp_path / "bob.asl"
    program.write_text("+!say <- +said(old).")
    async with viewed(Mas(program)) as page:
        program.write_text("+!say <- +said(new).")
        assert "bob" in str(await page.done("reload"))
        await page.done("console", agent="bob", text="!say")
        await page.mas.agent("bob").until("said(new)", timeout=5)
        program.write_text("+!say <- (")
        assert await page.refused("reload")
        assert page.mas.agent("bob").believes("said(new)")


@played(commanding)
async def test_the_run_continues_while_a_question_about_it_is_answered(page, monkeypatch) -> None:
    asked, may_answer = threading.Event(), threading.Event()

    def explained(records: Iterable[Record], question: str, at: float | None) -> Explanation:
        asked.set()
        assert may_answer.wait(20)
        return explain(records, question, at)

    monkeypatch.setattr(service, "explain", explained)
    await page.event("intention", agent="bob", state="waits")
    answer = asyncio.create_task(page.done("why", question="waiting"))
    await asyncio.to_thread(asked.wait, 20)
    await page.done("console", agent="bob", text="!go(hall)")
    await page.mas.agent("bob").until("at(hall)", timeout=5)
    assert not answer.done()
    may_answer.set()
    assert "bob waits for the condition found(_)" in str(await answer)


@played(commanding)
async def test_a_question_is_answered(page) -> None:
    await page.done("console", agent="bob", text="!go(dock)")
    await page.mas.agent("bob").until("at(dock)", timeout=5)
    assert "!go(dock) was achieved" in str(await page.done("why", question="!go(dock)"))
    answer = str(await page.done("why", question="did it achieve go(dock)?"))
    assert answer.startswith("yes: `!go(dock)` of bob was achieved")
    assert "missing required field `question`" in await page.refused("why")
    assert await page.refused("why", question="gibberish of no kind at all")
