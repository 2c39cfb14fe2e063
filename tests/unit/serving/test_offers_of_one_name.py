"""Offers of one name with different arguments: the door chooses by what a caller gives, and never the first by default."""

import asyncio
from typing import Any

import pytest
from serving_lab import Lab, run

from jacaros.serving.callers import RequestError
from jacaros.serving.http.openapi import document
from jacaros.serving.mcp.tools import named_tools, offers_of, resources_of
from jacaros.serving.ros.opening import open_door

PROGRAM = """
{ offer(goal, deliver(parcel(string)), at_most(any)) }
{ offer(goal, deliver(parcel(string), room(atom)), at_most(any)) }
{ offer(goal, deliver(weight(number), by(integer), quick(boolean)), at_most(any)) }
{ offer(goal, measure(room(atom)), at_most(any)) }
{ offer(goal, measure(room(atom), metres(out(number))), at_most(any)) }
{ offer(goal, wait(seconds(number), unit(out(atom))), at_most(any)) }
{ offer(goal, wait(until(string)), at_most(any)) }
{ offer(belief, battery(level(number))) }
{ offer(belief, battery(level(number), state(atom))) }
{ offer(question, far(from(atom), metres(out(number)))) }
{ offer(question, far(from(atom), to(atom), metres(out(number)))) }
{ offer(tell, closed(room(atom))) }
{ offer(tell, closed(room(atom), until(number))) }
battery(80). battery(80, idle).
far(lab, 5). far(lab, hall, 7).
+!deliver(_). +!deliver(_, _). +!deliver(_, _, _). +!measure(_). +!measure(_, 3). +!wait(_, s). +!wait(_).
+closed(Room) <- .print(Room). +closed(Room, Until) <- .print(Room, " ", Until).
"""


def written(lab: Lab, goal: str, arguments: Any) -> str:
    """Give a goal; return the form that was chosen."""
    return lab.session().achieve("bob", goal, arguments).offer.key


def wrong(lab: Lab, goal: str, arguments: Any) -> str:
    """Return the error of a goal."""
    with pytest.raises(RequestError) as error:
        lab.session().achieve("bob", goal, arguments)
    assert error.value.code == "invalid_arguments"
    return str(error.value)


def test_number_names_and_kinds_of_arguments_choose_the_goal() -> None:
    async def test(lab: Lab) -> None:
        assert written(lab, "deliver", ["p1"]) == "deliver/1"
        assert written(lab, "deliver", ["p1", "lab"]) == "deliver/2"
        assert written(lab, "deliver", {"room": "lab", "parcel": "p1"}) == "deliver/2"
        assert written(lab, "deliver", {"weight": 1, "by": 2, "quick": True}) == "deliver/3"
        assert written(lab, "wait", [3]) == "wait/2"
        assert written(lab, "wait", ["noon"]) == "wait/1"
        assert written(lab, "measure/2", ["lab"]) == "measure/2"

    run(test, PROGRAM)


def test_what_fits_no_offer_or_more_than_one_is_an_error() -> None:
    async def test(lab: Lab) -> None:
        assert wrong(lab, "deliver", {"parcel": 3}) == (
            "`parcel` must be of the kind string; expected deliver(parcel: string)"
        )
        assert wrong(lab, "deliver", []) == (
            "expected deliver(parcel: string) or deliver(parcel: string, room: atom) or "
            "deliver(weight: number, by: integer, quick: boolean)"
        )
        assert wrong(lab, "wait", [True]) == (
            "expected wait(seconds: number, -> unit: atom) or wait(until: string)"
        )
        assert wrong(lab, "measure", ["lab"]) == (
            "ambiguous: these arguments fit measure(room: atom) or measure(room: atom, -> metres: number); "
            "name it `measure/1`, or write the goal as text"
        )
        with pytest.raises(RequestError, match=r"offers no goal `deliver/7`"):
            lab.session().achieve("bob", "deliver/7", [])

    run(test, PROGRAM)


def test_questions_beliefs_and_tells_of_one_name() -> None:
    async def test(lab: Lab) -> None:
        anna = lab.session()
        assert anna.ask("bob", "far", ["lab"]) == [{"metres": 5}]
        assert anna.ask("bob", "far", {"from": "lab", "to": "hall"}) == [{"metres": 7}]
        assert anna.beliefs("bob", "battery/2") == [{"level": 80, "state": "idle"}]
        with pytest.raises(RequestError, match=r"the belief `battery` is `battery/1` or `battery/2`"):
            anna.beliefs("bob", "battery")
        anna.tell("bob", "closed", ["lab"])
        anna.tell("bob", "closed", ["hall", 9])
        await asyncio.sleep(0.1)

    assert run(test, PROGRAM) == ["[bob] lab", "[bob] hall 9"]


def test_tools_and_resources_of_a_language_model_have_names_of_their_own() -> None:
    async def test(lab: Lab) -> None:
        offered = offers_of(lab.session())
        tools = named_tools(offered)
        assert {name: tool.offer.key for name, tool in tools.items() if "deliver" in name} == {
            "bob_deliver_1": "deliver/1",
            "bob_deliver_2": "deliver/2",
            "bob_deliver_3": "deliver/3",
        }
        assert {"bob_far_2", "bob_far_3", "bob_tell_closed_1", "bob_tell_closed_2"} <= tools.keys()
        assert [each.uri for each in resources_of(offered)] == [
            "jacaros://bob/beliefs/battery%2F1",
            "jacaros://bob/beliefs/battery%2F2",
        ]
        paths = document("mas", {"bob": lab.session().offers("bob")})["paths"]
        assert {"/agents/bob/goals/deliver/1", "/agents/bob/beliefs/battery/2"} <= paths.keys()

    run(test, PROGRAM)


def test_an_action_of_ros_takes_all_goals_of_its_name() -> None:
    async def test(lab: Lab) -> None:
        open_door(lab.mas.system)
        node: Any = lab.mas.system.ros.companion("station")
        client = node.action_client("bob/deliver", "jacaros_interfaces/action/Achieve")
        for goal in ('["p1"]', '["p1", "lab"]', '{"weight": 1, "by": 2, "quick": true}'):
            outcome = await (await client.send({"goal": goal}, timeout=5)).outcome()
            assert outcome.result.state == "achieved", outcome.result.message

    run(test, PROGRAM)
