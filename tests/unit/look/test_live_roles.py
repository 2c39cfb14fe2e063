"""What a page may do, by its role, and in a restricted run."""

from collections.abc import Awaitable, Callable

import pytest
from live_client import LivePage, viewed

import jacaros
from jacaros import Mas
from jacaros.robots.artifacts.operator_artifact import Operator
from played import played

PROGRAM = """
{ offer(goal, deliver(parcel(string), room([kitchen, office])), doc("Bring a parcel to a room."), when_left(cancel)) }
{ offer(goal, count(n(integer(0, 10)), next(out(number)))) }
{ offer(goal, guard, role(warden)) }
closed(office).
+!deliver(_, Room) : closed(Room) <- .refuse(closed(Room)).
+!deliver(_, _) <- .progress(0.5, "half way"); +busy; .wait(nothing).
+!count(N, N + 1).
+!guard.
+!hidden <- +found.
+told(X) <- +heard(X).
-closed(Room) <- +opened(Room).
"""
WORLD = """
name: lab
bounds: {from: [-3, -3], to: [3, 3]}
border: walls
doors: [{name: gate, segment: [[1, -3], [1, -2]], open: false}]
robots: [{name: turtlebot, pose: {x: -1, y: 0, yaw_degrees: 0}}]
"""
COMMANDS = {
    "message": {"agent": "bob", "performative": "achieve", "text": "hidden"},
    "console": {"agent": "bob", "text": "!hidden"},
    "operate": {"artifact": "operator", "text": "ask(\"Who?\", [], X)"},
    "pause": {},
    "step": {"what": "step"},
    "reload": {},
    "speed": {"factor": 2},
    "breakpoint": {"op": "add", "at": {"event": "+!go"}},
    "move_robot": {"robot": "turtlebot", "x": 1, "y": 1},
    "door": {"name": "gate", "open": True},
    "obstacle": {"x": 1, "y": 1},
}  # fmt: skip
OF_USERS = {
    "achieve": {"agent": "bob", "goal": "count", "arguments": {"n": 1}},
    "cancel": {"goal": "x"},
    "answer": {"question": "operator-1", "given": "x"},
}


def paged(test: Callable[[LivePage], Awaitable[None]], role: str, **options: object) -> None:
    """Run a test with a page of a role."""

    async def main() -> None:
        mas = Mas(seed=1, on_print=lambda *_: None, **{"world": WORLD, **options})  # type: ignore[arg-type]
        async with viewed(mas, role) as page:
            page.mas.add_agent("bob", PROGRAM)
            await page.mas.make_artifact("operator", Operator)
            await test(page)

    jacaros.run(main())


@pytest.mark.parametrize("command", [*COMMANDS, *OF_USERS])
@played(paged, role="observer")
async def test_an_observer_looks_and_changes_nothing(page, command: str) -> None:
    bob, robot = page.mas.agent("bob"), page.mas.world.robot("turtlebot")
    before = sorted(bob.beliefs), bob.goals, (robot.x, robot.y), page.mas.world.doors["gate"]
    why = await page.refused(command, **{**COMMANDS, **OF_USERS}[command])
    assert why == f"unknown command here: `{command}`"
    assert "happened" in await page.done("why", question="?.add_plan({+!y})")
    assert await page.done("story")
    await page.refused("nothing")
    assert (sorted(bob.beliefs), bob.goals, (robot.x, robot.y), page.mas.world.doors["gate"]) == before
    assert page.hello["can"] == ["goals", "offers", "story", "why"]


@pytest.mark.parametrize("command", COMMANDS)
@played(paged, role="user")
async def test_a_user_commands_nothing_but_what_is_offered(page, command: str) -> None:
    assert "unknown command here" in await page.refused(command, **COMMANDS[command])
    assert "offers no goal `hidden`" in await page.refused(
        "achieve", agent="bob", goal="hidden", arguments={}
    )
    assert "needs the role warden" in await page.refused("achieve", agent="bob", goal="guard", arguments={})
    assert not page.mas.agent("bob").believes("found")


@played(paged, role="user")
async def test_a_user_gives_offered_goals_and_follows_them(page) -> None:
    offers = await page.done("offers", agent="bob")
    assert [each["name"] for each in offers] == ["deliver", "count"]
    assert offers[0]["schema"]["properties"]["room"]["enum"] == ["kitchen", "office"]
    given = {"agent": "bob", "goal": "deliver"}
    first = await page.done("achieve", **given, arguments={"parcel": "p1", "room": "kitchen"})
    await page.mas.agent("bob").until("busy", timeout=5)
    (running,) = await page.done("goals")
    assert (running["id"], running["state"], running["note"]) == (first["id"], "running", "half way")
    await page.done("cancel", goal=first["id"])
    await page.done("achieve", **given, arguments={"parcel": "p2", "room": "office"})
    await page.event("goal", agent="bob", goal='!deliver("p2",office)', state="failed")
    cancelled, refused = await page.done("goals")
    assert cancelled["state"] == "cancelled"
    assert refused["state"] == "refused"
    assert "refused(closed(office))" in refused["reasons"]
    wrong = await page.refused("achieve", **given, arguments={"parcel": "p3", "room": "attic"})
    assert "`room` must be one of kitchen, office" in wrong
    assert "asked by page:user: !deliver" in await page.done("why", question='!deliver("p2", office)')


@played(paged, role="user")
async def test_a_goal_of_a_page_that_leaves_is_cancelled_where_its_offer_says_so(page) -> None:
    bob = page.mas.agent("bob")
    arguments = {"parcel": "p1", "room": "kitchen"}
    await page.done("achieve", agent="bob", goal="deliver", arguments=arguments)
    await bob.until("busy", timeout=5)
    await page.socket.close()
    await bob.until("not .intend(deliver(_, _))", timeout=5)


@played(paged, role="operator")
async def test_why_names_the_page_that_posted_a_goal_or_changed_a_belief(page) -> None:
    for line, question in (
        ("!hidden", "!hidden"),
        ("+told(x)", "+heard(x)"),
        ("-closed(office)", "+opened(_)"),
    ):
        await page.done("console", agent="bob", text=line)
        assert f"asked by page:operator: bob: {line}" in await page.done("why", question=question)


@pytest.mark.parametrize(
    ("command", "fields", "why"),
    [
        ("console", {"text": "?.add_plan({+!y <- +z})"}, "`.add_plan` may have effects"),
        ("console", {"text": "-.add_plan({+!y <- +z})"}, "expected a literal"),
        ("console", {"text": "+{+!y <- +z}"}, "expected a literal"),
        ("console", {"text": "!{+!y <- +z}"}, "expected a literal"),
        (
            "message",
            {"text": "{+!y <- +z}", "performative": "tellHow"},
            "this run is restricted (--restrict)",
        ),
        (
            "message",
            {"text": "{+!hidden}", "performative": "untellHow"},
            "this run is restricted (--restrict)",
        ),
    ],
)
@played(paged, role="operator", restricted=True)
async def test_no_page_changes_a_program_in_a_restricted_run(page, command, fields, why: str) -> None:
    plans = page.mas.agent("bob").mind.library.plans
    before = len(plans)
    assert why in await page.refused(command, agent="bob", **fields)
    await page.refused("console", agent="bob", text="?.random(X)")
    assert len(page.mas.agent("bob").mind.library.plans) == before
